/// @file
/// Replay: a recorded or simulated log through the navigator, with GNSS outages withheld one at a
/// time, and the errors that grow in them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "leeway/filters/navigator.hpp"
#include "leeway/gnss_log.hpp"
#include "leeway/imu_log.hpp"
#include "leeway/truth_log.hpp"

namespace leeway::sim {

/// A GNSS outage: fixes with start < t <= start + duration are withheld.
struct Outage {
  double start_s{};
  double duration_s{};
};

/// [{"start_s": .., "duration_s": ..}, ..] @throws Error naming file, entry and what is wrong.
std::vector<Outage> read_outages(const std::filesystem::path& path);

struct ReplayInput {
  std::filesystem::path imu{};
  std::filesystem::path gnss{};
  std::filesystem::path truth{};     ///< empty: errors against withheld fixes
  std::filesystem::path solution{};  ///< empty: none is written
  ImuLogOptions imu_options{};
  GnssLogOptions gnss_options{};
  std::vector<Outage> outages{};
  double solution_rate_hz{10.0};
  /// Truth outside this window is not used.
  double truth_from_s{-1e300};
  double truth_to_s{1e300};
  /// Where to start; without it the navigator aligns.
  std::optional<Alignment> start{};
};

/// What the error at the end of an outage was measured against.
enum class Against { kNothing, kReference, kGnss };

struct OutageResult {
  Outage outage{};
  Against against{Against::kNothing};  ///< kNothing: no solution, or nothing to compare with
  double end_error_h_m{};
  double end_error_v_m{};
  double max_error_h_m{};  ///< over the withheld epochs and the end
  double end_sigma_h_m{};  ///< the filter's own sqrt(P_NN + P_EE) at the end
};

/// Root mean squares over the solution's epochs with truth.
struct RmsErrors {
  std::int64_t epochs{0};
  double horizontal_m{};
  double vertical_m{};
  double velocity_mps{};  ///< 3-D; NaN when the truth has none
  double attitude_deg{};  ///< 3-D rotation angle; NaN when the truth has none
};

struct ReplayResult {
  double first_solution_s{};
  double last_solution_s{};
  bool has_solution{false};
  std::vector<OutageResult> outages{};  ///< in the order given
  RmsErrors rms{};
  std::array<std::uint64_t, kVerdicts> verdicts{};
  std::int64_t fixes{0};    ///< that the filter judged: fused or gated
  double nis_mean{};        ///< over the fused fixes
  double nis_dof_mean{};    ///< what the mean should be
  double final_roll_deg{};  ///< attitude at the end: beyond 90 deg the mount is upside down
  LogReport imu_report{};
  LogReport gnss_report{};
  LogReport truth_report{};
};

/// Runs the log in one pass and constant memory. Every outage branches from the fully aided state,
/// so outages may overlap. @param progress  called now and then with the time reached
/// @throws Error when a file cannot be read or the configuration is invalid.
ReplayResult replay(const ReplayInput& input, const NavigatorConfig& config,
                    const std::function<void(Time)>& progress = {});

/// Errors of all outages of one duration.
struct OutageSummary {
  double duration_s{};
  std::int64_t count{0};     ///< with something to compare with
  std::int64_t unscored{0};  ///< without
  double rms_end_h_m{};
  double median_end_h_m{};
  double max_end_h_m{};
  double rms_end_v_m{};
  double rms_over_sigma_h{};  ///< RMS of error / sigma per horizontal axis pair: 1 when honest
};

/// By duration, shortest first.
std::vector<OutageSummary> summarize(const std::vector<OutageResult>& outages);

}  // namespace leeway::sim
