#include "leeway/sim/analysis/covariance_analysis.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/model/error_metric.hpp"
#include "leeway/model/horizontal.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "tests/support/dense_truth.hpp"

namespace leeway::sim {
namespace {

using Moment = CovariancePoint::Moment;

/// reference/README.md, "Correction interval, a defined case".
Scene defined_case(ImuClass imu, const Trajectory& trajectory) {
  Scene scene;
  scene.name = "defined case";
  scene.trajectory = trajectory;
  scene.duration_s = 14400.0;
  set_imu(scene, std::string(name(imu)), imu_class_model(imu, RangeEnd::kMid));
  scene.filter.gnss_correlation_s = 0.0;
  return scene;
}

/// A short drive with every error there is.
Scene everything_wrong() {
  Scene scene;
  scene.name = "everything wrong";
  scene.trajectory = car_drive();
  scene.duration_s = 240.0;
  ImuErrorModel imu = imu_class_model(ImuClass::kTactical, RangeEnd::kMid);
  imu.accelerometer.in_run = {0.01, 100.0};
  imu.accelerometer.scale_sigma = 2e-3;
  imu.accelerometer.misalignment_sigma_rad = 1e-3;
  imu.gyro.bias_sigma = 0.0;  // the filter's gyro state is then a Gauss-Markov one
  imu.gyro.in_run = {2e-4, 300.0};
  imu.gyro.scale_sigma = 3e-3;
  imu.gyro.misalignment_sigma_rad = 2e-3;
  imu.G_g_sigma_radps_per_mps2 = 1e-6;
  set_imu(scene, "bad", imu);
  scene.filter.imu.gyro.in_run.tau_s = 120.0;  // and of another time constant than the truth
  scene.filter.lever_arm_b_m = {0.5, -0.3, -1.0};
  scene.gnss.errors.lever_arm_b_m = scene.filter.lever_arm_b_m;
  scene.gnss.errors.correlated_sigma_n_m = {1.5, 1.0, 2.0};
  scene.gnss.errors.correlation_time_s = 60.0;
  scene.filter.gnss_correlation_s = 30.0;
  scene.gnss.interval_s = 15.0;
  scene.initial = InitialSigma{0.01, 0.1, 0.2, 3.0};
  return scene;
}

std::vector<CovariancePoint> points_of(const Scene& scene, Moment moment) {
  std::vector<CovariancePoint> points;
  CovarianceConfig config;
  config.observer = [&](const CovariancePoint& p) {
    if (p.moment == moment) points.push_back(p);
  };
  analyze(scene, error_track(scene), config);
  return points;
}

/// Largest relative difference of the standard deviations.
double sigma_difference(const ErrorMatrix& a, const ErrorMatrix& b) {
  return (a.diagonal().cwiseSqrt().array() / b.diagonal().cwiseSqrt().array() - 1.0)
      .abs()
      .maxCoeff();
}

Estimate start_of(const Scene& scene) {
  Estimate start;
  start.nav = truth_at(scene.trajectory, 0.0).nav;
  return start;
}

}  // namespace

TEST_CASE("the defined case: every cell of the reference's marine and tactical rows within 2 %" *
          doctest::test_suite("heavy")) {
  constexpr std::array kIntervalsS{0.1, 1.0, 10.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1200.0};
  struct Row {
    ImuClass imu;
    std::array<double, 9> drms_m;
  };
  for (const Row& row :
       {Row{ImuClass::kMarine, {.150, .442, 1.28, 2.17, 3.15, 4.85, 10.6, 27.2, 95.7}},
        Row{ImuClass::kTactical, {.158, .505, 1.77, 4.15, 10.3, 39.7, 320, 1760, 9120}}}) {
    Scene scene = defined_case(row.imu, square_loop());
    const ErrorTrack track = error_track(scene);
    for (std::size_t i = 0; i < kIntervalsS.size(); ++i) {
      scene.gnss.interval_s = kIntervalsS[i];
      const CovarianceAnalysis r = analyze(scene, track);
      CAPTURE(name(row.imu));
      CAPTURE(kIntervalsS[i]);
      CHECK(std::abs(r.true_m / row.drms_m[i] - 1.0) < 0.02);
      CHECK(r.claimed_m == r.true_m);  // the filter knows all there is
    }
  }
}

TEST_CASE("the error per axis tends to sqrt(2.5 * 0.05 T) for short intervals" *
          doctest::test_suite("heavy")) {
  for (const ImuClass imu : {ImuClass::kMarine, ImuClass::kTactical}) {
    Scene scene = defined_case(imu, square_loop());
    scene.limit.metric = ErrorMetric::kAxis;
    scene.gnss.interval_s = 0.1;
    scene.duration_s = 7200.0;
    const double limit_m = std::sqrt(2.5 * 0.05 * 0.1);
    // The noise of the sensors and their biases, not yet fully known, add to the limit.
    const double true_m = analyze(scene, error_track(scene)).true_m;
    CHECK(true_m > 0.95 * limit_m);
    CHECK(true_m < 1.05 * limit_m);
  }
}

TEST_CASE("along and across the track by hand, on a circle that turns through every course") {
  Scene scene = defined_case(ImuClass::kTactical, circle({.radius_m = 300.0, .duration_s = 600.0}));
  scene.duration_s = 600.0;
  scene.gnss.interval_s = 25.0;
  const ErrorTrack track = error_track(scene);
  for (const ErrorMetric metric : {ErrorMetric::kAlong95, ErrorMetric::kCross95}) {
    CAPTURE(name(metric));
    scene.limit.metric = metric;
    scene.limit.last_s = 300.0;
    double largest_m = 0.0;
    double least_north = 1.0;
    CovarianceConfig config;
    config.observer = [&](const CovariancePoint& p) {
      if (p.moment != Moment::kBeforeFix || p.t_s < 300.0) return;  // that at 300 s counts
      const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(p.r_e_m)).transpose();
      const Eigen::Vector3d v_n = C_ne * truth_at(scene.trajectory, p.t_s).nav.v_e_mps;
      Eigen::Vector3d along_n(v_n.x(), v_n.y(), 0.0);
      along_n.normalize();
      least_north = std::min(least_north, along_n.x());
      const Eigen::Vector3d axis_n = metric == ErrorMetric::kAlong95
                                         ? along_n
                                         : Eigen::Vector3d(-along_n.y(), along_n.x(), 0.0);
      const Eigen::Matrix3d P = C_ne * p.truth.block<3, 3>(kDr, kDr) * C_ne.transpose();
      largest_m = std::max(largest_m, 1.959963985 * std::sqrt(axis_n.dot(P * axis_n)));
    };
    const CovarianceAnalysis r = analyze(scene, track, config);
    // Rounding: of a vehicle that moves the course is that of the truth, not of the path's pieces.
    CHECK(std::abs(r.true_m / largest_m - 1.0) < 1e-9);
    CHECK(least_north < -0.8);  // the course has turned
  }
}

