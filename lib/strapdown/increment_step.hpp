/// @file
/// The steps that are exact for constant rates within an increment, alone or with the terms that
/// two increments add. Private to the strapdown.
#pragma once

#include "leeway/earth/rotation.hpp"
#include "lib/earth/small_turn.hpp"
#include "lib/strapdown/earth_terms.hpp"
#include "lib/strapdown/scheme_terms.hpp"

namespace leeway::schemes {

/// An increment in registers.
struct Increment {
  double dt_s;
  Triple dtheta_b;
  Triple dv_b;
};

[[gnu::always_inline]] inline Increment increment(const ImuIncrement& inc) {
  return {inc.dt_s, triple(inc.dtheta_b_rad), triple(inc.dv_b_mps)};
}

/// What two increments tell beyond one: coning and sculling in the body axes of the newer one's
/// start, with rates linear through both, of whatever lengths. For equal lengths the factor is the
/// classical 1/12. Savage (1998), part 1 (47), part 2 (36).
struct PairTerms {
  Triple coning_b_rad{};
  Triple sculling_b_mps{};
};

template <SchemeTerms takes>
[[gnu::always_inline]] inline PairTerms pair_terms(const Increment& inc, const Increment& last) {
  const double factor = inc.dt_s * inc.dt_s / (6.0 * last.dt_s * (last.dt_s + inc.dt_s));
  PairTerms terms;
  if constexpr (takes.coning) {
    terms.coning_b_rad = factor * cross(last.dtheta_b, inc.dtheta_b);
  }
  if constexpr (takes.sculling) {
    terms.sculling_b_mps =
        factor * (cross(last.dtheta_b, inc.dv_b) + cross(last.dv_b, inc.dtheta_b));
  }
  return terms;
}

/// Position change beyond the trapezoid when the acceleration is linear through two increments:
/// own_s times this one's velocity change, and what the last one's makes.
struct Curvature {
  double own_s{0.0};
  Triple last_e_m{};
};

[[gnu::always_inline]] inline Curvature curvature(double dt_s, const Triple& last_dv_e_mps,
                                                  double last_dt_s) {
  const double own_s = -dt_s * dt_s / (6.0 * (dt_s + last_dt_s));
  return {own_s, -own_s * dt_s / last_dt_s * last_dv_e_mps};
}

/// The integral of the force over the increment, in the body axes of its start.
[[gnu::always_inline]] inline Triple force_integral(const Increment& inc) {
  if (squared_norm(inc.dtheta_b) < kSmallTurnSq) {
    return small_left_jacobian_times(inc.dtheta_b, inc.dv_b);
  }
  return triple(left_jacobian_times(vector(inc.dtheta_b), vector(inc.dv_b)));
}

/// The Earth's turn on the left, the body's on the right.
[[gnu::always_inline]] inline void turn(Eigen::Quaterniond& q_eb, const Quadruple& q,
                                        double earth_rad, const Triple& phi_b_rad) {
  if (squared_norm(phi_b_rad) < kSmallTurnSq && earth_rad * earth_rad < kSmallTurnSq) {
    assign(q_eb, turned(-earth_rad, q, phi_b_rad));
  } else {
    q_eb = turned(Eigen::Vector3d(0.0, 0.0, -earth_rad), q_eb, vector(phi_b_rad));
  }
}

/// What a step of the increment schemes did.
struct IncrementMotion {
  Columns C_eb;       // at the start
  Triple phi_b_rad;   // turn of the body
  Triple dv_f_e_mps;  // integral of the force
  Triple dv_e_mps;    // change of the velocity
};

[[gnu::always_inline]] inline StrapdownStep report(const IncrementMotion& motion) {
  const auto& [C, phi, dv_f_e, dv_e] = motion;
  StrapdownStep step;
  // C + C skew(phi) / 2, by columns.
  const Triple half = 0.5 * phi;
  const Triple x = C.x + (half.z * C.y - half.y * C.z);
  const Triple y = C.y + (half.x * C.z - half.z * C.x);
  const Triple z = C.z + (half.y * C.x - half.x * C.y);
  assign(step.C_eb_mean, x, y, z);
  assign(step.dv_f_e_mps, dv_f_e);
  return step;
}

/// Exact for a rate and force constant within the increment, plus the terms of a pair. Second order
/// in what is not the body's.
template <GravityModel gravity, EarthRotation rotation>
[[gnu::always_inline]] inline IncrementMotion increment_motion(NavState& state,
                                                               const Increment& inc,
                                                               const PairTerms& terms,
                                                               const Curvature& curve) {
  constexpr double kOmega = kTurnRadps<rotation>;
  const double dt = inc.dt_s;
  const Quadruple q = quadruple(state.q_eb);
  const Triple v = triple(state.v_e_mps);
  const Triple r = triple(state.r_e_m);
  IncrementMotion motion;
  motion.C_eb = rotation_matrix(q);
  motion.phi_b_rad = inc.dtheta_b + terms.coning_b_rad;
  const Triple dv_at_start = motion.C_eb * (force_integral(inc) + terms.sculling_b_mps);
  // The frame turns under the force.
  const Triple dv_f = dv_at_start - turn_about_z(0.5 * dt * kOmega, dv_at_start);
  motion.dv_f_e_mps = dv_f;

  const Triple dv = velocity_change<gravity, rotation>(r, v, dv_f, dt);
  motion.dv_e_mps = dv;
  assign(state.r_e_m, r + (dt * v + (0.5 * dt + curve.own_s) * dv + curve.last_e_m));
  assign(state.v_e_mps, v + dv);
  turn(state.q_eb, q, dt * kOmega, motion.phi_b_rad);
  return motion;
}

template <GravityModel gravity, EarthRotation rotation>
StrapdownStep one_sample_step(NavState& state, const ImuIncrement& inc, ImuHistory&) {
  return report(increment_motion<gravity, rotation>(state, increment(inc), {}, {}));
}

/// Each step looks back, so that every output is good; the second step of a pair also replaces what
/// the first took from the past by what the pair itself shows. That makes the pair symmetric in
/// time, and the scheme one order better than looking back alone.
template <SchemeTerms takes, GravityModel gravity, EarthRotation rotation>
StrapdownStep two_sample_step(NavState& state, const ImuIncrement& newest, ImuHistory& history) {
  const Increment inc = increment(newest);
  const Increment last = increment(history.recent[0]);
  const bool look_back = history.count > 0;
  const bool settle = history.pair_open;
  const PairTerms own = look_back ? pair_terms<takes>(inc, last) : PairTerms{};
  PairTerms applied = own;
  if (settle) {
    // Owed to the first step, carried over the turn since.
    const double length_ratio = last.dt_s / inc.dt_s;
    const double share = length_ratio * length_ratio * length_ratio;
    const Triple coning = share * own.coning_b_rad - triple(history.coning_b_rad);
    const Triple sculling = share * own.sculling_b_mps - triple(history.sculling_b_mps);
    const Triple half_turn = 0.5 * (last.dtheta_b + inc.dtheta_b);
    applied.coning_b_rad = own.coning_b_rad + (coning - cross(half_turn, coning));
    applied.sculling_b_mps = own.sculling_b_mps + (sculling - cross(last.dtheta_b, sculling));
  }
  // The curvature needs no settling: over equal steps it telescopes to the change of acceleration.
  const bool bends = look_back && takes.sculling;
  const Curvature curve =
      bends ? curvature(inc.dt_s, triple(history.dv_e_mps), last.dt_s) : Curvature{};
  const IncrementMotion motion = increment_motion<gravity, rotation>(state, inc, applied, curve);

  history.recent[0].time = newest.time;
  history.recent[0].dt_s = inc.dt_s;
  assign(history.recent[0].dtheta_b_rad, inc.dtheta_b);
  assign(history.recent[0].dv_b_mps, inc.dv_b);
  history.count = 1;
  history.pair_open = !settle;
  assign(history.coning_b_rad, own.coning_b_rad);
  assign(history.sculling_b_mps, own.sculling_b_mps);
  assign(history.dv_e_mps, motion.dv_e_mps);
  return report(motion);
}

}  // namespace leeway::schemes
