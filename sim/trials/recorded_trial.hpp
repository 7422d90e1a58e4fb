/// @file
/// The inputs of one trial, made before any filter runs: so that filters see the very same, and
/// that what is timed is the filter alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sensors/imu.hpp"
#include "leeway/sim/trials/trial.hpp"
#include "sim/trials/trial_score.hpp"

namespace leeway::sim {

struct RecordedTrial {
  struct Fix {
    std::size_t at{};       ///< valid at the end of this increment
    std::size_t arrives{};  ///< known to the filter at the end of this one
    GnssFix fix{};
    std::optional<Estimate> truth{};  ///< at the arrival of a fix that is scored
  };

  TrialStart start{};
  std::vector<ImuIncrement> imu{};
  std::vector<Fix> fixes{};
};

/// Fixes of a plan that arrive before its end.
std::vector<TrialPlan::Fix> arriving_fixes(const TrialPlan& plan);

/// What run_trial() of this seed feeds its filter. Fixes that arrive after the end are left out.
/// @pre every fix of the plan arrives before the next one is valid.
RecordedTrial record_trial(const TrialPlan& plan, std::uint64_t seed);

/// Whether a fix, or every fix, is valid and arrives at the end of an increment at a rate lower by
/// this divider.
bool fits(const TrialPlan::Fix& fix, int divider);
bool fits(const TrialPlan& plan, int divider);

/// The same sensor read less often: so many increments added to one, errors and all. Nothing is
/// lost but the knowledge of what happened within. @pre fits()
RecordedTrial at_lower_rate(const RecordedTrial& trial, int divider);

/// The same fixes, taken for valid when they arrive.
RecordedTrial valid_at_arrival(const RecordedTrial& trial);

}  // namespace leeway::sim
