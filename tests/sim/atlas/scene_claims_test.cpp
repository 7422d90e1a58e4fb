#include "sim/atlas/mismatch/scene_claims.hpp"

#include <doctest/doctest.h>

#include <filesystem>

#include "leeway/sim/analysis/interval.hpp"
#include "leeway/sim/scene/scene_file.hpp"

namespace leeway::sim {
namespace {

Scene town_car() { return read_scene(std::filesystem::path(LEEWAY_SCENES_DIR) / "town-car.toml"); }

/// What the navigator makes of the town, at every interval.
/// @param off  what R95 may be off by, relative
void check_town(int trials, double off) {
  const Scene scene = town_car();
  const double longest_s = solve_intervals(scene, {10.0}).front().interval_s;
  CHECK(longest_s > 10.0);
  for (const SceneClaim& claim : run_scene_claims(scene, trials)) {
    MESSAGE(name(claim.vehicle), ", every ", claim.fix_interval_s, " s: R95 ", claim.r95_m,
            " m, over the linear one ", claim.r95_over_linear, "; RMS / sigma before fixes ",
            claim.before_fixes.ratio(FaultError::kPosition), ", between ",
            claim.between.ratio(FaultError::kPosition), ", velocity ",
            claim.before_fixes.ratio(FaultError::kVelocity), ", heading ",
            claim.before_fixes.ratio(FaultError::kHeading), "; lost ", claim.lost.size());
    CAPTURE(name(claim.vehicle));
    CAPTURE(claim.fix_interval_s);
    CHECK(claim.lost.empty());
    if (claim.fix_interval_s > longest_s) continue;
    CHECK(claim.r95_over_linear < 1.0 + off);
    // What a car knows of itself the linear analysis does not.
    if (claim.vehicle == VehicleKind::kNone) CHECK(claim.r95_over_linear > 1.0 - off);
  }
}

}  // namespace

TEST_CASE("town car: 20 trials err as the linear analysis says" * doctest::test_suite("heavy")) {
  // The error of a code receiver lasts for 40 s: 20 drives of 300 s have about 150 independent
  // ones, whose R95 scatters by 8 %, 1 sigma.
  check_town(20, 0.25);
}

// sim_test --no-skip -s -tc="town car: 200*": some minutes
TEST_CASE("town car: 200 trials err as the linear analysis says" * doctest::skip() *
          doctest::test_suite("heavy")) {
  check_town(200, 0.1);
}

}  // namespace leeway::sim
