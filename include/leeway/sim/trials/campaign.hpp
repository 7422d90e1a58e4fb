/// @file
/// A Monte Carlo campaign: many trials of a scene, on threads and MPI ranks, that say whether the
/// filter errs as much as it claims. The same bits on any number of either.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "leeway/sim/scene/scene.hpp"
#include "leeway/sim/tools/ranks.hpp"
#include "leeway/sim/trials/seed_range.hpp"
#include "leeway/sim/trials/trial_journal.hpp"

namespace leeway::sim {

/// Progress of a campaign.
struct CampaignProgress {
  double fraction{};     ///< of the trials of this process, those of the journal included
  double remaining_s{};  ///< estimated from the trials finished so far
};

/// Options of a campaign. Its trials are the scene's: seeds first_seed to first_seed + trials - 1.
struct CampaignOptions {
  int threads{0};                        ///< 0: all processors for a process alone, one per rank
  std::optional<double> score_last_s{};  ///< as TrialPlan
  /// Finished trials are kept in the first, and those in any of them are not run again: trials of
  /// any number of jobs, threads and ranks. The first alone may be new. Empty: nothing is kept.
  std::vector<std::filesystem::path> journals{};
  bool merge_only{false};  ///< runs and writes nothing: the answer is of what the journals hold
  std::function<void(const CampaignProgress&)> progress{};  ///< called from the calling thread
};

/// Figures of a campaign. Ratios are 1 when the filter is honest, NaN where no trial was scored.
struct CampaignResult {
  std::int64_t trials{0};
  std::int64_t resumed{0};      ///< of them from the journals
  std::int64_t epochs{0};       ///< scored, of all trials
  double rms_horizontal_m{};    ///< sqrt of mean squared north + east error
  double sigma_horizontal_m{};  ///< what the filter claims: sqrt of its mean variance
  double rms_over_sigma{};      ///< horizontal
  Eigen::Vector3d rms_n_m{};    ///< north, east, down
  Eigen::Vector3d sigma_n_m{};
  double mean_nees{};  ///< 15 states, over trials and epochs
  /// 95 % band of the mean for a consistent filter, as from one epoch per trial: the epochs of a
  /// trial are correlated.
  double nees_low{};
  double nees_high{};
  double nis_over_dof{};  ///< of fused fixes
  double beyond_r95{};    ///< fraction of epochs beyond the claimed R95 radius
  std::int64_t fused{0};  ///< fixes of whole runs
  std::int64_t gated{0};
  std::int64_t diverged{0};     ///< trials with an error beyond ten claimed sigmas, or not finite
  std::int64_t not_finite{0};   ///< the part of them that the figures above leave out
  double worst_horizontal_m{};  ///< largest error before a fix; infinite when not finite
  std::uint64_t worst_seed{};   ///< of the trial it happened in, to run again

  std::vector<SeedRange> missing{};      ///< with merge_only: seeds that no journal has, ascending
  std::int64_t repeated{0};              ///< lines of journals for trials that another line has
  std::vector<JournalDamage> damaged{};  ///< the journals with damaged lines
};

/// The figures of all trials of the scene. Memory does not depend on their number.
/// @param ranks  shares the trials among its processes. The result is whole on each, but for
///               repeated and damaged, which the first alone knows.
/// @throws Error when scene or options are invalid, a journal is of another scene, two journals
/// differ in a trial; JournalFailure when a trial cannot be kept; RankFailure when another rank
/// stopped, or has another scene.
CampaignResult campaign(const Scene& scene, const CampaignOptions& options, const Ranks& ranks);

/// The same by this process alone.
CampaignResult campaign(const Scene& scene, const CampaignOptions& options = {});

}  // namespace leeway::sim
