#include <cmath>
#include <limits>
#include <optional>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/sim/tools/random.hpp"
#include "sim/atlas/faults/fault.hpp"

namespace leeway::sim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Fault imu(std::string name, double duration_s, Damage damage) {
  return {.name = std::move(name), .group = FaultGroup::kImu, .duration_s = duration_s,
          .damage = std::move(damage)};
}

Damage silent_imu() {
  return [](FaultInputs& inputs, const FaultWindow& window) {
    drop_in(inputs.imu, window, [](double) { return true; });
  };
}

/// Both triads, or one of them, by a matrix.
Damage turned_by(const Matrix3d& gyro, const Matrix3d& accelerometer) {
  return on_imu([=](ImuIncrement& inc, double) {
    inc.dtheta_b_rad = gyro * inc.dtheta_b_rad;
    inc.dv_b_mps = accelerometer * inc.dv_b_mps;
  });
}

Damage turned_by(const Matrix3d& both) { return turned_by(both, both); }

Damage biased(const Vector3d& gyro_radps, const Vector3d& accelerometer_mps2) {
  return on_imu([=](ImuIncrement& inc, double) {
    inc.dtheta_b_rad += inc.dt_s * gyro_radps;
    inc.dv_b_mps += inc.dt_s * accelerometer_mps2;
  });
}

Matrix3d swapping(int i, int k) {
  Matrix3d swap = Matrix3d::Identity();
  swap.row(i).swap(swap.row(k));
  return swap;
}

Matrix3d flipping(int i) {
  Matrix3d flip = Matrix3d::Identity();
  flip(i, i) = -1.0;
  return flip;
}

/// Both at the values of the first increment.
void hold_first(FaultInputs& inputs, const FaultWindow& window) {
  std::optional<ImuIncrement> first;
  for_each_in(inputs.imu, window, [&](ImuIncrement& inc, double) {
    if (!first) first = inc;
    inc.dtheta_b_rad = first->dtheta_b_rad;
    inc.dv_b_mps = first->dv_b_mps;
  });
}

Damage saturated(double gyro_radps, double accelerometer_mps2) {
  const auto held = [](const Vector3d& v, double range) -> Vector3d {
    return v.cwiseMin(range).cwiseMax(-range);
  };
  return on_imu([=](ImuIncrement& inc, double) {
    inc.dtheta_b_rad = held(inc.dtheta_b_rad, gyro_radps * inc.dt_s);
    inc.dv_b_mps = held(inc.dv_b_mps, accelerometer_mps2 * inc.dt_s);
  });
}

/// White noise so many times that of the model, beside its own.
Damage noisier(double times) {
  return [times](FaultInputs& inputs, const FaultWindow& window) {
    const ImuErrorModel model = automotive_mems_model();
    Random random(1, 0, kFirstFreeStream);
    for_each_in(inputs.imu, window, [&](ImuIncrement& inc, double) {
      const double root_s = times * std::sqrt(inc.dt_s);
      inc.dtheta_b_rad += root_s * model.gyro.noise_density * random.normal3();
      inc.dv_b_mps += root_s * model.accelerometer.noise_density * random.normal3();
    });
  };
}

/// Biases that wander so many times as far as the model says.
Damage drifting(double times) {
  return [times](FaultInputs& inputs, const FaultWindow& window) {
    const ImuErrorModel model = automotive_mems_model();
    Random random(1, 0, kFirstFreeStream);
    Vector3d gyro_radps = Vector3d::Zero();
    Vector3d accelerometer_mps2 = Vector3d::Zero();
    const auto walk = [&](const GaussMarkov& drift, double dt_s) -> Vector3d {
      return times * drift.sigma * std::sqrt(2.0 * dt_s / drift.tau_s) * random.normal3();
    };
    for_each_in(inputs.imu, window, [&](ImuIncrement& inc, double) {
      gyro_radps += walk(model.gyro.in_run, inc.dt_s);
      accelerometer_mps2 += walk(model.accelerometer.in_run, inc.dt_s);
      inc.dtheta_b_rad += inc.dt_s * gyro_radps;
      inc.dv_b_mps += inc.dt_s * accelerometer_mps2;
    });
  };
}

/// Along all three axes, near a third of the rate of 50 Hz and so aliased little.
void vibrate(ImuIncrement& inc, double since_s) {
  constexpr double kAmplitudeMps2 = 2.0;
  constexpr double kRateRadps = 110.0;
  inc.dv_b_mps += inc.dt_s * kAmplitudeMps2 *
                  Vector3d(std::sin(kRateRadps * since_s), std::sin(1.1 * kRateRadps * since_s),
                           std::sin(1.2 * kRateRadps * since_s));
}

