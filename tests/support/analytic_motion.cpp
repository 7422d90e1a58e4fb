#include "tests/support/analytic_motion.hpp"

#include <GeographicLib/NormalGravity.hpp>
#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"

namespace leeway::test {
namespace {

Eigen::Vector3d exact_gravity_e(const Eigen::Vector3d& r_e_m) {
  Eigen::Vector3d g_e;
  GeographicLib::NormalGravity::WGS84().U(r_e_m.x(), r_e_m.y(), r_e_m.z(), g_e.x(), g_e.y(),
                                          g_e.z());
  return g_e;
}

}  // namespace

double Channel::value(double t) const {
  double sum = offset + slope * t;
  for (const Sine& s : sines) sum += s.amplitude * std::sin(s.omega_radps * t + s.phase_rad);
  return sum;
}

double Channel::rate(double t) const {
  double sum = slope;
  for (const Sine& s : sines) {
    sum += s.amplitude * s.omega_radps * std::cos(s.omega_radps * t + s.phase_rad);
  }
  return sum;
}

double Channel::acceleration(double t) const {
  double sum = 0.0;
  for (const Sine& s : sines) {
    sum -= s.amplitude * s.omega_radps * s.omega_radps * std::sin(s.omega_radps * t + s.phase_rad);
  }
  return sum;
}

NavState AnalyticMotion::state(double t) const {
  const Eigen::Matrix3d C_en = ned_to_ecef(origin);
  const EulerAngles attitude{roll.value(t), pitch.value(t), yaw.value(t)};
  NavState state;
  state.time = time_from_seconds(t);
  state.q_eb = Eigen::Quaterniond(C_en * rotation_from_euler(attitude)).normalized();
  state.v_e_mps = C_en * Eigen::Vector3d(ned_m[0].rate(t), ned_m[1].rate(t), ned_m[2].rate(t));
  state.r_e_m = ecef_from_geodetic(origin) +
                C_en * Eigen::Vector3d(ned_m[0].value(t), ned_m[1].value(t), ned_m[2].value(t));
  return state;
}

ImuSample AnalyticMotion::sample(double t) const {
  const NavState s = state(t);
  const Eigen::Matrix3d C_be = s.q_eb.toRotationMatrix().transpose();
  const Eigen::Vector3d omega_ie_e =
      rotation == EarthRotation::kOn ? earth_rotation_e_radps() : Eigen::Vector3d::Zero();
  // Body rate from Euler angle rates: Groves (2.57).
  const double sin_roll = std::sin(roll.value(t));
  const double cos_roll = std::cos(roll.value(t));
  const double sin_pitch = std::sin(pitch.value(t));
  const double cos_pitch = std::cos(pitch.value(t));
  const Eigen::Vector3d omega_nb_b(roll.rate(t) - yaw.rate(t) * sin_pitch,
                                   pitch.rate(t) * cos_roll + yaw.rate(t) * sin_roll * cos_pitch,
                                   -pitch.rate(t) * sin_roll + yaw.rate(t) * cos_roll * cos_pitch);
  const Eigen::Vector3d a_e =
      ned_to_ecef(origin) *
      Eigen::Vector3d(ned_m[0].acceleration(t), ned_m[1].acceleration(t), ned_m[2].acceleration(t));
  return {s.time, omega_nb_b + C_be * omega_ie_e,
          C_be * (a_e + 2.0 * omega_ie_e.cross(s.v_e_mps) - exact_gravity_e(s.r_e_m))};
}

ImuIncrement AnalyticMotion::increment(Time from, Time to) const {
  // Abramowitz and Stegun, table 25.4, n = 8.
  constexpr std::array kNodes{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                              0.9602898564975363};
  constexpr std::array kWeights{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                0.1012285362903763};
  ImuIncrement inc;
  inc.time = to;
  inc.dt_s = to_seconds(to - from);
  const double half_s = 0.5 * inc.dt_s;
  const double mid_s = to_seconds(from) + half_s;
  for (std::size_t i = 0; i < kNodes.size(); ++i) {
    for (const double side : {-1.0, 1.0}) {
      const ImuSample s = sample(mid_s + side * half_s * kNodes[i]);
      inc.dtheta_b_rad += half_s * kWeights[i] * s.omega_ib_b_radps;
      inc.dv_b_mps += half_s * kWeights[i] * s.f_ib_b_mps2;
    }
  }
  return inc;
}

AnalyticMotion rough_drive() {
  AnalyticMotion m;
  m.origin = {45.0 * kRadPerDeg, 37.6 * kRadPerDeg, 100.0};
  m.ned_m[0] = {0.0, 0.0, {{{100.0, 0.2, 0.0}, {0.02, 8.0, 1.0}}}};
  m.ned_m[1] = {0.0, 0.0, {{{100.0, 0.2, -1.5707963267948966}, {0.03, 9.0, 0.2}}}};
  m.ned_m[2] = {0.0, 0.0, {{{0.02, 12.0, 0.5}, {}}}};
  m.roll = {0.0, 0.0, {{{0.05, 8.0, 0.0}, {}}}};
  m.pitch = {0.02, 0.0, {{{0.03, 11.0, 0.4}, {}}}};
  m.yaw = {0.3, 0.2, {{{0.02, 7.0, 0.1}, {}}}};
  return m;
}

double position_error_m(const AnalyticMotion& motion, const std::vector<Time>& times,
                        StrapdownFunction step, std::size_t every) {
  NavState state = motion.state(to_seconds(times.front()));
  ImuHistory history;
  double largest_m = 0.0;
  for (std::size_t k = 1; k < times.size(); ++k) {
    step(state, motion.increment(times[k - 1], times[k]), history);
    if (k % every != 0) continue;
    const NavState truth = motion.state(to_seconds(times[k]));
    largest_m = std::max(largest_m, (state.r_e_m - truth.r_e_m).norm());
  }
  return largest_m;
}

}  // namespace leeway::test
