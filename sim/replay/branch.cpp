#include "sim/replay/branch.hpp"

#include <algorithm>
#include <functional>
#include <queue>

#include "leeway/earth/earth.hpp"
#include "leeway/model/error_metric.hpp"
#include "leeway/model/gnss_measurement.hpp"

namespace leeway::sim {
namespace {

/// Receivers keep their rhythm this well: half an epoch at 10 Hz.
constexpr Duration kRhythmSlack = std::chrono::milliseconds{50};

/// Carries the estimate back by less than an IMU interval, at its velocity.
Eigen::Vector3d moved_to(Time t, const NavState& nav, const Eigen::Vector3d& r_e_m) {
  return r_e_m + to_seconds(t - nav.time) * nav.v_e_mps;
}

}  // namespace

BranchPlan BranchPlan::of(std::size_t index, const Outage& outage) {
  const Time start = time_from_seconds(outage.start_s);
  return {index, start, start + duration_from_seconds(outage.duration_s), {}};
}

BranchPlan BranchPlan::of(std::size_t index, const Thinning& thinning) {
  return {index, time_from_seconds(thinning.start_s), Time::max(),
          duration_from_seconds(thinning.interval_s)};
}

std::vector<std::vector<BranchPlan>> passes_of(std::vector<BranchPlan> plans, std::size_t most) {
  std::stable_sort(plans.begin(), plans.end(),
                   [](const auto& a, const auto& b) { return a.start < b.start; });
  std::vector<std::vector<BranchPlan>> passes(1);
  while (!plans.empty()) {
    std::priority_queue<Time, std::vector<Time>, std::greater<>> ends;
    std::vector<BranchPlan> left;
    for (const BranchPlan& plan : plans) {
      while (!ends.empty() && ends.top() < plan.start) ends.pop();
      if (ends.size() == most) {
        left.push_back(plan);
        continue;
      }
      ends.push(plan.end);
      passes.back().push_back(plan);
    }
    plans = std::move(left);
    if (!plans.empty()) passes.emplace_back();
  }
  return passes;
}

void Branch::push(const ImuIncrement& inc, Reference* reference) {
  navigator_.push(inc);
  if (withheld_ && withheld_->time <= inc.time) take_withheld(reference);
  if (inc.time >= plan_.end) finish(reference);
}

std::optional<Eigen::Vector3d> Branch::error_n_m(Time t, Reference* reference) const {
  if (!navigator_.aligned()) return {};
  const Estimate& estimate = navigator_.filter().estimate();
  if (reference) {
    const auto truth = reference->at(t);
    if (!truth) return {};
    return difference_n_m(moved_to(t, estimate.nav, estimate.nav.r_e_m),
                          ecef_from_geodetic(truth->nav.position));
  }
  if (!withheld_ || !withheld_->position) return {};
  const Eigen::Vector3d& lever = navigator_.filter().inertial().config().lever_arm_b_m;
  return difference_n_m(moved_to(t, estimate.nav, antenna_position_e(estimate, lever)),
                        withheld_->position->r_e_m);
}

void Branch::take_withheld(Reference* reference) {
  const Time t = withheld_->time;
  const auto error = error_n_m(t, reference);
  if (!plan_.interval) {
    if (error) note(t, *error);
  } else if (const auto due = (t - plan_.start + kRhythmSlack) / *plan_.interval; due > used_) {
    used_ = due;
    if (error && observer_.thinned) {
      const double course_rad = course_over_ground_rad(navigator_.filter().estimate().nav);
      observer_.thinned({plan_.index, to_seconds(t), *error, course_rad});
    }
    navigator_.push(*withheld_);
  }
  withheld_.reset();
}

void Branch::note(Time t, const Eigen::Vector3d& error_n_m) {
  result_.end_error_h_m = error_n_m.head<2>().norm();
  result_.end_error_v_m = std::abs(error_n_m.z());
  result_.max_error_h_m = std::max(result_.max_error_h_m, result_.end_error_h_m);
  last_compared_ = t;
  if (!observer_.outage) return;
  observer_.outage(
      {plan_.index, to_seconds(t - plan_.start), result_.end_error_h_m, sigma_h_m(), error_n_m});
}

void Branch::finish(Reference* reference) {
  // The reference must reach the very end; GNSS epochs may miss it by one.
  constexpr Duration kEpochSlack = std::chrono::milliseconds{1500};
  if (reference && last_compared_ < plan_.end) {
    if (const auto error = error_n_m(plan_.end, reference)) note(plan_.end, *error);
  }
  if (last_compared_ >= (reference ? plan_.end : plan_.end - kEpochSlack)) {
    result_.against = reference ? Against::kReference : Against::kGnss;
  }
  if (navigator_.aligned()) result_.end_sigma_h_m = sigma_h_m();
  over_ = true;
}

}  // namespace leeway::sim
