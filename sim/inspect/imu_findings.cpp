#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "leeway/earth/units.hpp"
#include "sim/inspect/findings.hpp"
#include "sim/inspect/known_factors.hpp"

namespace leeway::sim {
namespace {

/// Biases and scale errors of car-grade parts, and a vehicle's own accelerations, stay below.
constexpr double kGravityTolerance = 0.15;
constexpr double kGravityGone = 0.2;
/// Gravity keeps its direction in a vehicle. What is left without it does not.
constexpr double kSteady = 0.7;
constexpr double kAxisRad = 25.0 * kRadPerDeg;

Finding force_finding(Certainty certainty, double f_mps2, std::string_view meaning,
                      std::string remedy) {
  return {certainty, "imu", "accelerometer-unit",
          fmt::format("the specific force is {:.4g} m/s^2, the median over seconds, where gravity "
                      "is 9.81: {}",
                      f_mps2, meaning),
          std::move(remedy)};
}

/// By which gravity is in another unit.
std::optional<KnownFactor> force_unit(double ratio) {
  return known_factor(kForceFactors, ratio, kGravityTolerance);
}

std::vector<Finding> gravity_findings(const ImuFigures& imu) {
  const double f_mps2 = imu.specific_force_mps2;
  const double ratio = f_mps2 / kStandardGravityMps2;
  if (std::isnan(ratio) || std::abs(ratio - 1.0) < kGravityTolerance) return {};
  const auto finding = [f_mps2](Certainty certainty, std::string_view meaning, std::string remedy) {
    return std::vector{force_finding(certainty, f_mps2, meaning, std::move(remedy))};
  };
  const auto near = [ratio](double value) {
    return std::abs(ratio / value - 1.0) < kGravityTolerance;
  };
  if (!has_gravity(imu)) {
    return finding(Certainty::kCertain,
                   "gravity has been taken out, and without it nothing tells which way is down",
                   "record the total acceleration, with gravity");
  }
  if (const auto unit = force_unit(ratio)) {
    return finding(Certainty::kCertain, fmt::format("it is in {}", unit->unit),
                   fmt::format("--accel-unit {}", unit->unit));
  }
  if (near(imu.time.step_s)) {
    return finding(
        Certainty::kCertain,
        fmt::format("increments over {:.3g} s stand under a heading of rates", imu.time.step_s),
        "name the columns dt_s, dtheta_x_rad .., dv_x_mps ..");
  }
  if (near(1.0 / imu.time.step_s)) {
    return finding(Certainty::kCertain, "rates stand under a heading of increments",
                   "name the columns gx_radps .., ax_mps2 ..");
  }
  if (near(0.5)) {
    return finding(Certainty::kCertain, "half: the rate of the increments is wrong",
                   "check the times of the log, and --time-unit");
  }
  return finding(Certainty::kLikely, "a unit or a scale that is unknown", "--accel-unit");
}

/// Where the axes of the log point in the vehicle, as columns: forward, right, down.
Eigen::Matrix3d axes_in_vehicle(const ImuFigures& imu) {
  const Eigen::Vector3d down = -imu.up_b;
  const Eigen::Vector3d forward = (imu.forward_b - imu.forward_b.dot(down) * down).normalized();
  Eigen::Matrix3d C;
  C << forward.transpose(), down.cross(forward).transpose(), down.transpose();
  return C;
}

char letter_of(const Eigen::Vector3d& axis_in_vehicle) {
  constexpr std::string_view kPositive = "frd", kNegative = "blu";
  Eigen::Index largest = 0;
  axis_in_vehicle.cwiseAbs().maxCoeff(&largest);
  const auto k = static_cast<std::size_t>(largest);
  return axis_in_vehicle[largest] > 0.0 ? kPositive[k] : kNegative[k];
}

}  // namespace

bool has_gravity(const ImuFigures& imu) {
  return imu.specific_force_mps2 > kGravityGone * kStandardGravityMps2 || imu.steadiness > kSteady;
}

std::vector<Finding> axes_findings(const ImuFigures& imu) {
  if (!imu.up_b.allFinite()) return {};
  const auto finding = [](std::string text, std::string remedy) {
    return std::vector{
        Finding{Certainty::kLikely, "imu", "axes", std::move(text), std::move(remedy)}};
  };
  if (!imu.forward_b.allFinite()) {
    if (imu.up_b.z() < std::cos(kAxisRad)) return {};
    return finding("the z axis points up, and forward, right, down is wanted",
                   "--axes flu where x points forward, --axes rfu where it points right");
  }
  const Eigen::Matrix3d C = axes_in_vehicle(imu);
  std::string letters;
  double worst = 1.0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    letters += letter_of(C.col(k));
    worst = std::min(worst, C.col(k).cwiseAbs().maxCoeff());
  }
  if (worst < std::cos(kAxisRad)) {
    return finding("no axis of the IMU points forward, right or down: it is mounted askew",
                   "--mount ROLL,PITCH,YAW, or --vehicle car, which estimates it");
  }
  if (letters == "frd") return {};
  return finding(fmt::format("gravity and the vehicle's speed changes say that x, y, z point {}, "
                             "and forward, right, down is wanted",
                             letters),
                 "--axes " + letters);
}

std::vector<Finding> imu_findings(const ImuFigures& imu) {
  std::vector<Finding> found = gravity_findings(imu);
  constexpr std::array kChannels{"gyro x",          "gyro y",          "gyro z",
                                 "accelerometer x", "accelerometer y", "accelerometer z"};
  for (std::size_t k = 0; k < kChannels.size(); ++k) {
    if (!imu.is_stuck[k]) continue;
    found.push_back(
        {Certainty::kLikely, "imu", "stuck-channel",
         fmt::format("{} has one value in all {} records", kChannels[k], imu.time.records),
         "check the columns: --column"});
  }
  if (imu.saturated > 0) {
    found.push_back({Certainty::kLikely, "imu", "full-scale",
                     fmt::format("{} samples stand at one largest magnitude: the sensor's full "
                                 "scale is exceeded",
                                 imu.saturated),
                     "choose a larger range in the recorder"});
  }
  if (imu.time.gaps > 0) {
    found.push_back({Certainty::kNote, "imu", "gaps",
                     fmt::format("{} gaps of up to {:.3g} s in steps of {:.3g} s", imu.time.gaps,
                                 imu.time.longest_gap_s, imu.time.step_s),
                     ""});
  }
  return found;
}

}  // namespace leeway::sim
