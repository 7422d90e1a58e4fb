/// @file
/// The journals of separate jobs as one: each trial once, and what is missing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "leeway/sim/trials/seed_range.hpp"
#include "leeway/sim/trials/trial_journal.hpp"
#include "sim/trials/campaign_sums.hpp"

namespace leeway::sim {

/// What journals hold of the seeds that were asked for.
struct MergedJournals {
  CampaignSums sums{};
  std::vector<SeedRange> missing{};      ///< ascending
  std::int64_t repeated{0};              ///< lines of trials that another line has too
  std::vector<JournalDamage> damaged{};  ///< the journals with damaged lines
};

/// The trials of the seeds `wanted` in the journals and in those of their ranks. Memory follows the
/// gaps and the repeated trials, not the number of trials.
/// @param first_may_be_new  the first journal need not be there yet
/// @throws Error as read_journal(); when a journal is not there; when two have different figures
/// for a seed, with both their names.
MergedJournals merge_journals(const std::vector<std::filesystem::path>& journals,
                              bool first_may_be_new, std::uint64_t fingerprint,
                              const SeedRange& wanted);

}  // namespace leeway::sim
