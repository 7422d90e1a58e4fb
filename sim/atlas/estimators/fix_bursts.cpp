#include <cmath>
#include <string>

#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kBurstS = 10.0;
constexpr double kBurstsSettledS = 120.0;  // of continuous fixes at first
constexpr int kGaps = 4;

/// Ten seconds of fixes, then minutes of none, four times.
Scene bursts(double gap_s) {
  const double duration_s = kBurstsSettledS + kGaps * (gap_s + kBurstS);
  Scene scene = drive_scene(circle({.duration_s = duration_s}), 20.0);
  for (int k = 0; k < kGaps; ++k) {
    scene.gnss.outages.push_back({kBurstsSettledS + k * (gap_s + kBurstS), gap_s});
  }
  return scene;
}

/// Horizontal error over its claim before the first fix after each gap.
double error_over_claim_after_gaps(WatchedFilter& filter, const RecordedTrial& trial,
                                   double gap_s) {
  double error_m2 = 0.0;
  double claimed_m2 = 0.0;
  double last_fix_s = 0.0;
  replay(filter, trial, [&](const Estimate& truth, const WatchedFilter& now) {
    const double t_s = to_seconds(truth.nav.time);
    const bool is_first = t_s - last_fix_s > 0.5 * gap_s;
    last_fix_s = t_s;
    if (!is_first || !now.has_estimate()) return;
    error_m2 += position_error_n_m(truth, now.estimate()).head<2>().squaredNorm();
    if (const auto P = now.covariance()) claimed_m2 += claimed_horizontal_m2(truth, *P);
  });
  return std::sqrt(error_m2 / claimed_m2);
}

std::vector<AtlasCell> run_fix_bursts(const AtlasOptions& options) {
  return cells_over(std::vector{60.0, 180.0}, [&](double gap_s) {
    const Scene scene = bursts(gap_s);
    return scored(few_atlas_columns(), scene.filter,
                  recorded_trials(scene, options.brief ? 3 : 10),
                  "gaps of " + std::to_string(std::lround(gap_s)) + " s",
                  [gap_s](WatchedFilter& filter, const RecordedTrial& trial) {
                    return error_over_claim_after_gaps(filter, trial, gap_s);
                  });
  });
}

}  // namespace

AtlasScene fix_bursts() {
  return {.place = 90,
          .key = "fix-bursts",
          .title = "Bursts of fixes with minutes between",
          .figure = "horizontal error over its claimed sigma at the end of gaps",
          .limits = {1.5, 3.0,
                     "of 1, by how much a few dozen gaps scatter; at 3 a limit that is derived "
                     "from the claim is not kept"},
          .run = run_fix_bursts};
}

}  // namespace leeway::sim::scenes
