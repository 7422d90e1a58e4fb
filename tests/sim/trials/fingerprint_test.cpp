#include "sim/trials/fingerprint.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>

#include "leeway/model/initial_covariance.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "tests/support/changed.hpp"

namespace leeway::sim {

TEST_CASE("every field of a scene makes another fingerprint, but for names, the limit and counts") {
  Scene scene;
  scene.trajectory = square_loop();
  scene.duration_s = 60.0;
  scene.gnss.interval_s = 10.0;
  scene.gnss.outages = {{15.0, 10.0}};
  scene.initial = InitialSigma{0.01, 0.1, 0.1, 1.0};
  const std::uint64_t original = fingerprint(TrialPlan(scene));
  int others = 0;
  test::for_each_changed(
      scene, test::ToAnother{}, [&](const std::string& field, const Scene& other) {
        CAPTURE(field);
        const std::array ignored{"name",         "imu_name", "limit.metric", "limit.limit_m",
                                 "limit.share",  "limit.preset", "limit.last_s",
                                 "trials",       "first_seed"};
        const bool is_ignored = std::find(ignored.begin(), ignored.end(), field) != ignored.end();
        CHECK((fingerprint(TrialPlan(other)) == original) == is_ignored);
        others += !is_ignored;
      });
  CHECK(others > 60);
  scene.trajectory = square_loop({.speed_mps = 21.0});
  CHECK(fingerprint(TrialPlan(scene)) != original);
}

}  // namespace leeway::sim
