// The cases named "ranks: .." also run on three of them, by mpirun.
#include "sim/trials/shared_trials.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/trials/campaign.hpp"
#include "sim/trials/journals/journal_line.hpp"
#include "tests/sim/tools/all_ranks.hpp"

namespace leeway::sim {
namespace {

using test::all_ranks;

Scene one_minute(int trials) {
  Scene scene;
  scene.trajectory = square_loop();
  scene.duration_s = 60.0;
  scene.gnss.interval_s = 10.0;
  scene.trials = trials;
  return scene;
}

std::vector<SharedTrial> errors_at_scored_fixes(const TrialPlan& plan, const Ranks& ranks) {
  const auto error = [&plan](std::size_t k, const TrialEpoch& epoch) -> std::optional<double> {
    if (!plan.fixes()[k].scored) return {};
    return epoch.error_h_m;
  };
  const Scene& scene = plan.scene();
  return shared_trials(plan, {scene.first_seed, static_cast<std::uint64_t>(scene.trials)}, error,
                       ranks);
}

}  // namespace

TEST_CASE("ranks: the trials of all are on each, to the bit as of one process") {
  const TrialPlan plan(one_minute(7), {}, 1);
  const auto shared = errors_at_scored_fixes(plan, all_ranks());
  const auto alone = errors_at_scored_fixes(plan, Ranks::alone());
  REQUIRE(shared.size() == 7);
  REQUIRE(alone.size() == 7);
  for (std::size_t k = 0; k < 7; ++k) {
    CAPTURE(k);
    CHECK(shared[k].score.seed == 1 + k);
    CHECK(line_of(shared[k].score) == line_of(alone[k].score));
    CHECK(line_of(shared[k].score) == line_of(run_trial(plan, 1 + k)));
    CHECK(!shared[k].of_fixes.empty());
    CHECK(shared[k].of_fixes == alone[k].of_fixes);
  }
}

TEST_CASE("ranks: the result of a campaign is whole on each") {
  const Scene scene = one_minute(8);
  const CampaignResult shared = campaign(scene, {}, all_ranks());
  const CampaignResult alone = campaign(scene);
  CHECK(shared.trials == 8);
  CHECK(shared.mean_nees == alone.mean_nees);
  CHECK(shared.rms_horizontal_m == alone.rms_horizontal_m);
  CHECK(shared.worst_seed == alone.worst_seed);
}

TEST_CASE("ranks: nobody stops where all have the same scene") {
  CHECK_NOTHROW(require_same_scene(17, all_ranks()));
}

}  // namespace leeway::sim
