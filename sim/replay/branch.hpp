/// @file
/// One branch of a replay: a copy of the navigator from which fixes are withheld.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "leeway/navigator/navigator.hpp"
#include "leeway/sim/replay/replay.hpp"
#include "sim/replay/reference.hpp"

namespace leeway::sim {

/// What a branch withholds: every fix with start < t <= end, or all but one each interval.
struct BranchPlan {
  std::size_t index{};  ///< in ReplayInput::outages or thinnings
  Time start{};
  Time end{};
  std::optional<Duration> interval{};  ///< nothing: an outage

  static BranchPlan of(std::size_t index, const Outage& outage);
  static BranchPlan of(std::size_t index, const Thinning& thinning);
};

/// The branches of each pass over the log, so that no more than `most` are alive at any time. In
/// the order of their starts; a branch is in the first pass that has room for it.
std::vector<std::vector<BranchPlan>> passes_of(std::vector<BranchPlan> plans, std::size_t most);

/// A copy of the navigator that goes on with fewer fixes.
class Branch {
 public:
  /// From the fully aided navigator of the start. @param observer  outlives this
  Branch(const BranchPlan& plan, const Navigator& aided, const ReplayObserver& observer)
      : plan_(plan), observer_(observer), navigator_(aided) {}

  const BranchPlan& plan() const { return plan_; }
  bool over() const { return over_; }

  void push(const GnssFix& fix) {
    if (fix.time > plan_.start && fix.time <= plan_.end) withheld_ = fix;
  }

  /// Aiding goes on.
  void push(const Reading& reading) { navigator_.push(reading); }

  void push(const ImuIncrement& inc, Reference* reference);

  /// What an outage cost, once it is over; as far as it came, before.
  const OutageResult& result() const { return result_; }

 private:
  /// The position's error along north, east, down at t, against the reference or, without one, the
  /// withheld fix of that time.
  std::optional<Eigen::Vector3d> error_n_m(Time t, Reference* reference) const;

  /// Takes the withheld fix into the answer, and uses it where its turn has come.
  void take_withheld(Reference* reference);
  void note(Time t, const Eigen::Vector3d& error_n_m);
  double sigma_h_m() const { return navigator_.solution().sigma_position_n_m.head<2>().norm(); }
  void finish(Reference* reference);

  BranchPlan plan_;
  const ReplayObserver& observer_;
  Navigator navigator_;
  std::optional<GnssFix> withheld_{};
  std::int64_t used_{0};  // intervals begun
  Time last_compared_{Time::min()};
  bool over_{false};
  OutageResult result_{};
};

}  // namespace leeway::sim
