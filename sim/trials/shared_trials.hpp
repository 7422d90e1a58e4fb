/// @file
/// The trials of a scene one by one, shared among ranks: for studies that need more of them than
/// the sums of a campaign.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "leeway/sim/tools/ranks.hpp"
#include "leeway/sim/trials/seed_range.hpp"
#include "leeway/sim/trials/trial.hpp"

namespace leeway::sim {

/// What one trial leaves: its sums, and a number for each fix that was asked for one.
struct SharedTrial {
  TrialScore score{};
  std::vector<double> of_fixes{};
};

/// The number that a trial leaves of what stands just before fix k of its plan; nothing: none.
using OfFix = std::function<std::optional<double>(std::size_t k, const TrialEpoch& epoch)>;

/// The trials of the plan with these seeds, in their order, on every rank; to the bit the same
/// on any number of them. All ranks must call it with the same plan.
/// @param progress  called from the calling thread with the fraction done of this rank's part
/// @throws Error of a trial, the same on every rank; RankFailure when another rank stopped, or has
/// another scene than the first.
std::vector<SharedTrial> shared_trials(const TrialPlan& plan, const SeedRange& seeds,
                                       const OfFix& of_fix, const Ranks& ranks,
                                       const std::function<void(double)>& progress = {},
                                       int threads = 0);

/// A check that all ranks are about to run the same trials.
/// @throws RankFailure on a rank that has another scene than the first.
void require_same_scene(std::uint64_t fingerprint, const Ranks& ranks);

}  // namespace leeway::sim
