#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "leeway/sim/analysis/coast.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "leeway/sim/scene/scene_file.hpp"
#include "leeway/sim/trials/campaign.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

using test::near;

Scene outlier_free_town() {
  Scene scene = read_scene(std::filesystem::path(LEEWAY_SCENES_DIR) / "town-car.toml");
  // Outliers are no linear errors.
  scene.gnss.outlier_probability = 0.0;
  return scene;
}

double drms_m(const Scene& scene) { return analyze(scene, error_track(scene)).true_drms_m; }

}  // namespace

TEST_CASE("the linear analysis says what the navigator's trials err by, with aiding and without" *
          doctest::test_suite("heavy")) {
  for (const bool aided : {false, true}) {
    CAPTURE(aided);
    Scene scene = outlier_free_town();
    if (!aided) scene.vehicle = scene_vehicle(VehicleKind::kNone);
    scene.gnss.interval_s = 10.0;
    scene.trials = 20;
    const CovarianceAnalysis linear = analyze(scene, error_track(scene));
    const CampaignResult trials = campaign(scene);
    MESSAGE("trials over linear: true " << trials.rms_horizontal_m / linear.true_drms_m
                                        << ", claimed "
                                        << trials.sigma_horizontal_m / linear.claimed_drms_m);
    CHECK(trials.diverged == 0);
    // 20 trials of 149 fixes: 3 % of scatter. The bounds of the ratio of sigmas.
    CHECK(trials.rms_horizontal_m / linear.true_drms_m > 0.93);
    CHECK(trials.rms_horizontal_m / linear.true_drms_m < 1.07);
  }
}

TEST_CASE("what the vehicle tells never makes the true error larger, and an odometer helps most") {
  Scene scene = outlier_free_town();
  scene.duration_s = 900.0;
  scene.gnss.interval_s = 30.0;
  scene.vehicle = scene_vehicle(VehicleKind::kNone);
  const double alone_m = drms_m(scene);
  scene.vehicle->config.zero_velocity = true;
  scene.vehicle->config.zero_angular_rate = true;
  const double at_rest_m = drms_m(scene);
  scene.vehicle->config.non_holonomic = true;
  const double rolling_m = drms_m(scene);
  scene.vehicle->odometer = kUsualOdometer;
  scene.vehicle->config.odometer = true;
  const double measured_m = drms_m(scene);
  MESSAGE("drms, m: " << alone_m << ", " << at_rest_m << ", " << rolling_m << ", " << measured_m);
  CHECK(at_rest_m < alone_m);
  CHECK(rolling_m < 0.8 * at_rest_m);
  CHECK(measured_m < rolling_m);
}

TEST_CASE("a scene with a vehicle that tells nothing is analysed as one without") {
  Scene scene = outlier_free_town();
  scene.duration_s = 600.0;
  scene.vehicle = scene_vehicle(VehicleKind::kNone);
  scene.estimator = SceneEstimator::kEkf;
  const double with_m = drms_m(scene);
  scene.vehicle.reset();
  CHECK(with_m == drms_m(scene));
}

TEST_CASE("the coast time ends where the error meets the limit, and an outage that long meets it") {
  Scene scene = outlier_free_town();
  scene.duration_s = 900.0;
  scene.gnss.latency_s = 0.0;
  scene.gnss.outages = {{400.0, 60.0}};
  const ErrorTrack track = error_track(scene);
  const Coast coast = coasts(scene, track, 5.0).front();
  REQUIRE(coast.coast_s > 1.0);
  CHECK(coast.end_s == 461.0);  // fixes come every second, none at 460 s
  Scene longer = scene;
  longer.gnss.outages = {{400.0, coast.coast_s - 1.0}};
  const Coast met = coasts(longer, track, 5.0).front();
  // Points of the curve are a second apart: 1 % between them on a straight line.
  CHECK(near(met.coast_s, coast.coast_s, 1e-9));
  CHECK(near(met.end_error_m, 5.0, 0.5));
  CHECK(coasts(scene, track, 1e5).front().keeps_limit());
}

}  // namespace leeway::sim