TEST_CASE("free inertial at rest: the reference's 1237 s and 67 s to 100 m") {
  struct Row {
    ImuClass imu;
    double time_s;
  };
  for (const Row& row : {Row{ImuClass::kMarine, 1237.0}, Row{ImuClass::kTactical, 67.0}}) {
    const Scene scene = defined_case(row.imu, static_trajectory({.duration_s = 14400.0}));
    double reached_s = 0.0;
    free_inertial(scene, error_track(scene), [&](const CovariancePoint& p) {
      reached_s = p.t_s;
      return horizontal_covariance(p.r_e_m, p.truth.block<3, 3>(kDr, kDr)).trace() < 1e4;
    });
    // To the second, as the steps are one and the reference's figures are rounded to one.
    CHECK(std::abs(reached_s - row.time_s) <= 1.5);
  }
}

TEST_CASE("the claimed covariance is the one that the filter itself computes") {
  Scene scene = everything_wrong();
  const auto points = points_of(scene, Moment::kBeforeFix);
  Ekf filter(scene.filter, start_of(scene),
             initial_covariance(start_of(scene), initial_sigma(scene), scene.filter.imu));
  GnssErrorModel silent = scene.gnss.errors;
  std::size_t fix = 0;
  for (const ImuIncrement& inc : true_increments(scene.trajectory, 100.0, scene.duration_s)) {
    filter.predict(inc);
    if (fix == points.size() || to_seconds(inc.time) < points[fix].t_s - 1e-6) continue;
    CAPTURE(points[fix].t_s);
    // The filter linearizes about increments of 10 ms, the track about the middles of 100 ms.
    // Of the motion it takes the mean over a leg.
    CHECK(sigma_difference(points[fix].claimed, filter.covariance()) < 3e-3);
    const TruthPoint truth = truth_at(scene.trajectory, points[fix].t_s);
    const Geodetic place = geodetic_from_ecef(truth.nav.r_e_m);
    const Eigen::Vector3d position_sigma_n_m =
        (silent.position_sigma_n_m.cwiseAbs2() + silent.correlated_sigma_n_m.cwiseAbs2())
            .cwiseSqrt();
    const Eigen::Matrix3d C_en = ned_to_ecef(place);
    Estimate estimate = filter.estimate();
    GnssFix exact;
    exact.time = inc.time;
    exact.position =
        GnssPosition{antenna_position_e(estimate, scene.filter.lever_arm_b_m),
                     C_en * position_sigma_n_m.cwiseAbs2().asDiagonal() * C_en.transpose()};
    exact.velocity = GnssVelocity{
        antenna_velocity_e(estimate, scene.filter.lever_arm_b_m, inc.dtheta_b_rad / inc.dt_s),
        C_en * silent.velocity_sigma_n_mps.cwiseAbs2().asDiagonal() * C_en.transpose()};
    filter.update(exact);
    ++fix;
  }
  CHECK(fix == points.size());
  CHECK(fix == 16);
}

