/// @file
/// The vehicles that faults are tried on: how each moves, what it carries, what its navigator is
/// told.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "leeway/navigator/navigator_config.hpp"
#include "leeway/sensors/imu_error_model.hpp"
#include "leeway/sim/motion/trajectory.hpp"
#include "leeway/sim/sensors/gnss_simulator.hpp"

namespace leeway::sim {

struct Regime {
  std::string name{};
  Trajectory trajectory{};  ///< longer than any cell runs, starts included
  ImuErrorModel imu{automotive_mems_model()};
  double imu_rate_hz{50.0};
  GnssErrorModel gnss{};
  double fix_interval_s{1.0};
  NavigatorConfig config{};
  double settled_s{60.0};  ///< from the start, when the navigator has found itself
  double turns_at_s{};     ///< somewhere in a turn
};

/// Code positions: half of the error lasts for half a minute, as the navigator is told.
GnssErrorModel code_receiver();
GnssErrorModel rtk_receiver();  ///< 2 cm and 3 cm/s, white

/// All regimes, in the order of the matrix. car() is the second.
const std::vector<Regime>& regimes();

inline constexpr std::size_t kCarRegime = 1;  ///< of VehicleConfig::car()

/// The same way, gone through as `clock` tells: the time on the way as a function of time. What
/// goes backwards in time backs.
Trajectory rescheduled(const Trajectory& trajectory, std::function<Jet(double t_s)> clock);

/// The same way from start_s on it: at `pace` of its speed first, and from from_s on, within 10 s,
/// at its own. Pace 0 stands, -1 backs.
Trajectory paced_at_first(const Trajectory& trajectory, double start_s, double pace,
                          double from_s);

}  // namespace leeway::sim
