/// @file
/// Kinds of vehicle, and what each can do.
#pragma once

#include <cstdint>

#include "leeway/earth/names.hpp"

namespace leeway {

enum class VehicleKind : std::uint8_t {
  kNone,  ///< not told: taken for one that goes where it points
  kCar,
  kWalker,
  kMultirotor,
  kBoat,
  kAircraft,
};
constexpr auto names(VehicleKind) {
  return std::array{"none", "car", "walker", "multirotor", "boat", "aircraft"};
}

/// What no vehicle of a kind exceeds, and whether its course tells its heading.
struct VehicleLimits {
  /// Whether the course over ground is the heading, but for a few degrees. A boat drifts, a
  /// multirotor flies sideways, a walker carries the sensor in any direction.
  bool goes_where_it_points{true};
  double speed_mps{400.0};         ///< over ground
  double acceleration_mps2{20.0};  ///< in any direction, for a second and more
  double drift_rad{0.0};  ///< 1 sigma of course against heading by wind: a fifth of the airspeed
};

/// Limits of a kind: tyres hold 1 g, a multirotor's thrust is 3 g, an aerobatic wing bears 9 g.
constexpr VehicleLimits limits_of(VehicleKind kind) {
  switch (kind) {
    case VehicleKind::kCar:
      return {true, 120.0, 10.0};
    case VehicleKind::kWalker:
      return {false, 15.0, 10.0};
    case VehicleKind::kMultirotor:
      return {false, 70.0, 30.0};
    case VehicleKind::kBoat:
      return {false, 60.0, 10.0};
    case VehicleKind::kAircraft:
      return {true, 1000.0, 90.0, 0.2};
    case VehicleKind::kNone:
      break;
  }
  return {};
}

}  // namespace leeway
