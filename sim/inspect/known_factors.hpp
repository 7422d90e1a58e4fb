/// @file
/// Factors by which a value in another unit is off.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>

#include "leeway/earth/earth.hpp"

namespace leeway::sim {

/// A factor and what it means.
struct KnownFactor {
  double factor;
  std::string_view unit;
};

inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;

/// Of a speed that should be in m/s.
inline constexpr std::array kSpeedFactors{
    KnownFactor{3.6, "km/h"},
    KnownFactor{1.0 / 3.6, "a speed in m/s that was taken for km/h"},
    KnownFactor{2.236936, "mph"},
    KnownFactor{0.44704, "a speed in m/s that was taken for mph"},
    KnownFactor{1.943844, "knots"},
    KnownFactor{0.514444, "a speed in m/s that was taken for knots"},
    KnownFactor{3.280840, "ft/s"},
    KnownFactor{0.3048, "a speed in m/s that was taken for ft/s"},
    KnownFactor{100.0, "cm/s"},
    KnownFactor{0.01, "a speed in m/s that was taken for cm/s"},
    KnownFactor{1000.0, "mm/s"}};

/// Of a specific force that should be in m/s^2: what gravity then reads, over 9.80665.
inline constexpr std::array kForceFactors{KnownFactor{1.0 / kStandardGravityMps2, "g"},
                                          KnownFactor{1000.0 / kStandardGravityMps2, "mg"}};

/// Of an angular rate that should be in rad/s.
inline constexpr std::array kRateFactors{KnownFactor{kDegPerRad, "deg/s"},
                                         KnownFactor{1000.0 * kDegPerRad, "mdps"}};

/// The one that a factor is within the tolerance of, relative; of several, the nearest.
std::optional<KnownFactor> known_factor(std::span<const KnownFactor> factors, double factor,
                                        double tolerance);

}  // namespace leeway::sim
