#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/sim/tools/random.hpp"
#include "sim/atlas/free_run.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kNominalS = 0.01;
constexpr double kSplitRunS = 100.0;

const Trajectory& moving_car() {
  static const Trajectory kDrive = manoeuvre_car();
  return kDrive;
}

/// Increments of these lengths in turn, while they fit.
template <class Length>
std::vector<ImuIncrement> of_lengths(Length&& length_s) {
  std::vector<ImuIncrement> increments;
  double from_s = 0.0;
  for (double to_s = length_s(); to_s <= kSplitRunS; to_s = from_s + length_s()) {
    increments.push_back(true_increment(moving_car(), from_s, to_s));
    from_s = to_s;
  }
  return increments;
}

std::vector<ImuIncrement> jittered() {
  Random random(1);
  return of_lengths([&random] { return kNominalS * (0.7 + 0.6 * random.uniform()); });
}

/// As an odd sample and an even one come out of a driver.
std::vector<ImuIncrement> two_to_three() {
  int k = 0;
  return of_lengths([&k] { return kNominalS * (k++ % 2 == 0 ? 0.8 : 1.2); });
}

std::vector<ImuIncrement> equal() {
  return true_increments(moving_car(), 1.0 / kNominalS, kSplitRunS);
}

/// Every tenth cut in two at a third, as a fix does it: its rates are taken as constant.
std::vector<ImuIncrement> cut_for_fixes() {
  std::vector<ImuIncrement> increments;
  for (const ImuIncrement& inc : equal()) {
    if (increments.size() % 11 != 9) {
      increments.push_back(inc);
      continue;
    }
    const auto [before, after] =
        split(inc, inc.time - duration_from_seconds(2.0 / 3.0 * kNominalS));
    increments.push_back(before);
    increments.push_back(after);
  }
  return increments;
}

/// Rates times the nominal interval: what becomes of samples whose times nobody looks at.
std::vector<ImuIncrement> times_ignored(std::vector<ImuIncrement> increments) {
  Time time{};
  for (ImuIncrement& inc : increments) {
    const double scale = kNominalS / inc.dt_s;
    time += duration_from_seconds(kNominalS);
    inc = {time, kNominalS, scale * inc.dtheta_b_rad, scale * inc.dv_b_mps};
  }
  return increments;
}

/// A condition of the scene.
struct Lengths {
  const char* condition;
  std::vector<ImuIncrement> increments;
};

std::vector<AtlasCell> run_lengths(const Lengths& lengths) {
  const NavState start = truth_at(moving_car(), 0.0).nav;
  const double end_s = to_seconds(lengths.increments.back().time);
  const Eigen::Vector3d end_e_m = truth_at(moving_car(), end_s).nav.r_e_m;
  const auto error_m = [&end_e_m](const NavState& nav) { return (end_e_m - nav.r_e_m).norm(); };
  auto cells = free_runs({Scheme::kExplicitEuler, Scheme::kTrapezoid, Scheme::kOneSample,
                          Scheme::kTwoSample, Scheme::kRungeKutta4},
                         lengths.condition, start, lengths.increments, error_m);
  const AtlasCell blind = free_run(Scheme::kTwoSample, lengths.condition, start,
                                   times_ignored(lengths.increments), error_m);
  cells.push_back({AtlasGroup::kNotOffered, "times ignored", blind.condition, blind.figure});
  return cells;
}

std::vector<AtlasCell> run_split_intervals(const AtlasOptions&) {
  return cells_over(std::vector<Lengths>{{"equal", equal()},
                                         {"cut at fixes", cut_for_fixes()},
                                         {"8 and 12 ms", two_to_three()},
                                         {"7 to 13 ms at random", jittered()}},
                    run_lengths);
}

}  // namespace

AtlasScene split_intervals() {
  return {.place = 280,
          .key = "split-intervals",
          .title = "Jittered and split IMU intervals",
          .figure = "error of the position after 100 s, perfect sensors",
          .unit = "m",
          .limits = {0.1, 10.0,
                     "a tenth of a metre does not show beside any fix; ten metres are what a "
                     "car-grade IMU itself makes of a minute and a half"},
          .run = run_split_intervals};
}

}  // namespace leeway::sim::scenes
