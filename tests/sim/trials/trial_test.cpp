#include "leeway/sim/trials/trial.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>
#include <string>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/sim/tools/random.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::sim {
namespace {

using test::contains;
using test::message_of;
using test::near;

/// A tactical IMU on the square loop at 20 Hz, fixes every 5 s, white and as the filter believes.
Scene loop_scene(double duration_s) {
  Scene scene;
  scene.name = "loop";
  scene.trajectory = square_loop();
  scene.duration_s = duration_s;
  scene.imu_rate_hz = 20.0;
  set_imu(scene, "tactical/mid", imu_class_model(ImuClass::kTactical, RangeEnd::kMid));
  scene.filter.gnss_correlation_s = 0.0;
  scene.gnss.interval_s = 5.0;
  scene.initial = InitialSigma{0.003, 0.05, 0.05, 2.5};
  return scene;
}

/// Squared errors, when the last fix arrives, of a filter that had the fixes before it and not this
/// one. Run from the start for each such fix; a trial does all of them in one pass.
struct Replayed {
  Eigen::Vector3d error_sq_n_m2{Eigen::Vector3d::Zero()};
  Eigen::Vector3d variance_n_m2{Eigen::Vector3d::Zero()};
  double nees{0.0};
};

Replayed without_last_fix(const Scene& scene, std::uint64_t seed, int last_fix) {
  ImuErrorSimulator sensor(scene.imu, Random(seed, 0, kImuStream));
  GnssSimulator receiver(scene.trajectory, scene.gnss.errors, Random(seed, 0, kGnssStream));
  Estimate start;
  start.nav = truth_at(scene.trajectory, 0.0).nav;
  const ErrorMatrix P = initial_covariance(start, *scene.initial, scene.filter.imu);
  Ekf filter(scene.filter, start, P);
  const double end_s = last_fix * scene.gnss.interval_s + scene.gnss.latency_s;
  int fix = 1;
  for (const ImuIncrement& inc : true_increments(scene.trajectory, scene.imu_rate_hz, end_s)) {
    filter.predict(sensor.measure(inc));
    if (fix == last_fix || to_seconds(inc.time) < fix * scene.gnss.interval_s - 1e-6) continue;
    filter.update(receiver.fix_at(to_seconds(inc.time)));
    ++fix;
  }
  Estimate truth;
  truth.nav = truth_at(scene.trajectory, end_s).nav;
  truth.bias = {sensor.accelerometer_bias_mps2(), sensor.gyro_bias_radps()};
  const ErrorVector x = difference(truth, filter.estimate());
  const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(truth.nav.r_e_m)).transpose();
  const ErrorMatrix covariance = filter.covariance();
  Replayed r;
  r.error_sq_n_m2 = (C_ne * x.segment<3>(kDr)).cwiseAbs2();
  r.variance_n_m2 = (C_ne * covariance.block<3, 3>(kDr, kDr) * C_ne.transpose()).diagonal();
  r.nees = x.dot(covariance.fullPivLu().solve(x));
  return r;
}

}  // namespace

TEST_CASE("the error before a fix is used: at its arrival, by a filter that never had it" *
          doctest::test_suite("heavy")) {
  for (const double latency_s : {0.0, 2.0, 12.0}) {
    CAPTURE(latency_s);
    Scene scene = loop_scene(60.0);
    scene.gnss.latency_s = latency_s;
    scene.initial = InitialSigma{0.0, 0.0, 0.0, 0.0};  // the same start in both
    scene.filter.gate_probability = 0.0;
    const TrialScore score = run_trial(TrialPlan(scene), 1);
    // With 12 s on the way a fix is scored when the one before has arrived: every third.
    const int stride = latency_s > 5.0 ? 3 : 1;
    Replayed sum;
    std::int64_t epochs = 0;
    for (int fix = 1; fix * 5.0 + latency_s <= 60.0; fix += stride) {
      const Replayed r = without_last_fix(scene, 1, fix);
      sum.error_sq_n_m2 += r.error_sq_n_m2;
      sum.variance_n_m2 += r.variance_n_m2;
      sum.nees += r.nees;
      ++epochs;
    }
    CHECK(score.epochs == epochs);
    // Relative, per component: the same arithmetic but for the axes and the inverse.
    CHECK(near((score.error_sq_n_m2.array() / sum.error_sq_n_m2.array()).matrix(),
               Eigen::Vector3d::Ones(), 1e-6));
    CHECK(near((score.variance_n_m2.array() / sum.variance_n_m2.array()).matrix(),
               Eigen::Vector3d::Ones(), 1e-9));
    CHECK(near(score.nees / sum.nees, 1.0, 1e-5));
    CHECK(score.fused == 12);
  }
}

