/// @file
/// The seed's "separate" scheme: the INS is reset to the GNSS solution, and learns nothing from it.
#pragma once

#include "leeway/ekf/inertial_estimate.hpp"

namespace leeway {

/// Position and velocity are those of the newest fix, by the lever arm; attitude and biases stay as
/// they began. Makes no claim of its own error. Allocates nothing after construction.
class ResetFilter {
 public:
  /// @throws Error when configuration or estimate are invalid.
  ResetFilter(const EkfConfig& config, const Estimate& estimate) : inertial_(config, estimate) {}

  /// @pre inc.time - inc.dt_s = estimate().nav.time, inc.dt_s > 0.
  void predict(const ImuIncrement& inc) { inertial_.advance(inc); }

  /// What the fix does not have stays as it is. @pre fix.time equals estimate().nav.time.
  void update(const GnssFix& fix);

  const Estimate& estimate() const { return inertial_.estimate(); }

 private:
  InertialEstimate inertial_;
};

}  // namespace leeway
