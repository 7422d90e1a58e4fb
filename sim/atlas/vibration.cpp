#include "sim/atlas/vibration.hpp"

#include <spdlog/fmt/fmt.h>

#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/true_increments.hpp"
#include "sim/atlas/free_run.hpp"

namespace leeway::sim {
namespace {

constexpr double kVibrationS = 10.0;

std::vector<double> frequencies_hz(const AtlasOptions& options) {
  return options.brief ? std::vector{5.0, 20.0, 60.0}
                       : std::vector{1.0, 5.0, 10.0, 20.0, 30.0, 60.0};
}

std::vector<double> imu_rates_hz(const AtlasOptions& options) {
  return options.brief ? std::vector{100.0, 400.0} : std::vector{50.0, 100.0, 200.0, 400.0};
}

}  // namespace

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