TEST_CASE("only the end of the run is scored, by the arrival of its fixes") {
  Scene scene = loop_scene(100.0);
  CHECK(run_trial(TrialPlan(scene), 1).epochs == 20);
  CHECK(run_trial(TrialPlan(scene, 50.0), 1).epochs == 11);  // from 50 to 100 s
  scene.gnss.latency_s = 1.0;
  CHECK(run_trial(TrialPlan(scene, 50.0), 1).epochs == 10);  // from 51 to 96 s
  CHECK(run_trial(TrialPlan(scene, 48.0), 1).epochs == 9);
}

TEST_CASE("an observer is told the errors that are scored") {
  const TrialPlan plan(loop_scene(100.0));
  double error_sq_m2 = 0.0;
  int beyond = 0;
  const TrialScore score = run_trial(plan, 1, [&](const TrialEpoch& epoch) {
    error_sq_m2 += epoch.error_h_m * epoch.error_h_m;
    beyond += epoch.error_h_m > epoch.claimed_r95_m ? 1 : 0;
  });
  REQUIRE(score.epochs == 20);  // all of them
  // Errors of some metres taken as differences of positions of 6e6 m: a relative 1e-9.
  CHECK(near(error_sq_m2 / score.error_sq_n_m2.head<2>().sum(), 1.0, 1e-6));
  CHECK(beyond == score.beyond_r95);
}

TEST_CASE("fixes in an outage are not there") {
  Scene scene = loop_scene(160.0);
  scene.gnss.outages = {{20.0, 60.0}};  // those at 25 to 80 s
  const TrialScore score = run_trial(TrialPlan(scene, 80.0), 1);
  CHECK(score.fused + score.gated == 20);
  CHECK(score.epochs == 16);
  const TrialScore aided = run_trial(TrialPlan(loop_scene(160.0), 80.0), 1);
  CHECK(aided.epochs == 17);
  CHECK(score.largest_horizontal_m > 2.0 * aided.largest_horizontal_m);
}

TEST_CASE("outliers come as often as told, and the gate refuses them") {
  Scene scene = loop_scene(400.0);
  scene.gnss.interval_s = 1.0;
  scene.gnss.outlier_probability = 0.1;
  scene.gnss.outlier_sigma_m = 1000.0;
  const TrialScore gated = run_trial(TrialPlan(scene), 1);
  // 400 draws: 40 with a deviation of 6. Some of 1000 m per axis may fall inside a gate of 20 m.
  CHECK(gated.gated > 40 - 4 * 6);
  CHECK(gated.gated < 40 + 4 * 6);
  CHECK(gated.gated + gated.fused == 400);
  CHECK(gated.largest_horizontal_m < 10.0);
  scene.filter.gate_probability = 0.0;
  CHECK(run_trial(TrialPlan(scene), 1).largest_horizontal_m > 30.0);
}

TEST_CASE("a filter that is lost is counted as diverged, with its errors") {
  Scene scene = loop_scene(300.0);
  scene.imu.gyro.bias.setConstant(0.01);  // a hundred times what the filter is told
  const TrialScore score = run_trial(TrialPlan(scene), 1);
  CHECK(score.diverged);
  CHECK(score.finite);
  CHECK(score.epochs > 0);
}

TEST_CASE("numbers beyond all bounds end the trial, and it says so") {
  Scene scene = loop_scene(100.0);
  scene.imu.accelerometer.bias.setConstant(1e200);
  scene.filter.gate_probability = 0.0;
  const TrialScore score = run_trial(TrialPlan(scene), 1);
  CHECK(!score.finite);
  CHECK(score.diverged);
}

TEST_CASE("known biases are no error of the start") {
  Scene scene = loop_scene(100.0);
  scene.imu.accelerometer.bias = {0.5, -0.4, 0.3};  // 15 sigma of the turn-on spread
  scene.filter.imu = scene.imu;
  const TrialScore score = run_trial(TrialPlan(scene), 1);
  CHECK(score.gated == 0);
  // Chi-square of 15 degrees in a trial: its mean over correlated epochs stays below 50, which a
  // single epoch exceeds once in 1e5.
  CHECK(score.nees / static_cast<double>(score.epochs) < 50.0);
}

TEST_CASE("a scene that cannot be scored is refused, with the remedy") {
  Scene scene = loop_scene(100.0);
  scene.gnss.outages = {{0.0, 100.0}};
  CHECK(contains(message_of<Error>([&] { TrialPlan{scene}; }), "no fix to score"));
  scene = loop_scene(100.0);
  scene.gnss.interval_s = 0.01;
  CHECK(contains(message_of<Error>([&] { TrialPlan{scene}; }), "raise imu_rate_hz"));
  scene = loop_scene(9.0);
  CHECK(contains(message_of<Error>([&] { TrialPlan{scene}; }), "two GNSS intervals"));
  scene = loop_scene(100.0);
  scene.gnss.latency_s = 98.0;
  CHECK_THROWS_AS(TrialPlan{scene}, Error);
}

}  // namespace leeway::sim
