/// @file
/// What every run of a trial shares, whichever filter runs: its start, and how an epoch is scored.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "leeway/model/error_state.hpp"
#include "leeway/sim/trials/trial.hpp"

namespace leeway::sim {

struct TrialStart {
  Estimate estimate{};
  ErrorMatrix P{ErrorMatrix::Zero()};
};

/// Known biases, zero spread bias, and a navigation error drawn from P.
TrialStart trial_start(const TrialPlan& plan, std::uint64_t seed);

/// In north, east and down at the truth.
Eigen::Vector3d position_error_n_m(const Estimate& truth, const Estimate& estimate);

/// The mean of x^T P^-1 x for errors with E[x x^T]; NaN unless P is positive. A bias of zero
/// variance is no state: the square is then taken from the number of states to 15.
double expected_nees(const ErrorMatrix& second_moment, const ErrorMatrix& P);

/// Adds an epoch to the score, or finds it not finite.
/// @param P  what the filter claims; null for one that claims nothing
void score_epoch(TrialScore& score, const Estimate& truth, const Estimate& estimate,
                 const ErrorMatrix* P);

}  // namespace leeway::sim
