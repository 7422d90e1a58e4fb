/// @file
/// What a recorded log says of outages and of the interval between fixes: the errors of branches
/// that get fewer fixes than there are, and those that the covariance analysis expects of them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "leeway/model/error_metric.hpp"
#include "leeway/sim/replay/replay.hpp"

namespace leeway::sim {

/// Intervals between fixes that logs are asked for, s: about half an octave apart.
inline constexpr std::array kStudiedIntervalsS{1.0,  1.5,  2.0,  3.0,  4.0,  6.0,  8.0,  11.0,
                                               16.0, 23.0, 32.0, 45.0, 64.0, 90.0, 128.0};

/// Options of a log study.
struct LogStudyConfig {
  ErrorMetric metric{ErrorMetric::kR95};                    ///< what an error's size is
  std::vector<double> durations_s{5, 10, 20, 30, 60, 120};  ///< of outages, ascending
  double every_s{10.0};  ///< an outage begins so long after the one before
  /// All fixes are used for so long after the first solution, or for half of the solution where it
  /// is shorter than twice that.
  double settle_s{300.0};
  int most_phases{8};         ///< of an interval: so many beginnings are tried
  double min_speed_mps{1.0};  ///< an outage begins while moving: faster than fixes wander
  int threads{0};             ///< 0: all processors
};

/// One outage of one duration.
struct OutageError {
  double start_s{};
  double duration_s{};
  double end_h_m{};
  double largest_h_m{};
};

/// The size of the error, by the study's metric, just before a fix of a row of thinned ones.
struct FixError {
  double t_s{};
  std::size_t interval{};  ///< of kStudiedIntervalsS
  double size_m{};
};

/// What is expected of it.
struct ExpectedFixError {
  std::size_t interval{};
  /// Variances along the principal axes of the error; of one axis, or of a sum over axes, the
  /// second is 0.
  std::array<double, 2> variances_m2{};
};

/// What the receiver of a log is taken for.
struct LogReceiver {
  double interval_s{};  ///< between fixes: the median
  double
      sigma_h_m{};  ///< medians over the fixes, per axis, by the median of the navigator's scales
  double sigma_v_m{};
  double sigma_h_mps{};
  double sigma_v_mps{};
  double position_scale{1.0};  ///< of what the log claims
  double velocity_scale{1.0};
};

struct LogStudy {
  bool has_solution{false};
  Against against{Against::kNothing};
  double first_s{};    ///< of the solution
  double settled_s{};  ///< from here on fixes are withheld
  double last_s{};
  LogReceiver receiver{};
  double imu_sigma_scale{1.0};  ///< by the navigator: median
  std::vector<OutageError> outages{};
  std::vector<FixError> errors{};            ///< measured
  std::vector<ExpectedFixError> expected{};  ///< of the same fixes
  std::string not_expected{};                ///< why there is no expectation; empty: there is
};

/// The study of one log: a pass with all fixes, then passes with kMostBranches or fewer branches
/// each, several at a time. Constant memory but for the answer and the smoothed motion.
/// @param input  outages, thinnings and solution are not used
/// @param surveyed  called with the result of the first pass
/// @throws Error as replay(), or when a log is no file: it is read several times.
LogStudy study_log(const ReplayInput& input, const NavigatorConfig& config,
                   const LogStudyConfig& study,
                   const std::function<void(const ReplayResult&)>& surveyed = {});

/// A study as bytes, for another rank of the same run, and back.
std::string bytes_of(const LogStudy& study);
LogStudy log_study_of(const std::string& bytes);

}  // namespace leeway::sim
