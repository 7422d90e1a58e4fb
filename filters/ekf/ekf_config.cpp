#include "leeway/ekf/ekf_config.hpp"

#include <cmath>
#include <string>

#include "leeway/earth/error.hpp"

namespace leeway {
namespace {

void validate(const EkfConfig& config) {
  if (!config.lever_arm_b_m.allFinite() || config.lever_arm_b_m.norm() > 1000.0) {
    throw Error("lever_arm_b_m: must be finite and at most 1000 m long");
  }
  if (!(config.gate_probability == 0.0 ||
        (config.gate_probability >= 1e-100 && config.gate_probability < 1.0))) {
    throw Error("gate_probability is " + std::to_string(config.gate_probability) +
                ", must be 0 (no gate) or 1e-100 to 1");
  }
  if (!(config.gnss_correlation_s >= 0.0 && config.gnss_correlation_s <= 1e6)) {
    throw Error("gnss_correlation_s is " + std::to_string(config.gnss_correlation_s) +
                ", must be 0 (white) to 1e6 s");
  }
  if (!(config.covariance_interval_s >= 0.0 && config.covariance_interval_s <= 10.0)) {
    throw Error("covariance_interval_s is " + std::to_string(config.covariance_interval_s) +
                ", must be 0 to 10 s");
  }
}

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

void validate(const EkfConfig& config, const Estimate& estimate) {
  validate(config);
  validate(estimate);
}

}  // namespace leeway
