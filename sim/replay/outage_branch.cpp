#include "sim/replay/outage_branch.hpp"

#include <algorithm>

#include "leeway/earth/earth.hpp"
#include "leeway/model/gnss_measurement.hpp"

namespace leeway::sim {
namespace {

/// Carries the estimate back by less than an IMU interval, at its velocity.
Eigen::Vector3d moved_to(Time t, const NavState& nav, const Eigen::Vector3d& r_e_m) {
  return r_e_m + to_seconds(t - nav.time) * nav.v_e_mps;
}

}  // namespace

OutageBranch::OutageBranch(std::size_t index, const Outage& outage, const ReplayObserver& observer)
    : index_(index),
      observer_(observer),
      start_(time_from_seconds(outage.start_s)),
      end_(start_ + duration_from_seconds(outage.duration_s)) {
  result_.outage = outage;
}

void OutageBranch::push(const ImuIncrement& inc, Reference* reference) {
  navigator_->push(inc);
  if (withheld_ && withheld_->time <= inc.time) {
    compare(withheld_->time, reference);
    withheld_.reset();
  }
  if (inc.time >= end_) finish(reference);
}

void OutageBranch::compare(Time t, Reference* reference) {
  if (!navigator_->aligned()) return;
  const Estimate& estimate = navigator_->filter().estimate();
  Miss m{};
  if (reference) {
    const auto truth = reference->at(t);
    if (!truth) return;
    m = miss(moved_to(t, estimate.nav, estimate.nav.r_e_m),
             ecef_from_geodetic(truth->nav.position));
  } else {
    if (!withheld_->position) return;
    const Eigen::Vector3d& lever = navigator_->filter().inertial().config().lever_arm_b_m;
    m = miss(moved_to(t, estimate.nav, antenna_position_e(estimate, lever)),
             withheld_->position->r_e_m);
  }
  result_.end_error_h_m = m.horizontal_m;
  result_.end_error_v_m = m.vertical_m;
  result_.max_error_h_m = std::max(result_.max_error_h_m, m.horizontal_m);
  last_compared_ = t;
  if (!observer_.outage) return;
  observer_.outage({index_, to_seconds(t - start_), m.horizontal_m, sigma_h_m()});
}

void OutageBranch::finish(Reference* reference) {
  // The reference must reach the very end; GNSS epochs may miss it by one.
  constexpr Duration kEpochSlack = std::chrono::milliseconds{1500};
  if (reference && last_compared_ < end_) compare(end_, reference);
  if (last_compared_ >= (reference ? end_ : end_ - kEpochSlack)) {
    result_.against = reference ? Against::kReference : Against::kGnss;
  }
  if (navigator_->aligned()) {
    result_.end_sigma_h_m = sigma_h_m();
  }
  over_ = true;
  navigator_.reset();
}

}  // namespace leeway::sim
