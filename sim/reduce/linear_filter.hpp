/// @file
/// A filter's model carried along the true motion: its gains, what it claims, and the mean error
/// that it makes. No noise, no trials. Part of reduce.
#pragma once

#include <vector>

#include "leeway/sim/reduce/model_reduction.hpp"
#include "leeway/sim/trials/trial.hpp"
#include "sim/analysis/source_covariance.hpp"

namespace leeway::sim {

/// What the passes of all models share: the motion at the ends of the IMU's increments.
struct TruePath {
  /// By the full model's strapdown on the true increments: errs by less than any term is worth.
  TruePath(const TrialPlan& plan, const StrapdownPolicy& full);

  const NavState& at_end_of(std::size_t increment) const { return states[increment + 1]; }

  /// The rows of a fix at the end of an increment. @param weight  of the position
  FixRows fix_rows(std::size_t increment, const Eigen::Vector3d& lever_arm_b_m,
                   double weight) const;

  const TrialPlan& plan;
  std::vector<NavState> states{};  ///< the start, then the end of every increment
};

struct LinearFilterRun {
  struct Epoch {
    ErrorVector mean{ErrorVector::Zero()};
    ErrorMatrix claimed{ErrorMatrix::Zero()};
  };
  std::vector<FixGains<1>> gains{};  ///< of arriving_fixes(), on all rows at once
  std::vector<Epoch> epochs{};       ///< at the arrival of those that are scored
  bool is_positive{true};            ///< P, after every fix
};

/// The mean error is what single steps of the model's strapdown on true increments miss the path
/// by, and its measurements the fixes by, carried on by the linear dynamics and the model's gains.
/// The covariance is the model's own, in its precision and at its interval.
LinearFilterRun run_linear_filter(const TruePath& path, const FilterModel& model);

}  // namespace leeway::sim
