/// @file
/// A filter's model carried along the true motion: its gains, what it claims, and the mean error
/// that it makes. No noise, no trials. Part of budget.
#pragma once

#include <vector>

#include "leeway/sim/reduce/model_reduction.hpp"
#include "leeway/sim/trials/trial.hpp"
#include "sim/reduce/paired_covariance.hpp"
#include "sim/trials/recorded_trial.hpp"

namespace leeway::sim {

/// What the passes of all models share: the motion at the ends of the IMU's increments.
struct TruePath {
  /// By the full model's strapdown on the true increments: errs by less than any term is worth.
  TruePath(const TrialPlan& plan, const StrapdownPolicy& full);

  const TrialPlan& plan;
  std::vector<NavState> states{};  ///< the start, then the end of every increment
};

/// The rows of a fix at the end of an increment, by the lever arm.
/// @param weight  of the position, by gnss_position_weight()
FixRows fix_rows(const TruePath& path, std::size_t increment, const Eigen::Vector3d& lever_arm_b_m,
                 double weight);

/// Of each fix, by the correlation that the filter believes in.
std::vector<double> fix_weights(const TrialPlan& plan, double correlation_s);

struct LinearFilterRun {
  struct Epoch {
    ErrorVector mean{ErrorVector::Zero()};
    ErrorMatrix claimed{ErrorMatrix::Zero()};
  };
  std::vector<FixGain> gains{};  ///< of arriving_fixes()
  std::vector<Epoch> epochs{};   ///< at the arrival of those that are scored
  bool is_positive{true};        ///< P, after every fix
};

/// The mean error is what single steps of the model's strapdown on true increments miss the path
/// by, and its measurements the fixes by, carried on by the linear dynamics and the model's gains.
/// The covariance is the model's own, in its precision and at its interval.
LinearFilterRun run_linear_filter(const TruePath& path, const FilterModel& model);

}  // namespace leeway::sim
