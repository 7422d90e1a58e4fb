#include "sim/atlas/faults/fault.hpp"

namespace leeway::sim {
namespace {

constexpr double kMovingS = 25.0;  // on the way: all have left

Fault begin_with(std::string name) {
  return {.name = std::move(name), .group = FaultGroup::kStart, .from_start = true};
}

/// Not at the begin of the way, but here on it.
Trajectory from_here(const Trajectory& way, double start_s) {
  return rescheduled(way, [=](double t_s) { return time_jet(t_s) + start_s; });
}

Fault wrong_heading(std::string name, double error_deg) {
  Fault fault = begin_with(std::move(name));
  fault.heading_error_rad = error_deg * kRadPerDeg;
  // At rest nobody could tell.
  fault.motion = [](const Regime& r) { return from_here(r.trajectory, kMovingS); };
  return fault;
}

Fault moving(std::string name, std::function<Trajectory(const Regime&)> motion) {
  Fault fault = begin_with(std::move(name));
  fault.motion = std::move(motion);
  return fault;
}

Trajectory sideways(const Regime& regime) {
  Trajectory result = regime.trajectory;
  result.motion = [way = regime.trajectory.motion](double t_s) {
    LocalMotion m = way(t_s);
    m.yaw_rad = m.yaw_rad + 80.0 * kRadPerDeg;
    return m;
  };
  return result;
}

Fault blind_start(std::string name, Damage damage) {
  Fault fault = begin_with(std::move(name));
  fault.damage = std::move(damage);
  return fault;
}

}  // namespace

std::vector<Fault> start_faults() {
  Fault drifts = moving("starts drifting sideways", sideways);
  drifts.cannot_befall = {VehicleKind::kNone, VehicleKind::kCar, VehicleKind::kAircraft};
  Fault backs = moving("starts backing", [](const Regime& r) {
    return paced_at_first(r.trajectory, 60.0, -1.0, 20.0);
  });
  backs.cannot_befall = {VehicleKind::kAircraft};
  return {
      wrong_heading("told a heading wrong by 90 deg", 90.0),
      wrong_heading("told a heading wrong by 180 deg", 180.0),
      moving("starts moving",
             [](const Regime& r) { return from_here(r.trajectory, kMovingS); }),
      moving("starts turning",
             [](const Regime& r) { return from_here(r.trajectory, r.turns_at_s); }),
      backs,
      moving("starts standing or hovering",
             [](const Regime& r) { return paced_at_first(r.trajectory, kMovingS, 0.0, 25.0); }),
      drifts,
      blind_start("no fix at first",
                  [](FaultInputs& inputs, const FaultWindow& window) {
                    drop_in(inputs.fixes, window, [](double) { return true; });
                  }),
      blind_start("no IMU at first",
                  [](FaultInputs& inputs, const FaultWindow& window) {
                    drop_in(inputs.imu, window, [](double) { return true; });
                  }),
  };
}

}  // namespace leeway::sim
