/// @file
/// A simulated car with all that a vehicle's software hears from it.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/navigator/navigator.hpp"
#include "leeway/sim/motion/waypoints.hpp"
#include "tests/filters/navigator/recording.hpp"

namespace leeway::test {

/// Round a block of 700 m by 400 m at up to 16 m/s, with stops of 15 and 8 s; at rest at first. The
/// IMU sits where the car does not slip: rear_axle_x_m is 0.
inline const sim::Trajectory& stop_and_go() {
  static const sim::Trajectory trajectory = [] {
    const auto at = [](double north_m, double east_m, double height_m, double speed_mps,
                       std::optional<double> stop_s = {}) {
      const Geodetic o = sim::kDefaultOrigin;
      return sim::Waypoint{{o.lat_rad + north_m / 6.37e6,
                            o.lon_rad + east_m / (6.37e6 * std::cos(o.lat_rad)), height_m},
                           speed_mps,
                           stop_s};
    };
    sim::WaypointParameters route;
    route.waypoints = {at(0, 0, 100, 10, 15.0),   at(250, 20, 104, 16), at(700, 0, 108, 12),
                       at(700, 400, 103, 8, 8.0), at(350, 380, 97, 14), at(0, 400, 100, 11)};
    route.loop = true;
    route.duration_s = 420.0;
    return sim::waypoint_trajectory(route);
  }();
  return trajectory;
}

struct CarOptions {
  Eigen::Matrix3d C_sv{Eigen::Matrix3d::Identity()};  ///< vehicle axes to sensor axes
  double odometer_scale{0.0};
  double height_offset_m{0.0};
  sim::GnssErrorModel gnss{{1.0, 1.0, 1.5}, {0.05, 0.05, 0.05}};
};

struct CarLog {
  std::vector<ImuIncrement> imu;
  std::vector<GnssFix> fixes;            ///< 2 Hz
  std::vector<OdometerSpeed> odometer;   ///< 10 Hz, 0.05 m/s of noise
  std::vector<BarometricHeight> height;  ///< 1 Hz, 0.3 m of noise
};

/// 50 Hz.
inline CarLog drive(const CarOptions& options, std::uint64_t seed) {
  static const std::vector<ImuIncrement> truth =
      sim::true_increments(stop_and_go(), 50.0, stop_and_go().duration_s);
  std::vector<ImuIncrement> mounted = truth;
  for (ImuIncrement& inc : mounted) {
    inc.dtheta_b_rad = (options.C_sv * inc.dtheta_b_rad).eval();
    inc.dv_b_mps = (options.C_sv * inc.dv_b_mps).eval();
  }
  const Recording log =
      record(stop_and_go(), mounted, automotive_mems_model(), options.gnss, 0.5, 0.5, seed);
  CarLog car{log.imu, log.fixes, {}, {}};
  sim::Random random(seed, 0, sim::kFirstFreeStream);
  const int tenths = static_cast<int>(10.0 * stop_and_go().duration_s);
  for (int k = 1; k <= tenths; ++k) {
    const double t_s = 0.1 * k;
    const NavState nav = sim::truth_at(stop_and_go(), t_s).nav;
    const double speed_mps = (nav.q_eb.conjugate() * nav.v_e_mps).x();
    car.odometer.push_back({time_from_seconds(t_s),
                            (1.0 + options.odometer_scale) * speed_mps + 0.05 * random.normal(),
                            0.05});
    if (k % 10 != 0) continue;
    const double height_m = geodetic_from_ecef(nav.r_e_m).height_m;
    car.height.push_back(
        {time_from_seconds(t_s), height_m + options.height_offset_m + 0.3 * random.normal(), 0.3});
  }
  return car;
}

/// What of the log reaches the navigator.
struct Heard {
  double gnss_until_s{1e9};
  bool odometer{false};
  bool height{false};
};

/// Pushes the log up to a time, every message before the IMU data of its time.
template <class F>
void run(Navigator& navigator, const CarLog& log, double until_s, const Heard& heard,
         F&& after_imu) {
  std::size_t fix = 0;
  std::size_t speed = 0;
  std::size_t height = 0;
  const auto push_until = [&](const auto& messages, std::size_t& next, Time t, bool is_heard,
                              double end_s) {
    for (; next < messages.size() && messages[next].time <= t; ++next) {
      if (is_heard && to_seconds(messages[next].time) <= end_s) navigator.push(messages[next]);
    }
  };
  for (const ImuIncrement& inc : log.imu) {
    if (inc.time > time_from_seconds(until_s)) break;
    push_until(log.fixes, fix, inc.time, true, heard.gnss_until_s);
    push_until(log.odometer, speed, inc.time, heard.odometer, 1e9);
    push_until(log.height, height, inc.time, heard.height, 1e9);
    navigator.push(inc);
    after_imu(inc);
  }
}

inline void run(Navigator& navigator, const CarLog& log, double until_s, const Heard& heard = {}) {
  run(navigator, log, until_s, heard, [](const ImuIncrement&) {});
}

/// From where the car stands, its heading known to 3 deg.
inline Navigator started_car(const NavigatorConfig& config,
                             const Eigen::Matrix3d& C_sv = Eigen::Matrix3d::Identity()) {
  Navigator navigator(config);
  Estimate start = truth_estimate(stop_and_go(), 0.0);
  start.nav.q_eb = (start.nav.q_eb * Eigen::Quaterniond(C_sv.transpose())).normalized();
  navigator.start(start, initial_covariance(start, {0.02, 0.05, 0.1, 2.0}, config.filter.imu));
  return navigator;
}

inline double horizontal_error_m(const Navigator& navigator) {
  const NavState& nav = navigator.filter().estimate().nav;
  const NavState truth = sim::truth_at(stop_and_go(), to_seconds(nav.time)).nav;
  const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(truth.r_e_m));
  return (C_en.transpose() * (nav.r_e_m - truth.r_e_m)).head<2>().norm();
}

}  // namespace leeway::test
