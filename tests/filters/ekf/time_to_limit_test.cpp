#include "leeway/ekf/time_to_limit.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/navigator/navigator.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "tests/filters/ekf/settled.hpp"
#include "tests/support/near.hpp"
#include "tests/support/numbers.hpp"

namespace leeway {
namespace {

using test::coast;
using test::Coast;
using test::metric;
using test::near;
using test::present;
using test::radius;
using test::Settled;

using test::kInf;
using test::kNan;

/// A filter that starts where the trajectory does, and what it will measure.
Settled started(const sim::Trajectory& trajectory, const ImuErrorModel& imu, const ErrorMatrix& P,
                double ahead_s, double rate_hz) {
  EkfConfig config;
  config.imu = imu;
  config.covariance_interval_s = 0.0;
  const auto increments = sim::true_increments(trajectory, rate_hz, ahead_s);
  Ekf filter(config, test::truth_estimate(trajectory, 0.0), P);
  filter.predict(increments[0]);  // so that it knows how it turns
  return {filter, {increments.begin() + 1, increments.end()}};
}

ImuErrorModel gauss_markov_model() {
  ImuErrorModel model = imu_class_model(ImuClass::kTactical, RangeEnd::kMid);
  model.accelerometer.bias_sigma = 0.0;
  model.accelerometer.in_run = {0.03, 30.0};
  model.gyro.bias_sigma = 0.0;
  model.gyro.in_run = {5e-6, 60.0};
  return model;
}

}  // namespace

TEST_CASE("leeway against coasting the same filter: motions, sensors, limits, metrics" *
          doctest::test_suite("heavy")) {
  struct Motion {
    const char* name{};
    sim::Trajectory trajectory{};
  };
  constexpr double kSettleS = 120.0;
  constexpr double kAheadS = 400.0;
  const std::array motions{
      Motion{"static", sim::static_trajectory()}, Motion{"straight", sim::straight()},
      Motion{"circle of 30 m", sim::circle({.radius_m = 30.0, .speed_mps = 10.0})},
      Motion{"circle of 1 km", sim::circle({.radius_m = 1000.0})}};
  const std::array sensors{imu_class_model(ImuClass::kMarine, RangeEnd::kMid),
                           imu_class_model(ImuClass::kTactical, RangeEnd::kMid),
                           imu_class_model(ImuClass::kAutomotive, RangeEnd::kMid),
                           automotive_mems_model(), gauss_markov_model()};
  double worst = 0.0;
  for (const Motion& motion : motions) {
    for (std::size_t sensor = 0; sensor < sensors.size(); ++sensor) {
      CAPTURE(motion.name);
      CAPTURE(sensor);
      const Settled run =
          test::settled(motion.trajectory, sensors[sensor], kSettleS, kAheadS, 10.0);
      const auto check = [&](const Coast& ahead, const TimeToLimit& leeway, double limit_m) {
        CAPTURE(limit_m);
        const double coasted_s = ahead.first_crossing_s(limit_m);
        if (std::isnan(coasted_s)) {
          CHECK(leeway.time_s > 0.99 * kAheadS);
          return;
        }
        worst = std::max(worst, std::abs(leeway.time_s / coasted_s - 1.0));
        CHECK(near(leeway.time_s, coasted_s, 0.005 * coasted_s));
        CHECK_FALSE(leeway.beyond_horizon);
      };
      const Coast ahead = coast(run, radius(0.95));
      for (const double multiple : {1.2, 3.0, 20.0, 200.0}) {
        const double limit_m = multiple * ahead.size_m[0];
        check(ahead, time_to_limit(run.filter, limit_m), limit_m);
      }
      for (const ErrorMetric which : kAll<ErrorMetric>) {
        const double limit_m = 5.0 * present(run.filter, metric(which));
        check(coast(run, metric(which)), time_to_limit(run.filter, limit_m, which), limit_m);
      }
    }
  }
  MESSAGE("worst relative difference from coasting: " << worst);
}

TEST_CASE("leeway on the road: what was answered against what then came, bends and stops included" *
          doctest::test_suite("heavy")) {
  const sim::Trajectory trajectory = sim::car_drive({.duration_s = 1250.0});
  const auto truth = sim::true_increments(trajectory, 100.0, 1200.0);
  for (const ImuErrorModel& imu :
       {automotive_mems_model(), imu_class_model(ImuClass::kAutomotive, RangeEnd::kMid),
        imu_class_model(ImuClass::kTactical, RangeEnd::kMid)}) {
    EkfConfig config;
    config.imu = imu;
    const auto log = test::record(trajectory, truth, imu, {}, 1.0, 1.0, 1);
    const Estimate start = test::truth_estimate(trajectory, 0.0);
    Ekf filter(config, start, initial_covariance(start, {0.01, 0.02, 0.1, 3.0}, imu));
    std::vector<double> ratios;
    for (std::size_t k = 0; k < 110'000; ++k) {
      filter.predict(log.imu[k]);
      if (k % 100 == 99) filter.update(log.fixes[k / 100]);
      if (k < 20'000 || k % 1000 != 550) continue;
      const auto next = log.imu.begin() + static_cast<std::ptrdiff_t>(k) + 1;
      const Settled run{filter, {next, std::min(next + 10'000, log.imu.end())}};
      const double came_s = coast(run, radius(0.95), 10).first_crossing_s(5.0);
      if (came_s > 0.5) ratios.push_back(time_to_limit(filter, 5.0).time_s / came_s);
    }
    std::sort(ratios.begin(), ratios.end());
    const std::size_t n = ratios.size();
    MESSAGE("answered / came, " << n << " questions: median " << ratios[n / 2] << ", 5 % "
                                << ratios[n / 20] << ", 95 % " << ratios[n * 19 / 20]);
    CHECK(n == 90);
    // The motion does change: this is what a steady motion is worth as a forecast.
    CHECK(near(ratios[n / 2], 1.0, 0.03));
    CHECK(ratios[n / 20] > 0.9);
    CHECK(ratios[n * 19 / 20] < 1.2);
  }
}

TEST_CASE("leeway of milliseconds and of hours" * doctest::test_suite("heavy")) {
  const sim::Trajectory trajectory = sim::static_trajectory({.duration_s = 8000.0});
  SUBCASE("a velocity error alone: t = sqrt((limit / 2.4477)^2 - sigma_r^2) / sigma_v") {
    for (const double sigma_mps : {1e-2, 1.0, 1e3}) {
      CAPTURE(sigma_mps);
      ErrorMatrix P = ErrorMatrix::Zero();
      P.diagonal().segment<3>(kDv).setConstant(sigma_mps * sigma_mps);
      P.diagonal().segment<3>(kDr).setConstant(0.01);
      const Settled run = started(trajectory, ImuErrorModel{}, P, 0.002, 1000.0);
      const double sigma_limit_m = 1.0 / std::sqrt(-2.0 * std::log(0.05));
      const double expected_s = std::sqrt(sigma_limit_m * sigma_limit_m - 0.01) / sigma_mps;
      // The prediction has used 1 ms of it. Gravity bends the line by (t / 806 s)^2.
      CHECK(near(time_to_limit(run.filter, 1.0).time_s, std::max(expected_s - 1e-3, 0.0),
                 0.005 * expected_s));
    }
  }
  SUBCASE("a marine IMU at rest: an hour and more") {
    ErrorMatrix P = ErrorMatrix::Zero();
    P.diagonal().segment<3>(kBa).setConstant(1e-12);
    P.diagonal().segment<3>(kBg).setConstant(2.5e-17);
    const Settled run = started(trajectory, ImuErrorModel{}, P, 6000.0, 2.0);
    const Coast ahead = coast(run, radius(0.95), 20);
    for (const double limit_m : {3.0, 30.0, 100.0}) {
      CAPTURE(limit_m);
      const double coasted_s = ahead.first_crossing_s(limit_m);
      CHECK(coasted_s > 300.0);
      CHECK(near(time_to_limit(run.filter, limit_m).time_s, coasted_s, 0.005 * coasted_s));
    }
  }
}

TEST_CASE("leeway is the first crossing where the error grows and shrinks" *
          doctest::test_suite("heavy")) {
  SUBCASE("a tilt, over a Schuler period") {
    const sim::Trajectory trajectory = sim::static_trajectory({.duration_s = 5000.0});
    const Eigen::Vector3d north_e = ned_to_ecef(trajectory.plane.origin).col(0);
    ErrorMatrix P = ErrorMatrix::Zero();
    P.block<3, 3>(kPsi, kPsi) = 1e-10 * north_e * north_e.transpose();
    const Settled run = started(trajectory, ImuErrorModel{}, P, 4800.0, 2.0);
    const Coast ahead = coast(run, radius(0.95), 10);
    const double peak_m = *std::max_element(ahead.size_m.begin(), ahead.size_m.end());
    // R psi (1 - cos(t / 806 s)): 2 R psi at its largest, 1.96 sigma.
    CHECK(near(peak_m, 1.96 * 2.0 * 6.38e6 * 1e-5, 0.05 * peak_m));
    CHECK(ahead.size_m.back() < 0.89 * peak_m);
    for (const double share : {0.3, 0.6, 0.9}) {
      CAPTURE(share);
      const double coasted_s = ahead.first_crossing_s(share * peak_m);
      CHECK(near(time_to_limit(run.filter, share * peak_m).time_s, coasted_s, 0.01 * coasted_s));
    }
  }
  SUBCASE("a heading error that the velocity error undoes once a turn") {
    // dv = -psi x v: the velocity is that of the turned vehicle, so the path comes back.
    const sim::Trajectory trajectory = sim::circle({.radius_m = 100.0, .speed_mps = 20.0});
    const Estimate start = test::truth_estimate(trajectory, 0.0);
    ErrorVector x = ErrorVector::Zero();
    x.segment<3>(kPsi) = 0.1 * ned_to_ecef(trajectory.plane.origin).col(2);
    x.segment<3>(kDv) = x.segment<3>(kPsi).cross(start.nav.v_e_mps);
    const Settled run = started(trajectory, ImuErrorModel{}, x * x.transpose(), 31.0, 50.0);
    const Coast ahead = coast(run, radius(0.95));
    const double peak_m = *std::max_element(ahead.size_m.begin(), ahead.size_m.end());
    CHECK(near(peak_m, 1.96 * 0.1 * 200.0, 0.1));  // the diameter, turned
    CHECK(ahead.size_m.back() < 0.1 * peak_m);
    for (const double share : {0.2, 0.6, 0.9}) {
      CAPTURE(share);
      const double coasted_s = ahead.first_crossing_s(share * peak_m);
      CHECK(near(time_to_limit(run.filter, share * peak_m).time_s, coasted_s, 0.01 * coasted_s));
    }
  }
}

TEST_CASE("leeway grows with the limit and shrinks with the probability") {
  const Ekf filter = test::settled(sim::straight(), automotive_mems_model(), 60.0, 0.1).filter;
  double last_s = 0.0;
  for (int k = 0; k < 55; ++k) {
    const double limit_m = 0.5 * std::pow(1.3, k);  // to 700 km
    CAPTURE(limit_m);
    const double leeway_s = time_to_limit(filter, limit_m).time_s;
    CHECK(leeway_s >= last_s);
    last_s = leeway_s;
  }
  last_s = kInf;
  for (const double probability : {0.5, 0.9, 0.95, 0.99, 0.9999}) {
    CAPTURE(probability);
    const double leeway_s = time_to_limit(filter, 10.0, probability).time_s;
    CHECK(leeway_s < last_s);
    last_s = leeway_s;
  }
}

TEST_CASE("leeway: same inputs, same bits; the filter is left as it was") {
  const Ekf filter = test::settled(sim::circle(), automotive_mems_model(), 60.0, 0.1).filter;
  const ErrorMatrix before = filter.covariance();
  const TimeToLimit once = time_to_limit(filter, 7.0);
  const TimeToLimit again = time_to_limit(Ekf(filter), 7.0);
  CHECK(once.time_s == again.time_s);
  CHECK(filter.covariance() == before);
}

TEST_CASE("leeway: outcomes where there is no answer") {
  const Settled run = test::settled(sim::straight(), automotive_mems_model(), 60.0, 0.1);
  const double now_m = present(run.filter, radius(0.95));
  const auto is_zero = [](const TimeToLimit& leeway) {
    return leeway.time_s == 0.0 && !leeway.beyond_horizon;
  };
  CHECK(is_zero(time_to_limit(run.filter, 0.999 * now_m)));
  CHECK_FALSE(is_zero(time_to_limit(run.filter, 1.001 * now_m)));
  for (const double limit_m : {0.0, -0.0, -5.0, -kInf, kNan}) {
    CAPTURE(limit_m);
    CHECK(is_zero(time_to_limit(run.filter, limit_m)));
    for (const ErrorMetric which : kAll<ErrorMetric>) {
      CHECK(is_zero(time_to_limit(run.filter, limit_m, which)));
    }
  }
  for (const double probability : {-1.0, 0.0, 1.0, 2.0, kNan}) {
    CAPTURE(probability);
    CHECK(is_zero(time_to_limit(run.filter, 10.0, probability)));
  }
  for (const double limit_m : {1e100, kInf}) {
    CAPTURE(limit_m);
    const TimeToLimit never = time_to_limit(run.filter, limit_m);
    CHECK(never.time_s == kLeewayHorizonS);
    CHECK(never.beyond_horizon);
  }
  CHECK_FALSE(time_to_limit(run.filter, 1e9).beyond_horizon);
}

TEST_CASE("leeway of a navigator: none before alignment, then that of its filter") {
  Navigator navigator{NavigatorConfig{}};
  CHECK(navigator.leeway(10.0).time_s == 0.0);
  const Estimate start = test::truth_estimate(sim::straight(), 0.0);
  navigator.start(start, initial_covariance(start, {0.01, 0.05, 0.1, 1.0}, ImuErrorModel{}));
  CHECK(navigator.leeway(10.0).time_s > 1.0);
  CHECK(navigator.leeway(10.0, 0.99).time_s ==
        time_to_limit(navigator.filter(), 10.0, 0.99).time_s);
}

}  // namespace leeway