/// An increment in every second that is far beyond any motion, within what the sensor can measure.
void spike(ImuIncrement& inc, double since_s) {
  if (since_s - std::floor(since_s) > 1.01 * inc.dt_s) return;
  inc.dtheta_b_rad.z() += 8.0 * inc.dt_s;
  inc.dv_b_mps.x() += 80.0 * inc.dt_s;
}

void lose_one_in_ten(FaultInputs& inputs, const FaultWindow& window) {
  int k = 0;
  drop_in(inputs.imu, window, [&k](double) { return ++k % 10 == 0; });
}

void double_all(FaultInputs& inputs, const FaultWindow& window) {
  const std::vector<Arrival<ImuIncrement>> before = inputs.imu;
  for (const Arrival<ImuIncrement>& a : before) {
    if (window.has(a.at_s)) inputs.imu.push_back(a);
  }
}

std::vector<Fault> of_axes() {
  const Matrix3d one = Matrix3d::Identity();
  const Matrix3d skewed = exp_rotation(Vector3d(0.0, 3.0 * kRadPerDeg, 3.0 * kRadPerDeg));
  return {
      imu("axes x and y swapped", 30.0, turned_by(swapping(0, 1))),
      imu("axes y and z swapped", 30.0, turned_by(swapping(1, 2))),
      imu("sign of the gyro's x", 30.0, turned_by(flipping(0), one)),
      imu("sign of the gyro's z", 30.0, turned_by(flipping(2), one)),
      imu("sign of the accelerometer's x", 30.0, turned_by(one, flipping(0))),
      imu("sign of all forces", 30.0, turned_by(one, -one)),
      imu("scale off by 3 %", 30.0, turned_by(1.03 * one)),
      imu("gyro's scale off by 0.1 %", 30.0, turned_by(1.001 * one, one)),
      imu("mount off by 3 deg", 30.0, turned_by(skewed)),
      imu("forces in g", 30.0, turned_by(one, one / kStandardGravityMps2)),
      imu("deg/s for rad/s", 30.0, turned_by(one / kRadPerDeg, one)),
      imu("rad/s for deg/s", 30.0, turned_by(kRadPerDeg * one, one)),
      imu("gyro all zero", 30.0, turned_by(Matrix3d::Zero(), one)),
      imu("IMU all zero", 30.0, turned_by(Matrix3d::Zero())),
  };
}

std::vector<Fault> of_errors() {
  const Vector3d none = Vector3d::Zero();
  const Vector3d z = Vector3d::UnitZ();
  const Vector3d x = Vector3d::UnitX();
  constexpr double kNotFinite = std::numeric_limits<double>::quiet_NaN();
  return {
      imu("gyro's z bias steps by 0.5 deg/s", 30.0, biased(0.5 * kRadPerDeg * z, none)),
      imu("gyro's z bias steps by 2 deg/s", 30.0, biased(2.0 * kRadPerDeg * z, none)),
      imu("gyro's x bias steps by 2 deg/s", 30.0, biased(2.0 * kRadPerDeg * x, none)),
      imu("accelerometer steps by 0.2 m/s^2", 30.0, biased(none, 0.2 * x)),
      imu("accelerometer steps by 1 m/s^2", 30.0, biased(none, x)),
      imu("noise 10 times", 30.0, noisier(10.0)),
      imu("noise 30 times", 30.0, noisier(30.0)),
      imu("drift 10 times", 60.0, drifting(10.0)),
      imu("vibration of 2 m/s^2", 30.0, on_imu(vibrate)),
      imu("a spike every second", 30.0, on_imu(spike)),
      imu("IMU not a number", 10.0, biased(kNotFinite * z, none)),
  };
}

}  // namespace

std::vector<Fault> imu_faults() {
  std::vector<Fault> all{
      imu("hole of 0.3 s", 0.3, silent_imu()),
      imu("hole of 2 s", 2.0, silent_imu()),
      imu("hole of 5 s", 5.0, silent_imu()),
      imu("hole of 30 s", 30.0, silent_imu()),
      imu("stuck for 10 s", 10.0, hold_first),
      imu("gyro beyond its range of 5 deg/s", 30.0, saturated(5.0 * kRadPerDeg, 1e3)),
      imu("accelerometer beyond 9.7 m/s^2", 30.0, saturated(1e2, 9.7)),
      imu("every 10th increment lost", 30.0, lose_one_in_ten),
      imu("all increments twice", 30.0, double_all),
  };
  for (const auto& more : {of_axes(), of_errors()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace leeway::sim
