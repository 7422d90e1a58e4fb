#include <spdlog/fmt/fmt.h>


#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/true_increments.hpp"
#include "sim/atlas/free_run.hpp"

namespace leeway::sim::scenes {
namespace {

/// Of the eight, which ends where it began; its body motions fit in with whole periods.
constexpr Duration kLap = std::chrono::minutes{2};

Trajectory endless_eight(double duration_s) {
  Trajectory drive = manoeuvre_car();
  drive.duration_s = duration_s;
  drive.period_s = to_seconds(kLap);
  return drive;
}

std::vector<AtlasCell> run_euler_hour(const AtlasOptions& options) {
  const auto rates_hz =
      options.brief ? std::vector{10.0, 100.0} : std::vector{10.0, 20.0, 50.0, 100.0, 200.0};
  const Trajectory drive = endless_eight(3600.0);
  const NavState start = truth_at(drive, 0.0).nav;
  return cells_over(rates_hz, [&](double rate_hz) {
    const TrueIncrements increments(drive, rate_hz, drive.duration_s, 1);
    const auto error_m = [&start, largest_m = 0.0](const NavState& nav) mutable {
      const bool is_lap_done = nav.time.time_since_epoch() % kLap == Duration{};
      if (is_lap_done) largest_m = std::max(largest_m, horizontal_error_m(start, nav));
      return largest_m;
    };
    return free_runs({Scheme::kExplicitEuler, Scheme::kSemiImplicitEuler, Scheme::kOneSample,
                      Scheme::kTwoSample, Scheme::kRungeKutta4},
                     fmt::format("{:g} Hz", rate_hz), start, increments, error_m);
  });
}

}  // namespace

AtlasScene euler_hour() {
  return {.place = 270,
          .key = "euler-hour",
          .title = "An hour of explicit Euler",
          .figure = "largest horizontal error in an hour without fixes, perfect sensors",
          .unit = "m",
          .limits = {185.2, 1852.0,
                     "a nautical mile an hour is a navigation-grade INS with all its sensors' "
                     "errors; a tenth of it does not show"},
          .run = run_euler_hour};
}

}  // namespace leeway::sim::scenes
