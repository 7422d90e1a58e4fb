/// @file
/// The IMUs that the default navigator is tried with: what it takes them for, each error larger or
/// smaller by a factor, and the parts of the catalogue.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "leeway/earth/names.hpp"
#include "leeway/sensors/imu_error_model.hpp"

namespace leeway::sim {

/// What of an IMU is not as the filter believes. kAll: the four before it.
enum class Mismatch { kNone, kNoise, kDrift, kScale, kMisalignment, kAll, kPart };
constexpr auto names(Mismatch) {
  return std::array{"as believed", "noise", "drift", "scale", "misalignment", "all", "part"};
}

struct TrueImu {
  std::string name{};
  Mismatch mismatch{};
  /// Of the true deviations over the believed ones; of a part, its noise densities', of the triad
  /// that is noisier by this measure.
  double factor{1.0};
  ImuErrorModel model{};
};

/// What the factors are of: the default model of EkfConfig. Where it states no spread of scale
/// factors and misalignments, 1000 ppm and 1 mrad: 30 times that is the worst part there is.
ImuErrorModel believed_imu();

/// @param brief  factors of 10, and two parts
std::vector<TrueImu> true_imus(bool brief);

}  // namespace leeway::sim
