#include "leeway/sim/analysis/roofline.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>

#include "leeway/earth/error.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "leeway/sim/analysis/interval.hpp"
#include "leeway/sim/motion/trajectories.hpp"

namespace leeway::sim {
namespace {

/// At rest, with fixes and sensors that are as good as exact.
Scene exact_scene(double interval_s) {
  Scene scene;
  scene.name = "one source";
  scene.trajectory = static_trajectory({.duration_s = 14400.0});
  scene.duration_s = 7200.0;
  scene.gnss.interval_s = interval_s;
  scene.gnss.errors.position_sigma_n_m.setConstant(1e-3);
  scene.gnss.errors.velocity_sigma_n_mps.setConstant(1e-5);
  ImuErrorModel imu;
  imu.accelerometer.noise_density = 1e-9;
  imu.gyro.noise_density = 1e-12;
  set_imu(scene, "exact", imu);
  scene.filter.gnss_correlation_s = 0.0;
  return scene;
}

void set_believed(Scene& scene) { scene.filter.imu = scene.imu; }

/// The line over the error of the stepping analysis.
double ratio(const Scene& scene, RooflineTerm term) {
  const double exact_m = analyze(scene, error_track(scene)).true_m;
  return Roofline(scene).error_m(term, scene.gnss.interval_s) / exact_m;
}

/// Position variance before a fix, in steady state: unit white noise into the last of n
/// integrators, position and velocity exact at fixes that are one unit of time apart.
double riccati(int n) {
  const auto factorial = [](int k) { return std::tgamma(k + 1.0); };
  Eigen::MatrixXd Phi = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd Q(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      if (j >= i) Phi(i, j) = 1.0 / factorial(j - i);
      const int a = n - 1 - i;
      const int b = n - 1 - j;
      Q(i, j) = 1.0 / (factorial(a) * factorial(b) * (a + b + 1));
    }
  }
  Eigen::MatrixXd before = Q;
  for (int k = 0; k < 300; ++k) {
    const Eigen::MatrixXd seen = before.leftCols(2);
    Eigen::MatrixXd P = before - seen * before.topLeftCorner(2, 2).inverse() * seen.transpose();
    P.topRows(2).setZero();
    P.leftCols(2).setZero();
    before = Phi * (0.5 * (P + P.transpose())) * Phi.transpose() + Q;
  }
  return before(0, 0);
}

}  // namespace

TEST_CASE("roofline: the constants are the steady states of the Riccati recursion") {
  CHECK(std::abs(riccati(2) - 1.0 / 3.0) < 1e-12);
  CHECK(std::abs(riccati(3) - kThreeIntegrators) < 1e-11);
  CHECK(std::abs(kThreeIntegrators - (1.0 / 20.0 + std::sqrt(2.0) / 48.0)) < 1e-11);
  CHECK(std::abs(riccati(4) - kFourIntegrators) < 1e-11);
}

TEST_CASE("roofline: each line of the sensors against the stepping analysis, within 2 %") {
  // What is left: fixes that are not quite exact, drift that is not quite a random walk.
  for (const double interval_s : {20.0, 60.0}) {
    CAPTURE(interval_s);
    const auto one = [&](RooflineTerm term, auto&& add) {
      Scene scene = exact_scene(interval_s);
      add(scene.imu);
      set_believed(scene);
      return ratio(scene, term);
    };
    const double velocity_walk = one(RooflineTerm::kAccelerometerNoise, [](ImuErrorModel& imu) {
      imu.accelerometer.noise_density = 1e-3;
    });
    const double angular_walk =
        one(RooflineTerm::kGyroNoise, [](ImuErrorModel& imu) { imu.gyro.noise_density = 1e-5; });
    const double accelerometer_drift =
        one(RooflineTerm::kAccelerometerDrift, [](ImuErrorModel& imu) {
          imu.accelerometer.in_run = {1.0, 1e5};
        });
    const double gyro_drift = one(RooflineTerm::kGyroDrift, [](ImuErrorModel& imu) {
      imu.gyro.in_run = {1e-3, 1e5};
    });
    CHECK(std::abs(velocity_walk - 1.0) < 0.02);
    CHECK(std::abs(angular_walk - 1.0) < 0.02);
    CHECK(std::abs(accelerometer_drift - 1.0) < 0.02);
    CHECK(std::abs(gyro_drift - 1.0) < 0.02);
  }
}

