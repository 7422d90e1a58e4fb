/// @file
/// The units of datasheets, files and options, and their factors to SI: the one place that has
/// them.
#pragma once

#include <string>
#include <string_view>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"

namespace leeway {

/// A unit, defined by one step from a unit it is made of: one deg/h is 1 / 3600 deg/s.
struct Unit {
  std::string_view symbol{};  ///< as printed: "deg/h"
  std::string_view key{};     ///< as it ends a key of a file: "deg_per_h"
  double times{1.0};          ///< one of it is times / over of `base`
  double over{1.0};
  std::string_view base{};       ///< symbol of that unit; its own in SI
  std::string_view si_symbol{};  ///< units that share it measure the same thing
  double si{1.0};                ///< one of it in SI
};

/// Conversion to SI in words: "4.5 deg/h = 4.5 / 3600 deg/s = 2.182e-05 rad/s".
std::string working(double value, const Unit& unit);

namespace units {

/// Unit of the SI.
constexpr Unit in_si(std::string_view symbol, std::string_view key) {
  return {symbol, key, 1.0, 1.0, symbol, symbol, 1.0};
}

/// Unit one step from its base: times the first factor, over the second.
constexpr Unit step(std::string_view symbol, std::string_view key, double times, double over,
                    const Unit& base) {
  return {symbol, key, times, over, base.symbol, base.si_symbol, times * base.si / over};
}

inline constexpr double kG = kStandardGravityMps2;

inline constexpr Unit kS = in_si("s", "s");
inline constexpr Unit kMs = step("ms", "ms", 1.0, 1000.0, kS);
inline constexpr Unit kMin = step("min", "min", 60.0, 1.0, kS);
inline constexpr Unit kH = step("h", "h", 3600.0, 1.0, kS);
inline constexpr Unit kHz = in_si("Hz", "hz");
inline constexpr Unit kM = in_si("m", "m");
inline constexpr Unit kCm = step("cm", "cm", 1.0, 100.0, kM);
inline constexpr Unit kKm = step("km", "km", 1000.0, 1.0, kM);
inline constexpr Unit kMps = in_si("m/s", "mps");
inline constexpr Unit kKmPerH = step("km/h", "km_per_h", 1.0, 3.6, kMps);

inline constexpr Unit kRad = in_si("rad", "rad");
inline constexpr Unit kMrad = step("mrad", "mrad", 1.0, 1000.0, kRad);
inline constexpr Unit kDeg = step("deg", "deg", kRadPerDeg, 1.0, kRad);
inline constexpr Unit kArcsec = step("arcsec", "arcsec", 1.0, 3600.0, kDeg);

inline constexpr Unit kRatio = in_si("1", "ratio");
inline constexpr Unit kPercent = step("%", "percent", 1.0, 100.0, kRatio);
inline constexpr Unit kPpm = step("ppm", "ppm", 1.0, 1e6, kRatio);

// Accelerometers.
inline constexpr Unit kMps2 = in_si("m/s^2", "mps2");
inline constexpr Unit kStandardG = step("g", "g", kG, 1.0, kMps2);
inline constexpr Unit kMg = step("mg", "mg", 1.0, 1e3, kStandardG);
inline constexpr Unit kUg = step("ug", "ug", 1.0, 1e6, kStandardG);
inline constexpr Unit kMps2PerSqrtHz = in_si("m/s^2/sqrt(Hz)", "mps2_per_sqrt_hz");
inline constexpr Unit kGPerSqrtHz = step("g/sqrt(Hz)", "g_per_sqrt_hz", kG, 1.0, kMps2PerSqrtHz);
inline constexpr Unit kMgPerSqrtHz = step("mg/sqrt(Hz)", "mg_per_sqrt_hz", 1.0, 1e3, kGPerSqrtHz);
inline constexpr Unit kUgPerSqrtHz = step("ug/sqrt(Hz)", "ug_per_sqrt_hz", 1.0, 1e6, kGPerSqrtHz);
inline constexpr Unit kMpsPerSqrtH =
    step("m/s/sqrt(h)", "mps_per_sqrt_h", 1.0, 60.0, kMps2PerSqrtHz);

inline constexpr Unit kFtpsPerSqrtH =
    step("ft/s/sqrt(h)", "ftps_per_sqrt_h", 0.3048, 1.0, kMpsPerSqrtH);

// Gyros.
inline constexpr Unit kRadps = in_si("rad/s", "radps");
inline constexpr Unit kDegPerS = step("deg/s", "deg_per_s", kRadPerDeg, 1.0, kRadps);
inline constexpr Unit kDegPerH = step("deg/h", "deg_per_h", 1.0, 3600.0, kDegPerS);
inline constexpr Unit kRadpsPerSqrtHz = in_si("rad/s/sqrt(Hz)", "radps_per_sqrt_hz");
inline constexpr Unit kDpsPerSqrtHz =
    step("dps/sqrt(Hz)", "dps_per_sqrt_hz", kRadPerDeg, 1.0, kRadpsPerSqrtHz);
inline constexpr Unit kDegPerSqrtH =
    step("deg/sqrt(h)", "deg_per_sqrt_h", 1.0, 60.0, kDpsPerSqrtHz);
inline constexpr Unit kMdpsPerSqrtHz =
    step("mdps/sqrt(Hz)", "mdps_per_sqrt_hz", 1.0, 1e3, kDpsPerSqrtHz);
inline constexpr Unit kRadpsPerMps2 = in_si("rad/s/(m/s^2)", "radps_per_mps2");
inline constexpr Unit kRadpsPerG = step("rad/s/g", "radps_per_g", 1.0, kG, kRadpsPerMps2);
inline constexpr Unit kDegPerSPerG =
    step("deg/s/g", "deg_per_s_per_g", kRadPerDeg, 1.0, kRadpsPerG);
inline constexpr Unit kDegPerHPerG = step("deg/h/g", "deg_per_h_per_g", 1.0, 3600.0, kDegPerSPerG);

}  // namespace units
}  // namespace leeway
