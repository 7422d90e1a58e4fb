#include "leeway/ekf/ekf_config.hpp"

#include <cmath>
#include <string>

#include "leeway/earth/error.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway {
namespace {

void validate(const Estimate& estimate) {
  const NavState& nav = estimate.nav;
  if (!nav.v_e_mps.allFinite() || !nav.r_e_m.allFinite() || !nav.q_eb.coeffs().allFinite()) {
    throw Error("initial navigation state: every element must be finite");
  }
  if (std::abs(nav.q_eb.norm() - 1.0) > 1e-9) {
    throw Error("initial q_eb has norm " + std::to_string(nav.q_eb.norm()) +
                ", must be 1 within 1e-9: call normalize()");
  }
  if (!(nav.r_e_m.norm() > 6.3e6)) {
    throw Error("initial r_e_m is " + std::to_string(nav.r_e_m.norm()) +
                " m from the Earth's centre, must be above 6.3e6 m: ECEF coordinates are wanted");
  }
}

}  // namespace

void validate(const EkfConfig& config) { validate_fields("filter", config); }

void validate(const EkfConfig& config, const Estimate& estimate) {
  validate(config);
  validate(estimate);
}

}  // namespace leeway
