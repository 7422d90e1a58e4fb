/// @file
/// The default navigator with IMUs that it does not know: whether it finds its way, and whether its
/// claims hold.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "sim/atlas/mismatch/claim_run.hpp"
#include "sim/atlas/mismatch/true_imu.hpp"

namespace leeway::sim {

/// What a claim may be off by: RMS error over RMS sigma.
inline constexpr double kLeastRatio = 0.5;
inline constexpr double kMostRatio = 1.5;
inline constexpr double kNamedWithin = 2.0;  ///< a factor, of health over the true one
inline bool is_honest(double ratio) { return ratio >= kLeastRatio && ratio <= kMostRatio; }

enum class FixKind { kCode, kRtk };
constexpr auto names(FixKind) { return std::array{"code", "RTK"}; }

struct MismatchCell {
  std::size_t imu{};  ///< its place in MismatchCampaign::imus
  FixKind fixes{};
  VehicleKind vehicle{};
  int fix_interval_s{};

  ClaimSums before_fixes{};  ///< of all trials
  ClaimSums between{};
  std::vector<std::uint64_t> lost{};  ///< seeds
  double imu_sigma_scale{1.0};        ///< of health at the end, the median

  /// Horizontal RMS error over RMS sigma, before fixes or between, whichever is further from 1 on a
  /// logarithmic scale. Infinite where there is no solution.
  double ratio() const;
  bool claims_hold() const { return is_honest(ratio()); }
};

struct MismatchCampaign {
  std::vector<TrueImu> imus{};
  std::vector<MismatchCell> cells{};
  int trials{};  ///< of a cell, seeds 1 to trials: the same motion and another unit of the IMU

  /// Whether the IMU is other than believed by more than kNamedWithin, and health says within as
  /// much by how much.
  bool is_named(const MismatchCell& cell) const;
};

/// Options of a campaign.
struct MismatchOptions {
  bool brief{false};  ///< few IMUs, one interval
  int trials{10};     ///< of a cell
  int threads{0};     ///< 0: as many as there are processors
};

/// Runs the campaign. The same bits on any number of threads.
MismatchCampaign run_mismatch(const MismatchOptions& options,
                              const std::function<void(double fraction)>& progress = {});

struct MismatchSummary {
  std::size_t trials{0};
  std::size_t lost{0};
  std::size_t cells{0};
  std::size_t outside{0};           ///< claims do not hold, and health does not name the factor
  std::size_t named{0};             ///< claims do not hold, but health names the factor
  std::size_t velocity_outside{0};  ///< cells, before fixes
  std::size_t heading_outside{0};
};
MismatchSummary summary_of(const MismatchCampaign& campaign);

}  // namespace leeway::sim
