#include "leeway/strapdown/strapdown.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "leeway/earth/rotation.hpp"
#include "lib/earth/small_turn.hpp"
#include "lib/earth/triple.hpp"
#include "lib/earth/zonal_gravity.hpp"

namespace leeway {
namespace {

/// The Earth's rate as the attitude sees it, and as Coriolis does: about z in ECEF.
template <EarthRotation rotation>
constexpr double kTurnRadps =
    rotation == EarthRotation::kOn || rotation == EarthRotation::kTurnAlone
        ? wgs84::kRotationRateRadps
        : 0.0;
template <EarthRotation rotation>
constexpr double kCoriolisRadps =
    rotation == EarthRotation::kOn || rotation == EarthRotation::kCoriolisAlone
        ? wgs84::kRotationRateRadps
        : 0.0;

Eigen::Vector3d about_z_e(double rate) { return {0.0, 0.0, rate}; }

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

template <Scheme scheme>
[[gnu::always_inline]] inline PairTerms pair_terms(const Increment& inc, const Increment& last) {
  const double factor = inc.dt_s * inc.dt_s / (6.0 * last.dt_s * (last.dt_s + inc.dt_s));
  PairTerms terms;
  if constexpr (scheme != Scheme::kSculling) {
    terms.coning_b_rad = factor * cross(last.dtheta_b, inc.dtheta_b);
  }
  if constexpr (scheme != Scheme::kConing) {
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

/// [seed (3)-(8)]; the semi-implicit variant takes the position from the new velocity.
template <GravityModel gravity, EarthRotation rotation, bool position_from_new_velocity>
StrapdownStep euler_step(NavState& state, const ImuIncrement& inc) {
  const Eigen::Vector3d turn_e = about_z_e(kTurnRadps<rotation>);
  const Eigen::Vector3d coriolis_e = about_z_e(2.0 * kCoriolisRadps<rotation>);
  const Eigen::Matrix3d C_eb = state.q_eb.toRotationMatrix();
  const Eigen::Vector3d dtheta_eb_b =
      inc.dtheta_b_rad - inc.dt_s * (C_eb.transpose() * turn_e);  // [seed (3)]
  const Eigen::Vector3d dv_f_e = C_eb * inc.dv_b_mps;             // [seed (4)]
  const Eigen::Vector3d v_old_e = state.v_e_mps;
  state.v_e_mps += dv_f_e + inc.dt_s * (gravity_e<gravity>(state.r_e_m) -
                                        coriolis_e.cross(v_old_e));  // [seed (5)-(7)]
  state.r_e_m += inc.dt_s * (position_from_new_velocity ? state.v_e_mps : v_old_e);  // [seed (8)]
  state.q_eb = turned(Eigen::Vector3d::Zero(), state.q_eb, dtheta_eb_b);
  return {C_eb, dv_f_e};
}

/// gravity_e() in line.
template <GravityModel gravity>
[[gnu::always_inline]] inline Triple gravity_of(const Triple& r_e_m) {
  if constexpr (gravity == GravityModel::kNormal) {
    return zonal::gravity_e<zonal::kNormalDegree>(r_e_m);
  } else if constexpr (gravity == GravityModel::kJ2) {
    return zonal::gravity_e<zonal::kJ2Degree>(r_e_m);
  } else {
    return triple(gravity_e<gravity>(vector(r_e_m)));
  }
}

/// omega x v for omega = (0, 0, rate).
[[gnu::always_inline]] inline Triple turn_about_z(double rate, const Triple& v) {
  return {-rate * v.y, rate * v.x, 0.0};
}

/// Second order in everything but the body-frame integrals, which the caller supplies in dv_f.
template <GravityModel gravity, EarthRotation rotation>
[[gnu::always_inline]] inline Triple velocity_change(const Triple& r_e_m, const Triple& v_e_mps,
                                                     const Triple& dv_f_e_mps, double dt_s) {
  constexpr double kOmega = kCoriolisRadps<rotation>;
  const Triple pushed = dv_f_e_mps + dt_s * gravity_of<gravity>(r_e_m + 0.5 * dt_s * v_e_mps);
  const Triple v_mid = v_e_mps + 0.5 * (pushed - turn_about_z(2.0 * dt_s * kOmega, v_e_mps));
  return pushed - turn_about_z(2.0 * dt_s * kOmega, v_mid);
}

template <GravityModel gravity, EarthRotation rotation>
StrapdownStep trapezoid_step(NavState& state, const ImuIncrement& inc) {
  const Eigen::Matrix3d C_old = state.q_eb.toRotationMatrix();
  state.q_eb = turned(about_z_e(-inc.dt_s * kTurnRadps<rotation>), state.q_eb, inc.dtheta_b_rad);
  const Eigen::Matrix3d C_mean = 0.5 * (C_old + state.q_eb.toRotationMatrix());
  const Eigen::Vector3d dv_f_e = C_mean * inc.dv_b_mps;
  const Eigen::Vector3d dv_e = vector(velocity_change<gravity, rotation>(
      triple(state.r_e_m), triple(state.v_e_mps), triple(dv_f_e), inc.dt_s));
  state.r_e_m += inc.dt_s * (state.v_e_mps + 0.5 * dv_e);
  state.v_e_mps += dv_e;
  return {C_mean, dv_f_e};
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

/// Each step looks back, so that every output is good; the second step of a pair also replaces what
/// the first took from the past by what the pair itself shows. That makes the pair symmetric in
/// time, and the scheme one order better than looking back alone.
template <Scheme scheme, GravityModel gravity, EarthRotation rotation>
StrapdownStep two_sample_step(NavState& state, const ImuIncrement& newest, ImuHistory& history) {
  const Increment inc = increment(newest);
  const Increment last = increment(history.recent[0]);
  const bool look_back = history.count > 0;
  const bool settle = history.pair_open;
  const PairTerms own = look_back ? pair_terms<scheme>(inc, last) : PairTerms{};
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
  const bool bends = look_back && scheme != Scheme::kConing;
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

/// Body rates at the start, middle and end of an increment.
struct BodyRates {
  std::array<Eigen::Vector3d, 3> omega_b;
  std::array<Eigen::Vector3d, 3> f_b;
};

/// Rates within recent[which] as the derivative of the polynomial through the running integrals at
/// the ends of all recent increments; their integral over each increment is kept.
BodyRates fitted_rates(const ImuHistory& history, std::size_t which) {
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

NavState moved(const NavState& state, const StateRate& rate, double dt_s) {
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

bool same_motion(const NavState& a, const NavState& b) {
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

/// The step but for the state's time.
template <Scheme scheme, GravityModel gravity, EarthRotation rotation>
StrapdownStep motion_step(NavState& state, const ImuIncrement& inc, ImuHistory& history) {
  if constexpr (scheme == Scheme::kExplicitEuler) {
    return euler_step<gravity, rotation, false>(state, inc);
  } else if constexpr (scheme == Scheme::kSemiImplicitEuler) {
    return euler_step<gravity, rotation, true>(state, inc);
  } else if constexpr (scheme == Scheme::kTrapezoid) {
    return trapezoid_step<gravity, rotation>(state, inc);
  } else if constexpr (scheme == Scheme::kOneSample) {
    return report(increment_motion<gravity, rotation>(state, increment(inc), {}, {}));
  } else if constexpr (scheme == Scheme::kRungeKutta4) {
    return runge_kutta_step<gravity, rotation>(state, inc, history);
  } else {
    return two_sample_step<scheme, gravity, rotation>(state, inc, history);
  }
}

}  // namespace

template <Scheme scheme, GravityModel gravity, EarthRotation rotation>
StrapdownStep strapdown_step(NavState& state, const ImuIncrement& inc, ImuHistory& history) {
  if (history.count > 0 && history.recent[0].time != state.time) history = ImuHistory{};
  const StrapdownStep step = motion_step<scheme, gravity, rotation>(state, inc, history);
  state.time = inc.time;
  return step;
}

namespace {

template <Scheme scheme, GravityModel gravity>
StrapdownFunction with_rotation(EarthRotation rotation) {
  switch (rotation) {
    case EarthRotation::kOff:
      return &strapdown_step<scheme, gravity, EarthRotation::kOff>;
    case EarthRotation::kTurnAlone:
      return &strapdown_step<scheme, gravity, EarthRotation::kTurnAlone>;
    case EarthRotation::kCoriolisAlone:
      return &strapdown_step<scheme, gravity, EarthRotation::kCoriolisAlone>;
    case EarthRotation::kOn:
      break;
  }
  return &strapdown_step<scheme, gravity, EarthRotation::kOn>;
}

template <Scheme scheme>
StrapdownFunction with_gravity(const StrapdownPolicy& policy) {
  switch (policy.gravity) {
    case GravityModel::kConstant:
      return with_rotation<scheme, GravityModel::kConstant>(policy.rotation);
    case GravityModel::kJ2:
      return with_rotation<scheme, GravityModel::kJ2>(policy.rotation);
    case GravityModel::kNormal:
      break;
  }
  return with_rotation<scheme, GravityModel::kNormal>(policy.rotation);
}

}  // namespace

StrapdownFunction strapdown_function(const StrapdownPolicy& policy) {
  switch (policy.scheme) {
    case Scheme::kExplicitEuler:
      return with_gravity<Scheme::kExplicitEuler>(policy);
    case Scheme::kSemiImplicitEuler:
      return with_gravity<Scheme::kSemiImplicitEuler>(policy);
    case Scheme::kTrapezoid:
      return with_gravity<Scheme::kTrapezoid>(policy);
    case Scheme::kOneSample:
      return with_gravity<Scheme::kOneSample>(policy);
    case Scheme::kConing:
      return with_gravity<Scheme::kConing>(policy);
    case Scheme::kSculling:
      return with_gravity<Scheme::kSculling>(policy);
    case Scheme::kRungeKutta4:
      return with_gravity<Scheme::kRungeKutta4>(policy);
    case Scheme::kTwoSample:
      break;
  }
  return with_gravity<Scheme::kTwoSample>(policy);
}

}  // namespace leeway
