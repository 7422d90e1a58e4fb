/// @file
/// Replay: a recorded or simulated log through the navigator, with GNSS outages withheld one at a
/// time, and the errors that grow in them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "leeway/logs/gnss_log.hpp"
#include "leeway/logs/imu_log.hpp"
#include "leeway/logs/scalar_log.hpp"
#include "leeway/logs/solution_writer.hpp"
#include "leeway/logs/truth_log.hpp"
#include "leeway/navigator/aidings.hpp"
#include "leeway/navigator/navigator.hpp"
#include "leeway/sim/inspect/log_look.hpp"
#include "leeway/sim/scene/outage.hpp"

namespace leeway::sim {

/// The logs of the sensors of kAidings, in their order. Empty: none.
using AidingLogs = std::array<std::filesystem::path, kAidings.size()>;

/// Fixes further apart: after the start one each interval is used, the others are withheld.
struct Thinning {
  double start_s{};
  double interval_s{};
};

/// Logs of a replay, and what is done with them.
struct ReplayInput {
  std::filesystem::path imu{};
  std::filesystem::path gnss{};
  AidingLogs aidings{};
  std::filesystem::path truth{};     ///< empty: errors against withheld fixes
  std::filesystem::path solution{};  ///< empty: none is written
  SolutionForm solution_form{};
  ImuLogOptions imu_options{};
  GnssLogOptions gnss_options{};
  std::vector<Outage> outages{};
  std::vector<Thinning> thinnings{};
  double solution_rate_hz{10.0};
  /// Truth outside this window is not used.
  double truth_from_s{-1e300};
  double truth_to_s{1e300};
  /// Heading at the first IMU data, for the alignment; its time does not count.
  std::optional<MeasuredHeading> start_heading{};
  /// Where to start; without it the navigator aligns.
  std::optional<Alignment> start{};
  /// Goes on, whatever is found in the logs.
  bool is_as_is{false};
  /// Finding::about of what the configuration takes care of already.
  std::vector<std::string> taken_care_of{};
};

/// Root mean squares over the solution's epochs with truth.
struct RmsErrors {
  std::int64_t epochs{0};
  double horizontal_m{};
  double vertical_m{};
  double velocity_mps{};  ///< 3-D; NaN when the truth has none
  double attitude_deg{};  ///< 3-D rotation angle; NaN when the truth has none
};

/// Result of a replay.
struct ReplayResult {
  double first_solution_s{};
  double last_solution_s{};
  bool has_solution{false};
  std::int64_t fixes_in_span{0};        ///< of the IMU data; 0: the logs do not share a time line
  std::vector<OutageResult> outages{};  ///< in the order given
  RmsErrors rms{};
  std::array<std::uint64_t, kVerdicts> verdicts{};
  std::int64_t fixes{0};  ///< that the filter judged: fused or gated
  double nis_mean{};      ///< over the fused fixes
  double nis_dof_mean{};  ///< what the mean should be
  Health health{};        ///< at the end
  std::optional<Eigen::Vector3d>
      mount_rpy_deg{};      ///< found: Rz(Y) Ry(P) Rx(R), to forward, right, down
  double final_roll_deg{};  ///< attitude at the end: beyond 90 deg the mount is upside down
  LogLook look{};           ///< at what was read, in the axes and times that were told
  bool is_refused{false};   ///< the logs are certainly wrong: it stopped, and wrote no solution
  LogSummary imu_summary{};
  LogSummary gnss_summary{};
  LogSummary truth_summary{};
  std::array<LogSummary, kAidings.size()> aiding_summaries{};
};

/// The error of a branch without fixes, at the time of a withheld fix or at its end.
struct OutageEpoch {
  std::size_t outage{};  ///< of ReplayInput::outages
  double since_s{};      ///< since it began
  double error_h_m{};
  double sigma_h_m{};  ///< the branch's own sqrt(P_NN + P_EE)
  Eigen::Vector3d error_n_m{Eigen::Vector3d::Zero()};
};

/// The error of a branch with thinned fixes, just before it uses one.
struct ThinnedEpoch {
  std::size_t thinning{};  ///< of ReplayInput::thinnings
  double t_s{};
  Eigen::Vector3d error_n_m{Eigen::Vector3d::Zero()};
  double course_rad{};  ///< over ground
};

/// Callbacks on the way; empty ones are not called.
struct ReplayObserver {
  std::function<void(Time)> progress{};  ///< now and then, with the time reached
  /// At the rate of the solution, with the truth of that time where there is one.
  std::function<void(const Solution&, const std::optional<TruthRecord>&)> epoch{};
  std::function<void(const Health&)> health{};      ///< at the same rate
  std::function<void(const UpdateOutcome&)> fix{};  ///< every fix that the filter judged
  std::function<void(Time, Verdict)> verdict{};     ///< all but what is accepted or aligned with
  std::function<void(const OutageEpoch&)> outage{};
  std::function<void(const ThinnedEpoch&)> thinned{};
};

/// How many copies of the navigator, each of a megabyte or so, a pass over the log may carry.
inline constexpr std::size_t kMostBranches = 64;

/// Columns of the log of a sensor.
ScalarColumns columns_of(const Aiding& aiding);

/// The replay of the logs in constant memory. Every outage and every thinning branches from the
/// fully aided state, so they may overlap: one pass over the logs is made for each kMostBranches of
/// them that do. The logs are looked at on the way: as soon as a finding is certain, it stops.
/// @throws Error when a file cannot be read or the configuration is invalid, or when a log that
/// several passes need is a pipe.
ReplayResult replay(const ReplayInput& input, const NavigatorConfig& config,
                    const ReplayObserver& observer = {});

}  // namespace leeway::sim
