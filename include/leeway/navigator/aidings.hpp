/// @file
/// The list of the sensors that can aid the filter beside a GNSS receiver. One more is a header
/// with its reading, as odometer.hpp, and its name in Reading: all else goes by these.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <variant>

#include "leeway/navigator/barometer.hpp"
#include "leeway/navigator/measured_heading.hpp"
#include "leeway/navigator/odometer.hpp"
#include "leeway/navigator/vehicle_aiding.hpp"
#include "leeway/sensors/gnss_fix.hpp"

namespace leeway {

/// A measurement. Those of one time act in the order of the alternatives.
using Reading = std::variant<GnssFix, OdometerSpeed, BarometricHeight, MeasuredHeading>;

/// What a program needs to offer a sensor's log under its name.
struct Aiding {
  const char* name;
  const char* log;           ///< what it is a log of
  const char* value_column;  ///< with its unit; that of the time is t_s
  const char* sigma_column;  ///< may be missing in a log
  double largest;            ///< of the value's magnitude and of the sigma, in the log's unit
  double default_sigma;      ///< where the log has none
  bool VehicleConfig::*is_on;
  Reading (*reading)(Time time, double value, double sigma);  ///< as they stand in the log
};

/// One row for each reading, which is an aggregate of a time, a value and its sigma.
template <class... R>
constexpr std::array<Aiding, sizeof...(R)> aidings_of(
    std::type_identity<std::variant<GnssFix, R...>> /*readings*/) {
  constexpr auto row = []<class T>(const T& defaults) {
    const auto& [time, value, sigma] = defaults;
    const auto reading = [](Time t, double v, double s) -> Reading {
      return T{t, T::kUnit * v, T::kUnit * s};
    };
    return Aiding{
        T::kName,         T::kLog,  T::kColumns[0], T::kColumns[1], T::kLargest / T::kUnit,
        sigma / T::kUnit, T::kIsOn, reading};
  };
  return {row(R{})...};
}

inline constexpr auto kAidings = aidings_of(std::type_identity<Reading>{});

template <class R>
concept AidingReading = std::is_same_v<decltype(R::kLargest), const double>;

template <AidingReading R>
bool all_finite(const R& reading) {
  const auto& [time, value, sigma] = reading;
  return std::isfinite(value) && std::isfinite(sigma);
}

/// Whether the value is one that a vehicle can have, and the sigma at least kLeastSigma
/// (gnss_fix.hpp).
template <AidingReading R>
bool is_usable(const R& reading) {
  const auto& [time, value, sigma] = reading;
  return std::abs(value) <= R::kLargest && sigma >= kLeastSigma && sigma <= R::kLargest;
}

/// A part of the vehicle aiding that can be switched on and off.
struct VehiclePart {
  const char* name;
  bool VehicleConfig::*is_on;
};

/// The constraints, then the sensors.
inline constexpr auto kVehicleParts = [] {
  std::array<VehiclePart, 3 + kAidings.size()> parts{
      {{"zero-velocity", &VehicleConfig::zero_velocity},
       {"zero-angular-rate", &VehicleConfig::zero_angular_rate},
       {"non-holonomic", &VehicleConfig::non_holonomic}}};
  std::transform(kAidings.begin(), kAidings.end(), parts.begin() + 3, [](const Aiding& a) {
    return VehiclePart{a.name, a.is_on};
  });
  return parts;
}();

}  // namespace leeway