TEST_CASE("the true covariance agrees with one dense covariance of 51 states" *
          doctest::test_suite("heavy")) {
  Scene scene = everything_wrong();
  // The reference knows no noise that follows the motion.
  for (TriadErrorModel* triad : {&scene.filter.imu.accelerometer, &scene.filter.imu.gyro}) {
    triad->scale_sigma = triad->misalignment_sigma_rad = 0.0;
  }
  scene.filter.imu.G_g_sigma_radps_per_mps2 = 0.0;
  const auto points = points_of(scene, Moment::kBeforeFix);
  test::DenseTruth reference(
      scene, initial_covariance(start_of(scene), initial_sigma(scene), scene.filter.imu));
  constexpr double kStepS = 0.1;
  double t_s = 0.0;
  for (const CovariancePoint& point : points) {
    for (; t_s < point.t_s - 1e-6; t_s += kStepS) reference.propagate(t_s, kStepS);
    CAPTURE(point.t_s);
    // Both are second order in their steps; the filter is far from the truth (below).
    CHECK(sigma_difference(point.claimed, reference.claimed()) < 3e-3);
    CHECK(sigma_difference(point.truth, reference.truth()) < 3e-3);
    reference.update(point.t_s);
  }
  CHECK(sigma_difference(points.back().truth, points.back().claimed) > 0.3);
}

TEST_CASE("the budget adds up to the true error, and each source to what it does alone") {
  Scene scene = everything_wrong();
  const ErrorTrack track = error_track(scene);
  CovarianceConfig config;
  const CovarianceAnalysis whole = analyze(scene, track, config);
  config.by_source = true;
  const CovarianceAnalysis split = analyze(scene, track, config);
  const auto horizontal = [](const ErrorBudgetLine& line) {
    return line.mean_sq_n_m2.topLeftCorner<2, 2>().trace();
  };
  double sum_m2 = 0.0;
  for (const ErrorBudgetLine& line : split.error_budget) {
    CAPTURE(name(line.source));
    CHECK(horizontal(line) >= 0.0);
    sum_m2 += horizontal(line);
  }
  CHECK(std::abs(std::sqrt(sum_m2) / split.true_m - 1.0) < 1e-12);
  CHECK(std::abs(split.true_m / whole.true_m - 1.0) < 1e-9);

  // Without its misalignment, the truth lacks exactly that line.
  scene.imu.accelerometer.misalignment_sigma_rad = 0.0;
  CovarianceAnalysis without;
  const double at_s = split.worst_s;
  config = {};
  double rest_m2 = 0.0;
  config.observer = [&](const CovariancePoint& p) {
    if (p.moment != Moment::kBeforeFix || p.t_s != at_s) return;
    rest_m2 = horizontal_covariance(p.r_e_m, p.truth.block<3, 3>(kDr, kDr)).trace();
  };
  without = analyze(scene, track, config);
  for (const ErrorBudgetLine& line : split.error_budget) {
    if (line.source != ErrorSource::kAccelerometerMisalignment) continue;
    CHECK(horizontal(line) > 0.005 * sum_m2);
    CHECK(std::abs((sum_m2 - rest_m2) / horizontal(line) - 1.0) < 1e-6);
  }
}

