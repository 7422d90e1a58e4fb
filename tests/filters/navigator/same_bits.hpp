/// @file
/// Whether two navigators are in the same state, to the last bit.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "leeway/navigator/navigator.hpp"

namespace leeway::test {

/// Of what a filter knows of the vehicle.
inline bool same_bits(const std::optional<VehicleState>& a, const std::optional<VehicleState>& b) {
  if (!a || !b) return !a && !b;
  return a->value == b->value && a->P == b->P;
}

/// Of what a navigator says of itself. Both may still be aligning.
inline bool same_bits(const Navigator& a, const Navigator& b) {
  if (a.aligned() != b.aligned()) return false;
  if (!a.aligned()) return true;
  const Estimate& x = a.filter().estimate();
  const Estimate& y = b.filter().estimate();
  return x.nav.time == y.nav.time && x.nav.q_eb.coeffs() == y.nav.q_eb.coeffs() &&
         x.nav.v_e_mps == y.nav.v_e_mps && x.nav.r_e_m == y.nav.r_e_m &&
         x.bias.b_a_mps2 == y.bias.b_a_mps2 && x.bias.b_g_radps == y.bias.b_g_radps &&
         a.filter().covariance() == b.filter().covariance() &&
         same_bits(a.filter().vehicle(), b.filter().vehicle()) && a.C_bs() == b.C_bs();
}

/// Everything, what waits and what is kept to go back to included.
inline std::vector<std::byte> bytes_of(const Navigator& navigator) {
  std::vector<std::byte> bytes(navigator.snapshot_size());
  navigator.snapshot(bytes);
  return bytes;
}

}  // namespace leeway::test
