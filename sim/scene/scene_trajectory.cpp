#include <spdlog/fmt/fmt.h>

#include <numbers>

#include "leeway/sim/motion/recorded_trajectory.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/motion/waypoints.hpp"
#include "sim/scene/scene_sections.hpp"
#include "sim/scene/scene_units.hpp"

namespace leeway::sim {
namespace {

constexpr double kDefaultDurationS = 3600.0;
constexpr double kFullTurnRad = 2.0 * std::numbers::pi;
constexpr double kMostLateralMps2 = 100.0;
constexpr std::size_t kMostPoints = 2000;

constexpr Quantity kLatitude{
    "latitude", {&units::kDeg}, between(-90.0 * kRadPerDeg, 90.0 * kRadPerDeg)};
constexpr Quantity kLongitude{"longitude", {&units::kDeg}, between(-kFullTurnRad, kFullTurnRad)};
constexpr Quantity kHeight{"height", kLengths, between(-1e3, 5e4)};
constexpr Quantity kNorth{"north", kLengths, between(-1e6, 1e6)};
constexpr Quantity kEast{"east", kLengths, between(-1e6, 1e6)};
constexpr Quantity kDown{"down", kLengths, between(-5e4, 5e4)};
constexpr Quantity kRoll{"roll", {&units::kDeg}, between(-kFullTurnRad, kFullTurnRad)};
constexpr Quantity kPitch{
    "pitch", {&units::kDeg}, between(-0.25 * kFullTurnRad, 0.25 * kFullTurnRad)};
constexpr Quantity kHeading{"heading", {&units::kDeg}, between(-kFullTurnRad, kFullTurnRad)};
constexpr Quantity kSpeed{"speed", kSpeeds, zero_or(0.01, 400.0)};
constexpr Quantity kClimb{"climb", kSpeeds, between(-100.0, 100.0)};
constexpr Quantity kRadius{"radius", kLengths, between(0.5, 1e5)};
constexpr Quantity kStraight{"straight", kTimes, zero_or(0.1, 1e5)};
constexpr Quantity kTurn{"turn", kTimes, between(0.5, 3600.0)};
constexpr Quantity kInitialRest{"initial_rest", kTimes, zero_or(0.1, 1e5)};
constexpr Quantity kStop{"stop", kTimes, zero_or(0.1, 1e5)};
constexpr Quantity kAcceleration{"acceleration", kAccelerations, between(1e-3, 50.0)};
constexpr Quantity kLateral{"lateral_acceleration", kAccelerations, between(1e-3, 50.0)};
constexpr Quantity kSmoothing{"smoothing", kTimes, between(0.01, 100.0)};
constexpr Quantity kMaxGap{"max_gap", kTimes, between(0.01, 1e4)};
constexpr Quantity kMinSpeed{"min_speed", kSpeeds, between(0.01, 100.0)};
constexpr Quantity kTurnRadius{"turn_radius", kLengths, between(0.3, 1e5)};

void set_origin(TomlSection& section, Geodetic& origin) {
  set(section, kLatitude, origin.lat_rad);
  set(section, kLongitude, origin.lon_rad);
  set(section, kHeight, origin.height_m);
}

void require_lateral(const TomlSection& section, double lateral_mps2) {
  if (lateral_mps2 <= kMostLateralMps2) return;
  section.fail(fmt::format(
      "the turns push sideways with {:.3g} m/s^2, at most 100 is plausible: is the speed "
      "in km/h?",
      lateral_mps2));
}

void read(TomlSection& section, StaticParameters& p) {
  set(section, kRoll, p.attitude.roll_rad);
  set(section, kPitch, p.attitude.pitch_rad);
  set(section, kHeading, p.attitude.yaw_rad);
}

void read(TomlSection& section, StraightParameters& p) {
  set(section, kSpeed, p.ground_speed_mps);
  set(section, kClimb, p.climb_rate_mps);
  set(section, kHeading, p.heading_rad);
}

void read(TomlSection& section, CircleParameters& p) {
  set(section, kSpeed, p.speed_mps);
  set(section, kRadius, p.radius_m);
  require_lateral(section, p.speed_mps * p.speed_mps / p.radius_m);
}

void read(TomlSection& section, SquareLoopParameters& p) {
  set(section, kSpeed, p.speed_mps);
  set(section, kStraight, p.straight_s);
  set(section, kTurn, p.turn_s);
  require_lateral(section, p.speed_mps * 0.25 * kFullTurnRad / p.turn_s);
}

void read(TomlSection& section, CarDriveParameters& p) {
  set(section, kInitialRest, p.initial_rest_s);
}

/// A motion without an end of its own.
template <class Parameters, Trajectory (*make)(const Parameters&)>
Trajectory endless(TomlSection& section, double duration_s) {
  Parameters p;
  p.duration_s = duration_s;
  set_origin(section, p.origin);
  read(section, p);
  return make(p);
}

/// North and east in the origin's plane, taken down to the ellipsoid; down from the origin's
/// height.
Geodetic from_local(const Geodetic& origin, double north_m, double east_m, double down_m) {
  const TangentPlane plane(origin);
  Geodetic at =
      geodetic_from_ecef(plane.origin_e_m + plane.C_el * Eigen::Vector3d(north_m, east_m, 0.0));
  at.height_m = origin.height_m - down_m;
  return at;
}

/// What a waypoint does not say of speed and height is as at the one before.
Waypoint read_waypoint(TomlSection& section, const Geodetic& origin, const Waypoint* before) {
  Waypoint waypoint;
  const auto latitude_rad = section.number(kLatitude);
  const auto longitude_rad = section.number(kLongitude);
  const auto height_m = section.number(kHeight);
  const auto north_m = section.number(kNorth);
  const auto east_m = section.number(kEast);
  const auto down_m = section.number(kDown);
  const bool is_geodetic = latitude_rad && longitude_rad;
  const bool is_local = north_m && east_m;
  const bool is_mixed =
      is_local ? latitude_rad || longitude_rad || height_m : north_m || east_m || down_m;
  if (is_mixed || is_geodetic == is_local) {
    section.fail(
        "a waypoint is either latitude_deg, longitude_deg and height_m, or north_m, east_m "
        "and down_m from the trajectory's latitude_deg, longitude_deg and height_m");
  }
  const double last_height_m = before != nullptr ? before->position.height_m : origin.height_m;
  if (is_geodetic) {
    waypoint.position = {*latitude_rad, *longitude_rad, height_m.value_or(last_height_m)};
  } else {
    const double last_down_m = origin.height_m - last_height_m;
    waypoint.position = from_local(origin, *north_m, *east_m, down_m.value_or(last_down_m));
  }
  const auto speed_mps = section.number(kSpeed);
  waypoint.speed_mps =
      before != nullptr ? speed_mps.value_or(before->speed_mps) : section.required(speed_mps);
  waypoint.stop_s = section.number(kStop);
  return waypoint;
}

Trajectory read_waypoints(TomlSection& section, std::optional<double> duration_s) {
  WaypointParameters p;
  Geodetic origin = kDefaultOrigin;
  set_origin(section, origin);
  p.loop = section.boolean("loop").value_or(p.loop);
  p.banks = section.boolean("banks").value_or(p.banks);
  set(section, kAcceleration, p.acceleration_mps2);
  set(section, kLateral, p.lateral_acceleration_mps2);
  p.turn_radius_m = section.number(kTurnRadius);
  section.tables("waypoint", [&](TomlSection& waypoint) {
    if (p.waypoints.size() == kMostPoints) waypoint.fail("more than 2000 waypoints");
    const Waypoint* before = p.waypoints.empty() ? nullptr : &p.waypoints.back();
    p.waypoints.push_back(read_waypoint(waypoint, origin, before));
  });
  p.duration_s = duration_s;
  if (p.loop && !duration_s) p.duration_s = kDefaultDurationS;
  try {
    return waypoint_trajectory(p);
  } catch (const Error& error) {
    section.fail(error.what());
  }
}

/// The recording, or its beginning.
Trajectory read_recorded(TomlSection& section, const std::filesystem::path& folder,
                         std::optional<double> duration_s) {
  RecordedParameters p;
  p.file = folder / section.required(section.text("file"));
  set(section, kSmoothing, p.smoothing_s);
  set(section, kMaxGap, p.max_gap_s);
  set(section, kMinSpeed, p.min_speed_mps);
  Trajectory trajectory = usable(section, "file", [&p] { return recorded_trajectory(p); });
  if (duration_s.value_or(0.0) > trajectory.duration_s) {
    section.fail_at("file", fmt::format("ends after {:.9g} s, before the scene's end at {:.9g} s",
                                        trajectory.duration_s, *duration_s));
  }
  trajectory.duration_s = duration_s.value_or(trajectory.duration_s);
  return trajectory;
}

// In the order of TrajectoryKind.
constexpr std::array kEndless{
    &endless<StaticParameters, static_trajectory>, &endless<StraightParameters, straight>,
    &endless<CircleParameters, circle>, &endless<SquareLoopParameters, square_loop>,
    &endless<CarDriveParameters, car_drive>};

}  // namespace

Trajectory read_trajectory(TomlSection& section, const std::filesystem::path& folder,
                           std::optional<double> duration_s) {
  const auto kind = section.required(section.choice<TrajectoryKind>("type"));
  if (kind == TrajectoryKind::kWaypoints) return read_waypoints(section, duration_s);
  if (kind == TrajectoryKind::kRecorded) return read_recorded(section, folder, duration_s);
  return kEndless.at(static_cast<std::size_t>(kind))(section,
                                                     duration_s.value_or(kDefaultDurationS));
}

}  // namespace leeway::sim
