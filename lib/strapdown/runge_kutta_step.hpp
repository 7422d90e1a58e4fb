/// @file
/// The fourth-order Runge-Kutta step over rates fitted to four increments. Private to the
/// strapdown.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "lib/strapdown/earth_terms.hpp"

namespace leeway::schemes {

/// Body rates at the start, middle and end of an increment.
struct BodyRates {
  std::array<Eigen::Vector3d, 3> omega_b;
  std::array<Eigen::Vector3d, 3> f_b;
};

/// Rates within recent[which] as the derivative of the polynomial through the running integrals at
/// the ends of all recent increments; their integral over each increment is kept.
inline BodyRates fitted_rates(const ImuHistory& history, std::size_t which) {
  constexpr std::size_t kMaxKnots = ImuHistory::kLength + 1;
  const std::size_t knots = static_cast<std::size_t>(history.count) + 1;
  std::array<double, kMaxKnots> t{};
  std::array<Eigen::Vector3d, kMaxKnots> theta;
  std::array<Eigen::Vector3d, kMaxKnots> v;
  theta[0] = v[0] = Eigen::Vector3d::Zero();
  for (std::size_t k = 1; k < knots; ++k) {
    t[k] = t[k - 1] - history.recent[k - 1].dt_s;
    theta[k] = theta[k - 1] - history.recent[k - 1].dtheta_b_rad;
    v[k] = v[k - 1] - history.recent[k - 1].dv_b_mps;
  }
  // Derivative at s of the Lagrange polynomial of knot j.
  const auto slope = [&](std::size_t j, double s) {
    double sum = 0.0;
    for (std::size_t skipped = 0; skipped < knots; ++skipped) {
      if (skipped == j) continue;
      double product = 1.0 / (t[j] - t[skipped]);
      for (std::size_t m = 0; m < knots; ++m) {
        if (m != j && m != skipped) product *= (s - t[m]) / (t[j] - t[m]);
      }
      sum += product;
    }
    return sum;
  };
  BodyRates rates;
  for (std::size_t i = 0; i < 3; ++i) {
    rates.omega_b[i] = rates.f_b[i] = Eigen::Vector3d::Zero();
    const double s = t[which + 1] + 0.5 * static_cast<double>(i) * history.recent[which].dt_s;
    for (std::size_t j = 0; j < knots; ++j) {
      const double weight = slope(j, s);
      rates.omega_b[i] += weight * theta[j];
      rates.f_b[i] += weight * v[j];
    }
  }
  return rates;
}

struct StateRate {
  Eigen::Vector4d q;
  Eigen::Vector3d v_e;
  Eigen::Vector3d r_e;
};

/// The equations of motion: [seed (3)-(5)] as differential equations.
template <GravityModel gravity, EarthRotation rotation>
StateRate state_rate(const NavState& state, const Eigen::Vector3d& omega_b,
                     const Eigen::Vector3d& f_b) {
  const Eigen::Vector3d omega_ie_e = about_z_e(kTurnRadps<rotation>);
  const Eigen::Vector3d coriolis_e = about_z_e(2.0 * kCoriolisRadps<rotation>);
  const Eigen::Quaterniond omega_b_q(0.0, omega_b.x(), omega_b.y(), omega_b.z());
  const Eigen::Quaterniond omega_e_q(0.0, omega_ie_e.x(), omega_ie_e.y(), omega_ie_e.z());
  StateRate rate;
  rate.q = 0.5 * ((state.q_eb * omega_b_q).coeffs() - (omega_e_q * state.q_eb).coeffs());
  rate.v_e = state.q_eb.normalized() * f_b - coriolis_e.cross(state.v_e_mps) +
             gravity_e<gravity>(state.r_e_m);
  rate.r_e = state.v_e_mps;
  return rate;
}

inline NavState moved(const NavState& state, const StateRate& rate, double dt_s) {
  NavState next = state;
  next.q_eb.coeffs() += dt_s * rate.q;
  next.v_e_mps += dt_s * rate.v_e;
  next.r_e_m += dt_s * rate.r_e;
  return next;
}

/// Classical RK4 over recent[which].
template <GravityModel gravity, EarthRotation rotation>
void runge_kutta(NavState& state, const ImuHistory& history, std::size_t which) {
  const double h = history.recent[which].dt_s;
  const BodyRates body = fitted_rates(history, which);
  const auto rate = [&](const NavState& s, std::size_t i) {
    return state_rate<gravity, rotation>(s, body.omega_b[i], body.f_b[i]);
  };
  const StateRate k1 = rate(state, 0);
  const StateRate k2 = rate(moved(state, k1, 0.5 * h), 1);
  const StateRate k3 = rate(moved(state, k2, 0.5 * h), 1);
  const StateRate k4 = rate(moved(state, k3, h), 2);
  // The norm is restored within the one addition, as in turned().
  const Eigen::Vector4d turn = h / 6.0 * (k1.q + 2.0 * (k2.q + k3.q) + k4.q);
  const Eigen::Vector4d turned_q = state.q_eb.coeffs() + turn;
  state.q_eb.coeffs() += turn + (0.5 - 0.5 * turned_q.squaredNorm()) * turned_q;
  state.v_e_mps += h / 6.0 * (k1.v_e + 2.0 * (k2.v_e + k3.v_e) + k4.v_e);
  state.r_e_m += h / 6.0 * (k1.r_e + 2.0 * (k2.r_e + k3.r_e) + k4.r_e);
}

inline bool same_motion(const NavState& a, const NavState& b) {
  return a.q_eb.coeffs() == b.q_eb.coeffs() && a.v_e_mps == b.v_e_mps && a.r_e_m == b.r_e_m;
}

template <GravityModel gravity, EarthRotation rotation>
StrapdownStep runge_kutta_step(NavState& state, const ImuIncrement& inc, ImuHistory& history) {
  const Eigen::Matrix3d C_eb = state.q_eb.toRotationMatrix();
  std::copy_backward(history.recent.begin(), history.recent.end() - 1, history.recent.end());
  history.recent[0] = inc;
  if (history.count == 0) history.first = state;
  // The first increments were fitted with fewer than four: go back and redo them with what has come
  // since, unless a correction has moved the state in between.
  const bool redo =
      history.count > 0 && history.count < ImuHistory::kLength && same_motion(state, history.last);
  history.count = std::min(history.count + 1, ImuHistory::kLength);
  if (redo) {
    state = history.first;
    for (auto which = static_cast<std::size_t>(history.count); which-- > 1;) {
      runge_kutta<gravity, rotation>(state, history, which);
    }
  }
  runge_kutta<gravity, rotation>(state, history, 0);
  history.last = state;
  const Eigen::Matrix3d C_eb_mean = 0.5 * (C_eb + state.q_eb.toRotationMatrix());
  return {C_eb_mean, C_eb_mean * inc.dv_b_mps};
}

}  // namespace leeway::schemes
