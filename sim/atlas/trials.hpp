/// @file
/// Simulated drives for the scenes that try estimators, and how a column fares on them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "leeway/model/initial_covariance.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/scene/scene.hpp"
#include "sim/atlas/cells.hpp"
#include "sim/atlas/watched_filter.hpp"
#include "sim/trials/recorded_trial.hpp"

namespace leeway::sim {

/// What a car that has just been aligned knows, 1 sigma.
inline constexpr InitialSigma kAlignedCar{
    .tilt_rad = 0.03, .heading_rad = 0.1, .velocity_mps = 0.1, .position_m = 2.5};

/// An IMU, car-grade by default, over the whole seconds of a trajectory, and a filter that takes
/// fixes for what they are: white.
/// @param initial  1 sigma at the start
Scene drive_scene(const Trajectory& trajectory, double imu_rate_hz,
                  const InitialSigma& initial = kAlignedCar,
                  const ImuErrorModel& imu = automotive_mems_model());

/// The square loop at 20 m/s on a car-grade MEMS IMU at 100 Hz, white fixes of 2.5 m.
Scene town_drive(double duration_s);

/// Trials of a scene, seeds 1 to n, with the truth at every fix.
std::vector<RecordedTrial> recorded_trials(const Scene& scene, int n);

/// What a driver, a clock or a sensor does to the inputs of a trial. They are delivered where the
/// trial has them, whatever times they then bear.
using Spoil = std::function<void(RecordedTrial& trial)>;

/// A condition of a scene.
struct SpoiledCondition {
  std::string condition{};
  Spoil spoil{};
};

Spoil each_increment(std::function<void(ImuIncrement&)> spoil);
Spoil each_fix(std::function<void(GnssFix&)> spoil);

std::vector<RecordedTrial> spoiled(std::vector<RecordedTrial> trials, const Spoil& spoil);

/// Called just before a fix is used, with the truth at its time.
using BeforeFix = std::function<void(const Estimate& truth, const WatchedFilter& filter)>;

/// Runs the filter over the whole trial.
void replay(WatchedFilter& filter, const RecordedTrial& trial, const BeforeFix& before_fix = {});

/// Of a filter that has been started on a trial, the figure.
using Score = std::function<double(WatchedFilter& filter, const RecordedTrial& trial)>;

/// Each column on every trial: the root mean square of its figures, and what its detectors said in
/// every one of the trials that are as bad as that or worse.
std::vector<AtlasCell> scored(const std::vector<AtlasColumn>& columns, const EkfConfig& believed,
                              const std::vector<RecordedTrial>& trials,
                              const std::string& condition, const Score& score);

/// Sums of errors over the fixes of a run, for figures.
struct ErrorSums {
  double epochs{0.0};
  double position_m2{0.0};  ///< squared, north, east and down together
  double horizontal_m2{0.0};
  double nees{0.0};  ///< of 15 states; NaN once P is not positive or nothing is claimed
  bool finite{true};

  void add(const Estimate& truth, const WatchedFilter& filter);
  double position_rms_m() const;    ///< infinite unless finite
  double horizontal_rms_m() const;  ///< likewise
  double sigma_ratio() const;       ///< sqrt(NEES / 15): errors over claims; infinite without
};

/// Runs the filter over the whole trial. @returns the errors before fixes later than from_s
ErrorSums errors_after(WatchedFilter& filter, const RecordedTrial& trial, double from_s);

/// The figure of the errors before fixes later than from_s.
Score score_after(double from_s, double (ErrorSums::*figure)() const);

/// A figure: heading error over its claimed sigma just before the last fix. Infinite without an
/// estimate or a claim.
double final_heading_over_claim(WatchedFilter& filter, const RecordedTrial& trial);

/// Sum of the variances north and east that a filter claims for its position.
double claimed_horizontal_m2(const Estimate& truth, const ErrorMatrix& P);

/// Turn about the local vertical by which the estimate's heading is off, rad, in 0 to pi.
double heading_error_rad(const Estimate& truth, const Estimate& estimate);

}  // namespace leeway::sim
