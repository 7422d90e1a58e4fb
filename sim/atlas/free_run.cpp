#include "sim/atlas/free_run.hpp"

#include <algorithm>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"

namespace leeway::sim {
namespace {

constexpr double kToldRateRadps = kRadPerDeg / 3600.0;
constexpr double kToldForceMps2 = 1e-4 * kStandardGravityMps2;

}  // namespace

void WatchedIncrements::push(const ImuIncrement& inc) {
  monitor_.push(inc);
  const LeftOut left_out = monitor_.left_out(scheme_);
  rate_radps_ = std::max(rate_radps_, left_out.rate_b_radps.norm());
  force_mps2_ = std::max(force_mps2_, left_out.force_b_mps2.norm());
  resolved_ = resolved_ && monitor_.resolves_motion();
}

std::string WatchedIncrements::reported() const {
  std::string told;
  const auto tell = [&told](bool is_so, const char* what) {
    if (is_so) told += (told.empty() ? "" : "; ") + std::string(what);
  };
  tell(!resolved_, "motion not resolved");
  tell(rate_radps_ > kToldRateRadps, "rate left out");
  tell(force_mps2_ > kToldForceMps2, "force left out");
  return told;
}

Eigen::Vector3d attitude_error_e_rad(const NavState& truth, const NavState& nav) {
  return log_quaternion(truth.q_eb * nav.q_eb.conjugate());
}

double horizontal_error_m(const NavState& truth, const NavState& nav) {
  const Eigen::Vector3d error_e_m = truth.r_e_m - nav.r_e_m;
  return error_e_m.cross(down_e_at(truth.r_e_m)).norm();
}

}  // namespace leeway::sim
