/// @file
/// A filter chosen at run time, run over a recording.
#pragma once

#include <functional>

#include "leeway/ekf/ekf.hpp"
#include "leeway/sim/compare/variant.hpp"
#include "sim/trials/recorded_trial.hpp"

namespace leeway::sim {

/// Told of every scored fix before it is used. @param P  null where the filter claims nothing
using ScoreObserver =
    std::function<void(const Estimate& truth, const Estimate& estimate, const ErrorMatrix* P)>;

/// Runs the variant's filter over the whole recording, compiled into the loop as it would be in a
/// vehicle. The rate of the recording is the caller's.
/// @param believed  all that the variant does not say
/// @returns the processor time of the run, s: other programs take their turns
/// @throws Error when the configuration is invalid.
double run_variant(const Variant& variant, const EkfConfig& believed, const TrialStart& start,
                   const RecordedTrial& trial, const ScoreObserver& observer = {});

}  // namespace leeway::sim
