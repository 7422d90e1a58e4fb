#include "sim/atlas/mismatch/true_imu.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>

#include "leeway/ekf/ekf_config.hpp"
#include "leeway/sim/sensors/imu_catalogue.hpp"

namespace leeway::sim {
namespace {

void multiply(TriadErrorModel& triad, Mismatch what, double factor) {
  const bool all = what == Mismatch::kAll;
  if (all || what == Mismatch::kNoise) triad.noise_density *= factor;
  if (all || what == Mismatch::kDrift) triad.in_run.sigma *= factor;
  if (all || what == Mismatch::kScale) triad.scale_sigma *= factor;
  if (all || what == Mismatch::kMisalignment) triad.misalignment_sigma_rad *= factor;
}

/// Beyond this it is no sensor of motion: a tenth of what it measures is wrong.
bool is_an_imu(const ImuErrorModel& model) {
  constexpr double kMost = 0.1;
  const auto is_one = [](const TriadErrorModel& triad) {
    return triad.scale_sigma <= kMost && triad.misalignment_sigma_rad <= kMost;
  };
  return is_one(model.accelerometer) && is_one(model.gyro);
}

TrueImu mismatched(Mismatch what, double factor) {
  TrueImu imu{fmt::format("{} x {:g}", name(what), factor), what, factor, believed_imu()};
  multiply(imu.model.accelerometer, what, factor);
  multiply(imu.model.gyro, what, factor);
  return imu;
}

TrueImu part_as_imu(const ImuPart& part) {
  TrueImu imu{std::string(part.name), Mismatch::kPart, 1.0, imu_model(part)};
  const ImuErrorModel believed = believed_imu();
  imu.factor =
      std::max(imu.model.accelerometer.noise_density / believed.accelerometer.noise_density,
               imu.model.gyro.noise_density / believed.gyro.noise_density);
  return imu;
}

}  // namespace

ImuErrorModel believed_imu() {
  constexpr double kUnstated = 1e-3;
  ImuErrorModel model = EkfConfig{}.imu;
  for (TriadErrorModel* triad : {&model.accelerometer, &model.gyro}) {
    if (triad->scale_sigma == 0.0) triad->scale_sigma = kUnstated;
    if (triad->misalignment_sigma_rad == 0.0) triad->misalignment_sigma_rad = kUnstated;
  }
  return model;
}

std::vector<TrueImu> true_imus(bool brief) {
  constexpr std::array kFactors{0.1, 0.3, 3.0, 10.0, 30.0};
  std::vector<TrueImu> imus{
      {std::string(name(Mismatch::kNone)), Mismatch::kNone, 1.0, believed_imu()}};
  for (const Mismatch what : {Mismatch::kNoise, Mismatch::kDrift, Mismatch::kScale,
                              Mismatch::kMisalignment, Mismatch::kAll}) {
    for (const double factor : kFactors) {
      if (brief && factor != 10.0) continue;
      TrueImu imu = mismatched(what, factor);
      if (is_an_imu(imu.model)) imus.push_back(std::move(imu));
    }
  }
  for (const ImuPart& part : imu_parts()) {
    if (brief && part.name != "LSM6DSO" && part.name != "MPU-9250") continue;
    imus.push_back(part_as_imu(part));
  }
  return imus;
}

}  // namespace leeway::sim
