/// @file
/// The times of a log's records: their step, its scatter, gaps and bursts.
#pragma once

#include <optional>
#include <vector>

#include "leeway/earth/time.hpp"
#include "leeway/sim/inspect/log_look.hpp"

namespace leeway::sim {

/// The times of a log, one after the other.
class RecordTimes {
 public:
  void add(Time t);
  TimeFigures figures() const;

 private:
  static constexpr std::size_t kJudged = 1000;  ///< steps that tell the usual one

  /// A step against the usual one.
  void judge(double step_s);
  void decide();

  TimeFigures figures_{};
  std::optional<Time> last_{};
  std::vector<double> first_steps_s_{};
  bool is_decided_{false};
  double square_sum_s2_{0.0};
  std::int64_t regular_{0};
};

}  // namespace leeway::sim