TEST_CASE("roofline: drift of a time shorter than the interval is not learnt, within 20 %") {
  // It is over before the interval is: less than the line has.
  Scene scene = exact_scene(100.0);
  scene.imu.gyro.in_run = {1e-5, 20.0};
  set_believed(scene);
  const double gyro_drift = ratio(scene, RooflineTerm::kGyroDrift);
  CHECK(gyro_drift > 1.0);
  CHECK(gyro_drift < 1.2);
}

TEST_CASE("roofline: fix noise against the stepping analysis, within 5 %") {
  Scene scene = exact_scene(1.0);
  scene.gnss.errors.position_sigma_n_m.setConstant(2.5);
  scene.gnss.errors.velocity_sigma_n_mps.setConstant(0.05);
  scene.imu.accelerometer.noise_density = 0.02;
  set_believed(scene);
  const double position = ratio(scene, RooflineTerm::kFixPosition);
  scene.gnss.errors.position_sigma_n_m.setConstant(1e-3);
  scene.gnss.interval_s = 100.0;
  scene.imu.accelerometer.noise_density = 0.2;  // loses far more than a fix errs by
  set_believed(scene);
  CovarianceConfig by_source;
  by_source.by_source = true;
  const auto velocity_part = [&] {
    for (const auto& line : analyze(scene, error_track(scene), by_source).error_budget) {
      if (line.source != ErrorSource::kGnssVelocity) continue;
      return std::sqrt(line.mean_sq_n_m2(0, 0) + line.mean_sq_n_m2(1, 1));
    }
    return 0.0;
  };
  scene.gnss.errors.velocity_sigma_n_mps.setConstant(0.05);
  const double velocity =
      Roofline(scene).error_m(RooflineTerm::kFixVelocity, 100.0) / velocity_part();
  scene.gnss.interval_s = 1.0;
  scene.imu.accelerometer.noise_density = 0.02;
  set_believed(scene);
  scene.gnss.errors.correlated_sigma_n_m.setConstant(3.0);
  scene.gnss.errors.correlation_time_s = 60.0;
  scene.filter.gnss_correlation_s = 60.0;
  const double correlated = ratio(scene, RooflineTerm::kFixCorrelated);
  CHECK(std::abs(position - 1.0) < 0.05);
  CHECK(std::abs(velocity - 1.0) < 0.05);
  CHECK(std::abs(correlated - 1.0) < 0.05);
}

TEST_CASE("roofline: what is left of turn-on biases, within 6 %") {
  Scene scene = exact_scene(60.0);
  scene.gnss.errors.position_sigma_n_m.setConstant(1.0);
  scene.gnss.errors.velocity_sigma_n_mps.setConstant(0.01);
  scene.imu.gyro.noise_density = 5e-5;
  scene.imu.gyro.bias_sigma = 1e-4;
  scene.imu.accelerometer.noise_density = 1e-3;
  scene.imu.accelerometer.bias_sigma = 1e-2;
  set_believed(scene);
  const CovarianceAnalysis analysis = analyze(scene, error_track(scene));
  const Roofline roofline(scene);
  const double gyro = roofline.error_m(RooflineTerm::kGyroBias, 60.0) / std::sqrt(2.0) /
                      (9.80665 * std::pow(60.0, 3) / 6.0);
  const double accelerometer =
      roofline.error_m(RooflineTerm::kAccelerometerBias, 60.0) / std::sqrt(2.0) / 1800.0;
  const auto sigma = [&](int row) { return std::sqrt(analysis.worst.truth(row, row)); };
  // At rest the bias of the east gyro hides behind the heading, those of the level accelerometers
  // behind the tilt: they stay, and so does what they hide behind.
  CHECK(std::abs(gyro / sigma(kBg) - 1.0) < 0.06);
  CHECK(std::abs(accelerometer / sigma(kBa + 2) - 1.0) < 0.06);
}

