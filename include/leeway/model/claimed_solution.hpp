/// @file
/// The solution as people read it, from an estimate and its covariance.
#pragma once

#include "leeway/model/error_state.hpp"
#include "leeway/strapdown/solution.hpp"

namespace leeway {

/// Estimate with 1 sigma of position and velocity in north-east-down, of roll, pitch and yaw, and
/// of the biases; nis and nis_dof are left unset.
Solution solution(const Estimate& estimate, const ErrorMatrix& P);

}  // namespace leeway
