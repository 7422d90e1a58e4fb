/// @file
/// Covariance analysis of a scene: what the filter claims, what is true when the sensors and the
/// receiver have errors that the filter does not model, and which source the error comes from.
/// Linear: no trials, no noise in the answer. sim/campaign.hpp is the nonlinear check.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "leeway/earth/names.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/sim/analysis/error_track.hpp"
#include "leeway/sim/analysis/worst_errors.hpp"
#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

/// Sources of errors. They are independent of each other, so their variances add up.
enum class ErrorSource {
  kInitial,             ///< attitude, velocity and position at the start
  kAccelerometerBias,   ///< turn-on spread, and what the filter is not told of the known part
  kAccelerometerDrift,  ///< in-run Gauss-Markov
  kAccelerometerNoise,  ///< white
  kAccelerometerScale,  ///< diagonal of M_a
  kAccelerometerMisalignment,  ///< the rest of M_a
  kGyroBias,
  kGyroDrift,
  kGyroNoise,
  kGyroScale,
  kGyroMisalignment,
  kGyroGSensitivity,  ///< G_g
  kGnssPosition,      ///< white
  kGnssCorrelated,    ///< Gauss-Markov, of position
  kGnssVelocity,      ///< white
  kOdometer,            ///< its scale and noise
  kBarometer,           ///< its offset and noise
  kHeading,             ///< noise of a measured heading
};
constexpr auto names(ErrorSource) {
  return std::array{"initial",
                    "accelerometer_bias",
                    "accelerometer_drift",
                    "accelerometer_noise",
                    "accelerometer_scale",
                    "accelerometer_misalignment",
                    "gyro_bias",
                    "gyro_drift",
                    "gyro_noise",
                    "gyro_scale",
                    "gyro_misalignment",
                    "gyro_g_sensitivity",
                    "gnss_position",
                    "gnss_correlated",
                    "gnss_velocity",
                    "odometer",
                    "barometer",
                    "heading"};
}

/// Contribution of one source to the position error.
struct ErrorBudgetLine {
  ErrorSource source{};
  Eigen::Matrix3d mean_sq_n_m2{Eigen::Matrix3d::Zero()};  ///< E[x x^T], north, east, down
};

/// Contributions of the sources that the scene has. Their mean squares add up to that of the error.
using ErrorBudget = std::vector<ErrorBudgetLine>;

/// The covariances at a moment of the scene, of the 15 errors of error_state.hpp.
struct CovariancePoint {
  enum class Moment {
    kBetween,    ///< on the way
    kBeforeFix,  ///< a fix has arrived and is not used yet
    kAfterFix
  };
  double t_s{};
  Moment moment{Moment::kBetween};
  Eigen::Vector3d r_e_m{Eigen::Vector3d::Zero()};  ///< of the truth
  ErrorMatrix claimed{ErrorMatrix::Zero()};        ///< the filter's covariance
  ErrorMatrix truth{ErrorMatrix::Zero()};          ///< E[x x^T] of its error
  /// E[z z^T] of the position innovation along north, east, down: how far the estimate is from a
  /// fix of this moment, which repeats the errors of those before it. Before a fix only.
  Eigen::Matrix3d innovation_n_m2{Eigen::Matrix3d::Zero()};
};

/// Options of a covariance analysis.
struct CovarianceConfig {
  bool by_source{false};  ///< splits the truth by source: about as many times slower
  /// Called at every step and on both sides of every fix.
  std::function<void(const CovariancePoint&)> observer{};
};

/// Result of an analysis: the worst error just before a fix, outages included, over the last part
/// of the scene, scored_part_s(scene). The worst is the largest by the scene's metric, and where
/// the limit grows with the way the largest over what is allowed.
struct CovarianceAnalysis {
  double claimed_m{};  ///< by the scene's metric; where the claim is the worst
  double true_m{};
  double allowed_m{};  ///< what the scene allows where the true error is the worst
  WorstErrors claimed_errors{};  ///< by the scene's metric, for other limits; those that grow are
                                 ///< answered where the scene's does
  WorstErrors true_errors{};
  double claimed_drms_m{};  ///< root mean square over the last part's fixes, not the largest: what
  double true_drms_m{};     ///< a Monte Carlo of the scene averages
  Eigen::Vector3d true_rms_n_m{Eigen::Vector3d::Zero()};  ///< likewise, along north, east, down
  double worst_s{};         ///< when the true one is the worst
  CovariancePoint worst{};  ///< there
  ErrorBudget error_budget{};  ///< there; empty unless by_source
  double window_s{};           ///< the last part, s
  std::size_t fixes{0};        ///< used by the filter
  bool settled{false};  ///< every sigma repeats to 0.1 % from one repeating_part_s() to the next
  double settled_s{};          ///< since when; the scene's end where it has not settled
};

/// The linearized dynamics that analyze() needs; those of one scene serve it with any GNSS.
/// @param step_s  the longest step of the covariance; shortened to resolve the sensors' drift
ErrorTrack error_track(const Scene& scene, double step_s = 1.0);

/// The analysis of a scene. Fixes act at their own times; with latency the error that counts is
/// that at their arrival. The scene is followed to its end also when it has settled: what repeats
/// to 0.1 % from one part to the next may still creep by more over a day. Outliers and the filter's
/// gate are left out, being no linear errors.
/// @param track  error_track() of this scene
/// @throws Error when the scene is invalid, or no fix falls into the last part.
CovarianceAnalysis analyze(const Scene& scene, const ErrorTrack& track,
                           const CovarianceConfig& config = {});

/// The covariances at every moment of a scene, which need not have a fix that counts.
/// @throws Error when the scene is invalid.
void follow(const Scene& scene, const ErrorTrack& track,
            const std::function<void(const CovariancePoint&)>& observer);

/// The error that grows without any fix from a start without error in attitude, velocity and
/// position; the sensors have theirs.
/// @param observer  called at every step of the track until it returns false or the scene ends
/// @throws Error when the scene is invalid.
void free_inertial(const Scene& scene, const ErrorTrack& track,
                   const std::function<bool(const CovariancePoint&)>& observer);

}  // namespace leeway::sim