TEST_CASE("roofline: lines rise, the sum is above the roof, and crossings meet the limit") {
  Scene scene = exact_scene(1.0);
  set_imu(scene, "automotive-mems", automotive_mems_model());
  scene.gnss.errors.position_sigma_n_m.setConstant(2.5);
  scene.gnss.errors.velocity_sigma_n_mps.setConstant(0.05);
  const Roofline roofline(scene);
  double before_m = 0.0;
  for (double T = 0.1; T < 3000.0; T *= 1.3) {
    CAPTURE(T);
    CHECK(roofline.roof_m(T) >= before_m);
    CHECK(roofline.sum_m(T) >= roofline.roof_m(T));
    CHECK(roofline.sum_m(T) <= 3.0 * roofline.roof_m(T));  // nine lines
    before_m = roofline.roof_m(T);
  }
  for (const double limit_m : {1.0, 10.0, 100.0}) {
    CHECK(std::abs(roofline.roof_m(roofline.interval_s(limit_m)) / limit_m - 1.0) < 1e-6);
    CHECK(std::abs(roofline.sum_m(roofline.sum_interval_s(limit_m)) / limit_m - 1.0) < 1e-6);
    CHECK(roofline.sum_interval_s(limit_m) <= roofline.interval_s(limit_m));
  }
  CHECK(std::isnan(roofline.interval_s(1e-9)));
  scene.limit.limit_m = -1.0;
  CHECK_THROWS_AS(Roofline{scene}, Error);
}

TEST_CASE("roofline: none for heights and for limits that grow with the way") {
  // 2026-12: lines of a horizontal error stood beside answers of either.
  Scene scene = exact_scene(1.0);
  set_imu(scene, "automotive-mems", automotive_mems_model());
  scene.limit.metric = ErrorMetric::kVertical95;
  CHECK(std::isnan(Roofline(scene).interval_s(10.0)));
  scene.limit.metric = ErrorMetric::kCross95;
  CHECK(Roofline(scene).interval_s(10.0) > 1.0);
  scene.limit.share = 0.05;
  CHECK(std::isnan(Roofline(scene).interval_s(10.0)));
}

TEST_CASE("roofline: intervals by the least crossing against solve_intervals(), at rest" *
          doctest::test_suite("heavy")) {
  // The table of docs/theory/analysis/roofline.md: an interval where two lines meet is the worst.
  struct Row {
    ImuClass imu;
    double limit_m;
    double roof_within;
    double sum_within;
  };
  Scene scene = exact_scene(1.0);
  scene.gnss.errors = GnssErrorModel{};
  scene.duration_s = 14400.0;
  for (const Row& row :
       {Row{ImuClass::kTactical, 1.0, 0.10, 0.10}, Row{ImuClass::kTactical, 3.0, 0.75, 0.20},
        Row{ImuClass::kTactical, 10.0, 0.32, 0.20}, Row{ImuClass::kTactical, 30.0, 0.15, 0.12},
        Row{ImuClass::kTactical, 100.0, 0.05, 0.05}, Row{ImuClass::kAutomotive, 10.0, 0.16, 0.11},
        Row{ImuClass::kAutomotive, 100.0, 0.03, 0.03}}) {
    set_imu(scene, "class", imu_class_model(row.imu, RangeEnd::kMid));
    const double exact_s = solve_intervals(scene, {row.limit_m}).front().interval_s;
    const Roofline roofline(scene);
    CAPTURE(name(row.imu));
    CAPTURE(row.limit_m);
    CHECK(std::abs(roofline.interval_s(row.limit_m) / exact_s - 1.0) < row.roof_within);
    CHECK(std::abs(roofline.sum_interval_s(row.limit_m) / exact_s - 1.0) < row.sum_within);
  }
}

}  // namespace leeway::sim
