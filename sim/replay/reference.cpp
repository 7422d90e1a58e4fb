#include "sim/replay/reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"

namespace leeway::sim {
namespace {

Time clamped(double t_s) { return time_from_seconds(std::clamp(t_s, -9e9, 9e9)); }

}  // namespace

Eigen::Vector3d difference_n_m(const Eigen::Vector3d& a_e_m, const Eigen::Vector3d& b_e_m) {
  return ned_to_ecef(geodetic_from_ecef(b_e_m)).transpose() * (a_e_m - b_e_m);
}

Reference::Reference(const ReplayInput& input)
    : track_(TruthLogReader(input.truth)),
      from_(clamped(input.truth_from_s)),
      to_(clamped(input.truth_to_s)) {}

std::optional<TruthRecord> Reference::at(Time t) {
  if (t < from_ || t > to_) return std::nullopt;
  return track_.interpolate(t);
}

void RmsSum::add(const NavState& nav, const TruthRecord& truth) {
  const NavState true_nav = nav_state_from_ned(truth.nav);
  const Eigen::Vector3d error_n_m = difference_n_m(nav.r_e_m, true_nav.r_e_m);
  ++epochs_;
  horizontal_ += error_n_m.head<2>().squaredNorm();
  vertical_ += error_n_m.z() * error_n_m.z();
  if (truth.has_velocity) {
    velocity_ += (nav.v_e_mps - true_nav.v_e_mps).squaredNorm();
    ++velocity_epochs_;
  }
  if (truth.has_attitude) {
    attitude_ += log_quaternion(nav.q_eb * true_nav.q_eb.conjugate()).squaredNorm();
    ++attitude_epochs_;
  }
}

RmsErrors RmsSum::rms() const {
  const auto root = [](double sum, std::int64_t n) {
    return n > 0 ? std::sqrt(sum / static_cast<double>(n))
                 : std::numeric_limits<double>::quiet_NaN();
  };
  return {epochs_, root(horizontal_, epochs_), root(vertical_, epochs_),
          root(velocity_, velocity_epochs_), root(attitude_, attitude_epochs_) / kRadPerDeg};
}

}  // namespace leeway::sim
