#include "sim/atlas/free_run.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/true_increments.hpp"

namespace leeway::sim {
namespace {

constexpr double kToldRateRadps = kRadPerDeg / 3600.0;
constexpr double kToldForceMps2 = 1e-4 * kStandardGravityMps2;

constexpr double kVibrationS = 10.0;

std::vector<double> frequencies_hz(const AtlasOptions& options) {
  return options.brief ? std::vector{5.0, 20.0, 60.0}
                       : std::vector{1.0, 5.0, 10.0, 20.0, 30.0, 60.0};
}

std::vector<double> imu_rates_hz(const AtlasOptions& options) {
  return options.brief ? std::vector{100.0, 400.0} : std::vector{50.0, 100.0, 200.0, 400.0};
}

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

std::vector<AtlasCell> vibration_cells(
    const std::function<LocalMotion(double, double)>& motion,
    const std::function<double(const NavState&, const NavState&, double)>& figure,
    const AtlasOptions& options) {
  return cells_over(frequencies_hz(options), [&](double frequency_hz) {
    std::vector<AtlasCell> cells;
    Trajectory trajectory{.name = "vibration",
                          .plane = TangentPlane(kDefaultOrigin),
                          .duration_s = kVibrationS};
    trajectory.motion = [&motion, frequency_hz](double t_s) { return motion(frequency_hz, t_s); };
    trajectory.period_s = 1.0;
    const NavState start = truth_at(trajectory, 0.0).nav;
    const NavState truth = truth_at(trajectory, kVibrationS).nav;
    for (const double rate_hz : imu_rates_hz(options)) {
      const TrueIncrements increments(trajectory, rate_hz, kVibrationS, 1);
      append(cells,
             free_runs({Scheme::kOneSample, Scheme::kTwoSample, Scheme::kRungeKutta4},
                       fmt::format("{:g} Hz at {:g} Hz", frequency_hz, rate_hz), start, increments,
                       [&](const NavState& nav) { return figure(truth, nav, kVibrationS); }));
    }
    return cells;
  });
}

}  // namespace leeway::sim
