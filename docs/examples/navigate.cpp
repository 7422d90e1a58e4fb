// Navigates from a stream of samples: what a vehicle's software does with its drivers' data.
// usage: navigate < STREAM, lines in the order they arrive:
//   imu t_s gx gy gz ax ay az                                    rad/s, m/s^2, sensor axes
//   fix t_s lat_deg lon_deg height_m vn ve vd sigma_m sigma_mps  late ones are welcome
// t_s is of one clock for both, whatever it counts from: Unix time, GPS time, the start.
// prints position, sigma and leeway once a second of IMU time.
#include <cmath>
#include <cstdio>
#include <iostream>
#include <leeway/navigator/navigator.hpp>
#include <sstream>
#include <string>

namespace {

constexpr double kEndOfTimeS = 9e9;  // of 64 bits of nanoseconds

leeway::NavigatorConfig car_of_unknown_mount() {
  leeway::NavigatorConfig config;
  config.vehicle = leeway::VehicleConfig::car();
  config.C_bs.reset();
  return config;
}

leeway::Verdict push_sample(leeway::Navigator& navigator, double t_s, std::istream& in) {
  leeway::ImuSample sample;
  sample.time = leeway::time_from_seconds(t_s);
  for (double& x : sample.omega_ib_b_radps) in >> x;
  for (double& x : sample.f_ib_b_mps2) in >> x;
  return in ? navigator.push(sample) : leeway::Verdict::kNotFinite;
}

leeway::Verdict push_fix(leeway::Navigator& navigator, double t_s, std::istream& in) {
  double lat_deg, lon_deg, height_m, sigma_m, sigma_mps;
  Eigen::Vector3d v_n_mps;
  in >> lat_deg >> lon_deg >> height_m >> v_n_mps.x() >> v_n_mps.y() >> v_n_mps.z();
  if (!(in >> sigma_m >> sigma_mps)) return leeway::Verdict::kNotFinite;
  const leeway::Geodetic place{lat_deg * leeway::kRadPerDeg, lon_deg * leeway::kRadPerDeg,
                               height_m};
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  leeway::GnssFix fix;
  fix.time = leeway::time_from_seconds(t_s);
  fix.position = leeway::GnssPosition::from_geodetic(place, sigma_m * sigma_m * one);
  fix.velocity = leeway::GnssVelocity::from_ned(place, v_n_mps, sigma_mps * sigma_mps * one);
  return navigator.push(fix);
}

void print(const leeway::Navigator& navigator) {
  const leeway::Health health = navigator.health();
  if (!navigator.aligned()) return void(std::cout << name(health.state) << '\n');
  const leeway::Solution now = navigator.solution();
  const auto place = leeway::ned_from_nav_state(now.nav).position;
  std::printf("%.2f s  %.7f %.7f deg  sigma %.2f m  leeway to 5 m: %.0f s  %s\n",
              leeway::to_seconds(now.nav.time), place.lat_rad / leeway::kRadPerDeg,
              place.lon_rad / leeway::kRadPerDeg, now.sigma_position_n_m.head<2>().norm(),
              navigator.leeway(5.0).time_s, name(health.state).data());
}

}  // namespace

int main() {
  leeway::Navigator navigator{car_of_unknown_mount()};
  double next_print_s = -INFINITY;
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream in(line);
    std::string kind;
    double t_s = 0.0;
    if (!(in >> kind >> t_s)) continue;
    if (!(std::abs(t_s) < kEndOfTimeS)) {
      std::cerr << "time beyond +-9e9 s: " << line << '\n';
      continue;
    }
    const bool is_imu = kind == "imu";
    const auto verdict = is_imu ? push_sample(navigator, t_s, in) : push_fix(navigator, t_s, in);
    if (verdict > leeway::Verdict::kFused) std::cerr << name(verdict) << ": " << line << '\n';
    if (!is_imu || t_s < next_print_s) continue;
    next_print_s = t_s + 1.0;
    print(navigator);
  }
}
