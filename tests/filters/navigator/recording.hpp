/// @file
/// Simulated logs for the filter tests.
#pragma once

#include <Eigen/Cholesky>
#include <cstdint>
#include <vector>

#include "leeway/ekf/ekf.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/gnss_simulator.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/sim/tools/random.hpp"

namespace leeway::test {

struct Recording {
  std::vector<ImuIncrement> imu;
  std::vector<GnssFix> fixes;  ///< ascending
  ImuBias bias{};              ///< at the end
};

/// A sensor of the model on true increments, and a fix every interval from `first_fix_s` on.
inline Recording record(const sim::Trajectory& trajectory, const std::vector<ImuIncrement>& truth,
                        const ImuErrorModel& imu, const sim::GnssErrorModel& gnss,
                        double interval_s, double first_fix_s, std::uint64_t seed) {
  sim::ImuErrorSimulator sensor(imu, sim::Random(seed, 0, sim::kImuStream));
  sim::GnssSimulator receiver(trajectory, gnss, sim::Random(seed, 0, sim::kGnssStream));
  Recording log;
  for (const ImuIncrement& inc : truth) log.imu.push_back(sensor.measure(inc));
  const double end_s = to_seconds(truth.back().time);
  for (int k = 0; first_fix_s + k * interval_s <= end_s; ++k) {
    log.fixes.push_back(receiver.fix_at(first_fix_s + k * interval_s));
  }
  log.bias = {sensor.accelerometer_bias_mps2(), sensor.gyro_bias_radps()};
  return log;
}

inline Estimate truth_estimate(const sim::Trajectory& trajectory, double t_s) {
  Estimate truth;
  truth.nav = sim::truth_at(trajectory, t_s).nav;
  return truth;
}

/// The estimate whose navigation error is drawn from P. @pre P is positive definite.
inline Estimate drawn_start(const Estimate& truth, const ErrorMatrix& P, std::uint64_t seed) {
  sim::Random random(seed, 0, sim::kInitialStateStream);
  ErrorVector unit;
  for (double& u : unit) u = random.normal();
  ErrorVector x = Eigen::LLT<ErrorMatrix>(P).matrixL() * unit;
  x.tail<6>().setZero();
  Estimate estimate = truth;
  inject(estimate, -x);
  return estimate;
}

}  // namespace leeway::test
