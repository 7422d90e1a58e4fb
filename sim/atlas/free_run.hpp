/// @file
/// Strapdowns without a filter, from the truth over given increments: what the scenes of
/// mechanizations share.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>

#include "leeway/strapdown/integration_monitor.hpp"
#include "leeway/strapdown/strapdown.hpp"

namespace leeway::sim {

/// Follows an integration monitor through a run and tells what it found left out, where that was
/// ever more than a tactical IMU's own bias: 1 deg/h, 0.1 mg.
class WatchedIncrements {
 public:
  explicit WatchedIncrements(Scheme scheme) : scheme_(scheme) {}

  void push(const ImuIncrement& inc);

  /// "motion not resolved; rate left out; force left out", or some of it, or nothing.
  std::string reported() const;

 private:
  Scheme scheme_;
  IntegrationMonitor monitor_{};
  double rate_radps_{0.0};
  double force_mps2_{0.0};
  bool resolved_{true};
};

struct FreeRun {
  NavState nav{};
  std::string reported{};
};

/// @param increments  anything with size() and []
/// @param observe     called with the state after every increment
template <class Increments, class Observe>
FreeRun free_run(const NavState& start, const Increments& increments, const StrapdownPolicy& policy,
                 Observe&& observe) {
  FreeRun run{start};
  WatchedIncrements watched(policy.scheme);
  ImuHistory history;
  const StrapdownFunction step = strapdown_function(policy);
  for (std::size_t k = 0; k < increments.size(); ++k) {
    const ImuIncrement& inc = increments[k];
    step(run.nav, inc, history);
    run.nav.time = inc.time;
    watched.push(inc);
    observe(run.nav);
  }
  run.reported = watched.reported();
  return run;
}

template <class Increments>
FreeRun free_run(const NavState& start, const Increments& increments,
                 const StrapdownPolicy& policy) {
  return free_run(start, increments, policy, [](const NavState&) {});
}

/// Of the attitude, about the axes of ECEF; |error| <= pi.
Eigen::Vector3d attitude_error_e_rad(const NavState& truth, const NavState& nav);

/// Of the position, on the ground.
double horizontal_error_m(const NavState& truth, const NavState& nav);

}  // namespace leeway::sim
