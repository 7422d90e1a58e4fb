/// @file
/// What a replay is compared with: the truth log, and the errors against it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "leeway/logs/truth_log.hpp"
#include "leeway/sim/replay/replay.hpp"
#include "leeway/strapdown/nav_state.hpp"

namespace leeway::sim {

/// The way from b to a, a short one, along north, east, down at b.
Eigen::Vector3d difference_n_m(const Eigen::Vector3d& a_e_m, const Eigen::Vector3d& b_e_m);

/// The truth log within its window of use.
class Reference {
 public:
  /// @throws Error when the log cannot be read.
  explicit Reference(const ReplayInput& input);

  /// Nothing outside the window.
  std::optional<TruthRecord> at(Time t);

  const LogSummary& summary() const { return track_.summary(); }

 private:
  TruthTrack track_;
  Time from_;
  Time to_;
};

/// Sums of squares towards RmsErrors.
class RmsSum {
 public:
  void add(const NavState& nav, const TruthRecord& truth);
  RmsErrors rms() const;

 private:
  std::int64_t epochs_{0};
  std::int64_t velocity_epochs_{0};
  std::int64_t attitude_epochs_{0};
  double horizontal_{0.0};
  double vertical_{0.0};
  double velocity_{0.0};
  double attitude_{0.0};
};

}  // namespace leeway::sim
