/// @file
/// The gate: whether a measurement is one that the filter may believe.
#pragma once

#include <array>

#include "leeway/ekf/update_outcome.hpp"
#include "leeway/model/measurement.hpp"

namespace leeway {

/// Chi-square gate on a whole measurement of 1 to 6 components.
class FixGate {
 public:
  /// @param probability  with which a right measurement is refused; 0: none is refused
  explicit FixGate(double probability);

  /// Outcome of a measurement before it is fused; kUnusable where S is not positive definite.
  /// @param S  covariance of the innovation
  UpdateOutcome judge(const Measurement& m, const MeasurementMatrix& S, Time now) const;

 private:
  std::array<double, 7> threshold_{};  // by degrees of freedom
};

}  // namespace leeway
