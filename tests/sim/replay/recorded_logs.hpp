/// @file
/// Logs of a simulated drive, in a folder.
#pragma once

#include <cmath>

#include "leeway/sim/replay/replay.hpp"
#include "leeway/sim/sensors/gnss_simulator.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::sim {

inline constexpr double kRecordedImuHz = 50.0;

/// IMU, GNSS once a second, and truth, with sensors as the models say, of seed 1.
inline ReplayInput record_logs(const test::TempDir& dir, const Trajectory& trajectory,
                               double duration_s, const ImuErrorModel& model,
                               const GnssErrorModel& gnss_model) {
  ImuErrorSimulator sensor(model, Random(1, 0, kImuStream));
  GnssSimulator receiver(trajectory, gnss_model, Random(1, 0, kGnssStream));
  ReplayInput input;
  input.imu = dir / "imu.csv";
  input.gnss = dir / "gnss.csv";
  input.truth = dir / "truth.csv";
  ImuLogWriter imu(input.imu);
  GnssLogWriter gnss(input.gnss);
  TruthLogWriter truth(input.truth);
  for (const ImuIncrement& inc : true_increments(trajectory, kRecordedImuHz, duration_s)) {
    imu.write(sensor.measure(inc));
    const double t_s = to_seconds(inc.time);
    truth.write({ned_from_nav_state(truth_at(trajectory, t_s).nav), true, true});
    if (std::abs(t_s - std::round(t_s)) < 1e-6) gnss.write(receiver.fix_at(t_s));
  }
  imu.close();
  gnss.close();
  truth.close();
  return input;
}

}  // namespace leeway::sim
