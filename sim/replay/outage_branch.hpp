/// @file
/// One GNSS outage of a replay.
#pragma once

#include <cstddef>
#include <optional>

#include "leeway/navigator/navigator.hpp"
#include "leeway/sim/replay/replay.hpp"
#include "sim/replay/reference.hpp"

namespace leeway::sim {

/// One outage: a copy of the navigator that goes on without fixes.
class OutageBranch {
 public:
  /// @param observer  outlives this
  OutageBranch(std::size_t index, const Outage& outage, const ReplayObserver& observer);

  Time start() const { return start_; }
  bool over() const { return over_; }
  bool is_running() const { return navigator_.has_value(); }
  const OutageResult& result() const { return result_; }

  void begin(const Navigator& aided) {
    if (!navigator_) navigator_ = aided;
  }

  bool withholds(Time t) const { return navigator_ && !over_ && t > start_ && t <= end_; }

  void withhold(const GnssFix& fix) { withheld_ = fix; }

  /// Aiding goes on through an outage. @pre begin() has been called.
  void push(const Reading& reading) { navigator_->push(reading); }

  /// @pre begin() has been called.
  void push(const ImuIncrement& inc, Reference* reference);

 private:
  /// Error at t, against the reference or, without one, the withheld fix of that time.
  void compare(Time t, Reference* reference);
  double sigma_h_m() const { return navigator_->solution().sigma_position_n_m.head<2>().norm(); }

  void finish(Reference* reference);

  std::size_t index_;
  const ReplayObserver& observer_;
  Time start_;
  Time end_;
  std::optional<Navigator> navigator_{};
  std::optional<GnssFix> withheld_{};
  Time last_compared_{Time::min()};
  bool over_{false};
  OutageResult result_{};
};

}  // namespace leeway::sim
