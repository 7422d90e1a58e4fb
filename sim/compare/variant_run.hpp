/// @file
/// A filter chosen at run time: one table from variants to the types that run them.
#pragma once

#include <functional>
#include <memory>

#include "leeway/ekf/ekf.hpp"
#include "leeway/sim/compare/variant.hpp"
#include "sim/trials/recorded_trial.hpp"

namespace leeway::sim {

class VariantRun {
 public:
  /// Told of every scored fix before it is used. @param P  null where the filter claims nothing
  using Observer =
      std::function<void(const Estimate& truth, const Estimate& estimate, const ErrorMatrix* P)>;

  virtual ~VariantRun() = default;

  /// Runs the filter over the whole recording, once. One virtual call, so that the filter is
  /// compiled into the loop as it would be in a vehicle.
  virtual void replay(const RecordedTrial& trial, const Observer& observer) = 0;
};

/// The variant's filter at the start of a trial. The rate of the recording is the caller's.
/// @param believed  all that the variant does not say
/// @throws Error when the configuration is invalid.
std::unique_ptr<VariantRun> make_variant_run(const Variant& variant, const EkfConfig& believed,
                                             const TrialStart& start);

}  // namespace leeway::sim
