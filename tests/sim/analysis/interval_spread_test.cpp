#include "leeway/sim/analysis/interval_spread.hpp"

#include <doctest/doctest.h>

#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/bias_model.hpp"

namespace leeway::sim {

TEST_CASE("interval spread: the ends of a class lie on both sides, and the middle is the answer") {
  Scene scene;
  scene.name = "at rest";
  scene.trajectory = static_trajectory({.duration_s = 3600.0});
  scene.duration_s = 3600.0;
  scene.filter.gnss_correlation_s = 0.0;
  for (const BiasModel bias : {BiasModel::kConstant, BiasModel::kGaussMarkov}) {
    const ImuErrorModel mid = imu_class_model(ImuClass::kTactical, RangeEnd::kMid);
    set_imu(scene, "tactical/mid", with_bias_model(mid, bias));
    const auto spread = interval_spread(scene, 10.0);
    REQUIRE(spread);
    CHECK(spread->low.interval_s > 1.2 * spread->mid.interval_s);
    CHECK(spread->mid.interval_s > 1.2 * spread->high.interval_s);
    CHECK(spread->mid.interval_s == solve_intervals(scene, {10.0}).front().interval_s);
  }
}

TEST_CASE("interval spread: what states one number has none") {
  Scene scene;
  scene.name = "at rest";
  scene.trajectory = static_trajectory({.duration_s = 3600.0});
  scene.duration_s = 3600.0;
  for (const char* imu : {"STIM300", "automotive-mems", "mine/typical", "mine/mid", ""}) {
    scene.imu_name = imu;
    CHECK_FALSE(interval_spread(scene, 10.0));
  }
}

}  // namespace leeway::sim
