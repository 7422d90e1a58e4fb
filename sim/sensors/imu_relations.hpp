/// @file
/// What goes together in an inertial sensor. A value given in the wrong unit is often possible on
/// its own, but not beside its neighbours: these are the ratios that no real sensor leaves.
#pragma once

#include <array>
#include <cstddef>

namespace leeway::sim {

/// The quantities that relations are between.
enum class Stated : std::size_t {
  kAccelerometerBiasSigma,
  kAccelerometerInRun,
  kAccelerometerNoise,
  kGyroBiasSigma,
  kGyroInRun,
  kGyroNoise
};
inline constexpr std::size_t kStated = 6;

/// The ratio of two quantities, in SI.
struct Relation {
  Stated over{};
  Stated under{};
  double low{};
  double high{};

  /// A quantity that is zero has no ratio.
  bool allows(double over_si, double under_si) const {
    if (over_si == 0.0 || under_si == 0.0) return true;
    return over_si >= low * under_si && over_si <= high * under_si;
  }
};

/// The bounds are those of the catalogue (imu_catalogue.hpp) and of [seed Table 1] with room: a
/// factor of 2 or more to the nearest of them.
/// In-run drift over noise is 1 / sqrt(averaging time of the Allan minimum), up to a factor.
inline constexpr std::array<Relation, 6> kRelations{{
    {Stated::kAccelerometerInRun, Stated::kAccelerometerNoise, 3e-3, 100.0},
    {Stated::kGyroInRun, Stated::kGyroNoise, 1e-3, 30.0},
    {Stated::kAccelerometerBiasSigma, Stated::kAccelerometerNoise, 0.02, 3000.0},
    {Stated::kGyroBiasSigma, Stated::kGyroNoise, 5e-4, 1500.0},
    {Stated::kGyroBiasSigma, Stated::kAccelerometerBiasSigma, 1e-6, 1.0},
    {Stated::kGyroNoise, Stated::kAccelerometerNoise, 1e-4, 1.0},
}};

}  // namespace leeway::sim