TEST_CASE("a known constant error counts with its square") {
  Scene scene = defined_case(ImuClass::kTactical, static_trajectory({.duration_s = 600.0}));
  scene.duration_s = 600.0;
  scene.imu = ImuErrorModel{};
  scene.imu.accelerometer.bias = {1e-2, 0.0, 0.0};
  scene.initial = InitialSigma{};
  double north_m = 0.0;
  free_inertial(scene, error_track(scene), [&](const CovariancePoint& p) {
    north_m = std::sqrt(horizontal_covariance(p.r_e_m, p.truth.block<3, 3>(kDr, kDr))(0, 0));
    return p.t_s < 60.0;
  });
  // b t^2 / 2; the Earth's terms take 1 - (w t)^2 / 12 of it, with w = 1.24e-3 rad/s: 5e-4.
  CHECK(std::abs(north_m / 18.0 - 1.0) < 1e-3);
}

TEST_CASE("with latency the error that counts is that at the arrival of a fix") {
  Scene scene = defined_case(ImuClass::kTactical, square_loop());
  scene.duration_s = 600.0;
  scene.gnss.interval_s = 10.0;
  const auto prompt = points_of(scene, Moment::kBeforeFix);
  scene.gnss.latency_s = 2.0;
  const auto late = points_of(scene, Moment::kBeforeFix);
  REQUIRE(late.size() == prompt.size() - 1);  // the last one would come after the end
  Scene withheld = scene;
  withheld.gnss.latency_s = 0.0;
  withheld.gnss.outages = {{late[20].t_s - 2.5, 1.0}};
  // Without the fix, 2 s after its time: what free running gives. Seen at the next step.
  double expected_m = 0.0;
  CovarianceConfig config;
  config.observer = [&](const CovariancePoint& p) {
    if (std::abs(p.t_s - late[20].t_s) > 1e-6) return;
    expected_m = std::sqrt(horizontal_covariance(p.r_e_m, p.claimed.block<3, 3>(kDr, kDr)).trace());
  };
  analyze(withheld, error_track(withheld), config);
  const auto& p = late[20];
  const double late_m =
      std::sqrt(horizontal_covariance(p.r_e_m, p.claimed.block<3, 3>(kDr, kDr)).trace());
  CHECK(std::abs(late_m - expected_m) < 1e-9);
  CHECK(late_m > 1.05 * std::sqrt(horizontal_covariance(prompt[20].r_e_m,
                                                        prompt[20].claimed.block<3, 3>(kDr, kDr))
                                      .trace()));
}

TEST_CASE("drifting biases settle, constant ones are still being learnt after four hours") {
  Scene scene = defined_case(ImuClass::kTactical, square_loop());
  scene.gnss.interval_s = 10.0;
  CovarianceAnalysis r = analyze(scene, error_track(scene));
  CHECK(!r.settled);
  CHECK(r.settled_s == 14400.0);
  ImuErrorModel drifting = scene.imu;
  drifting.accelerometer.in_run = {drifting.accelerometer.bias_sigma, 600.0};
  drifting.accelerometer.bias_sigma = 0.0;
  drifting.gyro.in_run = {drifting.gyro.bias_sigma, 600.0};
  drifting.gyro.bias_sigma = 0.0;
  set_imu(scene, "drifting", drifting);
  r = analyze(scene, error_track(scene));
  CHECK(r.settled);
  CHECK(r.settled_s < 10000.0);
}

TEST_CASE("a scene that ends without fixes is refused with what to do") {
  Scene scene = defined_case(ImuClass::kTactical, square_loop());
  scene.gnss.outages = {{10000.0, 4400.0}};
  CHECK_THROWS_WITH_AS(analyze(scene, error_track(scene)),
                       doctest::Contains("shorten the fix interval or move the outages"), Error);
}

}  // namespace leeway::sim
