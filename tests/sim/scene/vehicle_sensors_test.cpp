#include "leeway/sim/scene/vehicle_sensors.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <variant>

#include "leeway/sim/motion/trajectories.hpp"

namespace leeway::sim {
namespace {

constexpr double kSpeedMps = 20.0;

SceneVehicle with_odometer(double sigma_mps, double scale_sigma) {
  SceneVehicle vehicle = scene_vehicle(VehicleKind::kCar);
  vehicle.odometer = VehicleSensor{0.5, sigma_mps};
  vehicle.config.odometer = true;
  vehicle.config.odometer_scale_sigma = scale_sigma;
  vehicle.config.odometer_walk_per_sqrt_s = 0.0;
  return vehicle;
}

/// Of all readings over a time on the square loop, at the increments of an IMU.
template <class F>
void read_all(VehicleSensors& sensors, double duration_s, F&& f) {
  const Trajectory trajectory = square_loop();
  constexpr double kStepS = 0.02;
  for (int k = 1; k * kStepS <= duration_s + 1e-9; ++k) {
    const double now_s = k * kStepS;
    sensors.read(trajectory, time_from_seconds(now_s), now_s - kStepS, now_s, f);
  }
}

}  // namespace

TEST_CASE("an odometer reads at multiples of its interval, with its noise and its own scale") {
  double sum = 0.0;
  double sum_sq = 0.0;
  double scale_sq = 0.0;
  constexpr int kSeeds = 200;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    VehicleSensors sensors(with_odometer(0.1, 0.02), seed);
    double mean = 0.0;
    int count = 0;
    read_all(sensors, 20.0, [&](const Reading& reading) {
      const auto& odometer = std::get<OdometerSpeed>(reading);
      CHECK(std::abs(std::remainder(to_seconds(odometer.time), 0.5)) < 1e-6);
      mean += odometer.speed_mps;
      ++count;
    });
    CHECK(count == 40);
    mean /= count;
    const double scale = mean / kSpeedMps - 1.0;
    sum += scale;
    scale_sq += scale * scale;
    sum_sq += mean;
  }
  // 200 draws: the scatter is known to 5 %, the mean to 0.02 / sqrt(200); four sigmas of each. The
  // noise of a mean of 40 readings, 0.016 m/s, is 4 % of the scale's 0.4 m/s.
  CHECK(std::abs(std::sqrt(scale_sq / kSeeds) / 0.02 - 1.0) < 0.2);
  CHECK(std::abs(sum / kSeeds) < 4.0 * 0.02 / std::sqrt(double{kSeeds}));
  CHECK(std::abs(sum_sq / kSeeds / kSpeedMps - 1.0) < 0.01);
}

TEST_CASE("a seed gives the same readings again, and sensors that are not there give none") {
  const auto first_of = [](std::uint64_t seed) {
    VehicleSensors sensors(with_odometer(0.1, 0.02), seed);
    double first = 0.0;
    read_all(sensors, 0.5, [&](const Reading& reading) {
      first = std::get<OdometerSpeed>(reading).speed_mps;
    });
    return first;
  };
  CHECK(first_of(1) == first_of(1));
  CHECK(first_of(1) != first_of(2));
  VehicleSensors none(scene_vehicle(VehicleKind::kCar), 1);
  CHECK(!none.any());
  read_all(none, 5.0, [](const Reading&) { FAIL("no sensor was asked for"); });
}

TEST_CASE("a measured heading is that of the body, within its noise") {
  SceneVehicle vehicle = scene_vehicle(VehicleKind::kBoat);
  constexpr double kSigmaRad = 0.5 * kRadPerDeg;
  vehicle.heading = VehicleSensor{1.0, kSigmaRad};
  VehicleSensors sensors(vehicle, 1);
  const Trajectory trajectory = square_loop();
  int count = 0;
  read_all(sensors, 240.0, [&](const Reading& reading) {
    const auto& heading = std::get<MeasuredHeading>(reading);
    const NavState truth = truth_at(trajectory, to_seconds(heading.time)).nav;
    const Azimuth azimuth(truth.q_eb.toRotationMatrix().col(0), truth.r_e_m);
    // Five sigmas: of 240 readings one in 7000 runs has one beyond.
    CHECK(std::abs(wrap_pi(heading.heading_rad - azimuth.angle_rad)) < 5.0 * kSigmaRad);
    ++count;
  });
  CHECK(count == 240);
}

}  // namespace leeway::sim
