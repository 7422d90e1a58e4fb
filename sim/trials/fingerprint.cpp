#include "sim/trials/fingerprint.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "lib/earth/field_walk.hpp"

namespace leeway::sim {
namespace {

/// What a trial of a given seed does not depend on.
constexpr std::array<std::string_view, 5> kIgnored{"name", "imu_name", "limit", "trials",
                                                   "first_seed"};

}  // namespace

std::uint64_t hash_of(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : bytes) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3;
  }
  return hash;
}

std::uint64_t fingerprint(const TrialPlan& plan) {
  std::string bytes = LEEWAY_VERSION;
  const auto add = [&bytes](const auto& value) {
    const auto its_bytes = leeway::bytes_of(value);
    bytes.append(reinterpret_cast<const char*>(its_bytes.data()), its_bytes.size());
  };
  walk_fields(plan.scene(), [&add](const FieldPath& path, const auto& value, const Range&) {
    if (std::find(kIgnored.begin(), kIgnored.end(), path.root()) == kIgnored.end()) add(value);
  });
  for (const TrialPlan::Fix& fix : plan.fixes()) {
    add(fix.at);
    add(fix.arrives);
    add(fix.scored);
  }
  const NavState start = truth_at(plan.scene().trajectory, 0.0).nav;
  add(start.q_eb.coeffs());
  add(start.v_e_mps);
  add(start.r_e_m);
  add(plan.increments().size());
  // A thousand of them tell two motions apart.
  const std::size_t stride = 1 + plan.increments().stored() / 1000;
  for (std::size_t k = 0; k < plan.increments().stored(); k += stride) {
    const ImuIncrement inc = plan.increments()[k];
    add(inc.dt_s);
    add(inc.dtheta_b_rad);
    add(inc.dv_b_mps);
  }
  return hash_of(bytes);
}

}  // namespace leeway::sim
