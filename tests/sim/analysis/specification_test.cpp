#include "leeway/sim/analysis/specification.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "leeway/sim/motion/trajectories.hpp"

namespace leeway::sim {
namespace {

/// A scene that has every specification.
Scene complete_scene() {
  Scene scene;
  scene.name = "complete";
  scene.trajectory = square_loop();
  scene.duration_s = 1200.0;
  scene.estimator = SceneEstimator::kNavigator;
  ImuErrorModel imu = automotive_mems_model();
  for (TriadErrorModel* triad : {&imu.accelerometer, &imu.gyro}) {
    triad->scale_sigma = 1e-3;
    triad->misalignment_sigma_rad = 1e-3;
  }
  imu.gyro.M(0, 1) = 2e-3;
  imu.gyro.M(1, 1) = 1.004;
  imu.G_g_sigma_radps_per_mps2 = 1e-6;
  set_imu(scene, "complete", imu);
  scene.gnss.errors.correlated_sigma_n_m.setConstant(3.0);
  scene.vehicle = scene_vehicle(VehicleKind::kCar);
  scene.vehicle->odometer = VehicleSensor{1.0, 0.1};
  scene.vehicle->barometer = VehicleSensor{1.0, 0.5};
  scene.vehicle->heading = VehicleSensor{1.0, 0.02};
  return scene;
}

}  // namespace

TEST_CASE("specification: a complete scene has all, a plain one what it states") {
  CHECK(specifications(complete_scene()).size() == kAll<Specification>.size());
  Scene plain = complete_scene();
  plain.vehicle.reset();
  plain.gnss.errors.correlated_sigma_n_m.setZero();
  set_imu(plain, "tactical", imu_class_model(ImuClass::kTactical, RangeEnd::kMid));
  const std::vector<Specification> stated = specifications(plain);
  using enum Specification;
  CHECK(stated == std::vector{kAccelerometerBias, kAccelerometerNoise, kGyroBias, kGyroNoise,
                              kGnssPosition, kGnssVelocity});
}

TEST_CASE("specification: a factor and its inverse give the scene back") {
  const Scene scene = complete_scene();
  const ErrorTrack track = error_track(scene);
  const double own_m = analyze(scene, track).true_m;
  for (const Specification specification : specifications(scene)) {
    CAPTURE(name(specification));
    const Scene there = scaled(scene, specification, 3.0);
    const Scene back = scaled(there, specification, 1.0 / 3.0);
    CHECK(std::abs(analyze(back, track).true_m / own_m - 1.0) < 1e-9);
  }
}

TEST_CASE("specification: truth and belief are scaled, deviations and not the unit matrix") {
  const Scene scene = complete_scene();
  const Scene noise = scaled(scene, Specification::kGyroNoise, 2.0);
  CHECK(noise.imu.gyro.noise_density == 2.0 * scene.imu.gyro.noise_density);
  CHECK(noise.filter.imu.gyro.noise_density == 2.0 * scene.imu.gyro.noise_density);
  CHECK(noise.imu.accelerometer.noise_density == scene.imu.accelerometer.noise_density);
  const Scene scale = scaled(scene, Specification::kGyroScale, 2.0);
  CHECK(std::abs(scale.imu.gyro.M(1, 1) - 1.008) < 1e-12);
  CHECK(scale.imu.gyro.M(0, 0) == 1.0);
  CHECK(scale.imu.gyro.M(0, 1) == 2e-3);
  const Scene misaligned = scaled(scene, Specification::kGyroMisalignment, 2.0);
  CHECK(misaligned.imu.gyro.M(0, 1) == 4e-3);
  CHECK(misaligned.imu.gyro.M(1, 1) == 1.004);
}

TEST_CASE("specification: every source of an IMU and a receiver is the sigma of one") {
  for (const Specification specification : kAll<Specification>) {
    CAPTURE(name(specification));
    const bool is_told_only = specification == Specification::kGnssCorrelationTime ||
                              specification == Specification::kStandstill ||
                              specification == Specification::kNoSideSlip;
    CHECK(source_of(specification).has_value() != is_told_only);
  }
}

}  // namespace leeway::sim
