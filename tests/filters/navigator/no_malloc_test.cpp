// Linked so that every allocation of the libraries, of Eigen inside them too, is counted.
#include <doctest/doctest.h>

#include <cstdint>
#include <optional>
#include <string>

#include "leeway/alternatives/invariant_ekf.hpp"
#include "leeway/covariance/symmetric_kernel.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/ekf/time_to_limit.hpp"
#include "leeway/model/claimed_solution.hpp"
#include "leeway/model/error_metric.hpp"
#include "leeway/model/horizontal.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/navigator/heading_bank.hpp"
#include "leeway/navigator/navigator.hpp"
#include "tests/filters/navigator/recording.hpp"
#include "tests/support/allocation_counter.hpp"

namespace leeway {

TEST_CASE("the counter counts") {
  const test::AllocationCounter guard;
  const std::optional<std::string> by_new(std::string(1000, 'x'));
  CHECK(guard.count() == 1);
  const Eigen::MatrixXd by_malloc(20, 20);
  CHECK(guard.count() == 2);
}

TEST_CASE("nothing the vehicle runs touches the heap") {
  const sim::Trajectory trajectory = sim::circle();
  const auto truth = sim::true_increments(trajectory, 100.0, 20.0);
  EkfConfig config;
  config.lever_arm_b_m = {1.0, 0.0, -1.0};
  const auto log = test::record(trajectory, truth, config.imu, {}, 1.0, 0.5, 1);
  const Estimate start = test::truth_estimate(trajectory, 0.0);
  const ErrorMatrix P = initial_covariance(start, {0.01, 0.05, 0.1, 3.0}, config.imu);

  SUBCASE("predict, update, coast, covariance, solution, with every scheme") {
    for (const Scheme scheme : kAll<Scheme>) {
      config.strapdown.scheme = scheme;
      Ekf ekf(config, start, P);
      const test::AllocationCounter guard;
      int fused = 0;
      for (std::size_t k = 0; k < 50; ++k) ekf.predict(log.imu[k]);
      GnssFix fix = log.fixes[0];
      fused += ekf.update(fix).outcome == UpdateOutcome::Outcome::kFused;
      for (std::size_t k = 50; k < 100; ++k) ekf.predict(log.imu[k]);
      bridge(ekf, time_from_seconds(1.5));
      fix = log.fixes[1];
      fix.velocity.reset();
      fused += ekf.update(fix).outcome == UpdateOutcome::Outcome::kFused;
      const Solution s = solution(ekf.estimate(), ekf.covariance());
      CHECK(guard.count() == 0);
      CHECK(fused == 2);
      CHECK(s.nav.time == fix.time);
    }
  }
  SUBCASE("the invariant filter: predict, update, covariance") {
    InvariantEkf<SymmetricKernel<double>> filter(config, start, SymmetricKernel<double>(P));
    const test::AllocationCounter guard;
    std::size_t next = 0;
    double sum_rad2 = 0.0;
    for (const ImuIncrement& inc : log.imu) {
      filter.predict(inc);
      if (next == log.fixes.size() || log.fixes[next].time != inc.time) continue;
      filter.update(log.fixes[next++]);
      sum_rad2 += filter.covariance()(kPsi, kPsi);
    }
    CHECK(guard.count() == 0);
    CHECK(next > 10);
    CHECK(sum_rad2 > 0.0);
  }
  SUBCASE("leeway, by every metric, short and long, straight and turning") {
    const Ekf turning = [&] {
      Ekf ekf(config, start, P);
      for (std::size_t k = 0; k < 50; ++k) ekf.predict(log.imu[k]);
      return ekf;
    }();
    const Ekf straight(config, start, P);
    const test::AllocationCounter guard;
    double sum_s = 0.0;
    for (const Ekf* ekf : {&straight, &turning}) {
      for (const double limit_m : {8.0, 50.0, 1e5, 1e100}) {
        sum_s += time_to_limit(*ekf, limit_m).time_s;
        for (const ErrorMetric metric : kAll<ErrorMetric>) {
          sum_s += time_to_limit(*ekf, limit_m, metric).time_s;
        }
      }
    }
    sum_s += horizontal_radius_m(Eigen::Matrix2d::Identity(), 0.95);
    CHECK(guard.count() == 0);
    CHECK(sum_s > 0.0);
  }
  SUBCASE("heading bank: predict, update, merge, covariance, copy") {
    const Eigen::Vector3d down_e = ned_to_ecef(sim::kDefaultOrigin).col(2);
    HeadingBank bank(config, start, P, down_e, HeadingBank::kWholeCircleRad);
    const test::AllocationCounter guard;
    std::size_t next = 0;
    double sum_rad2 = 0.0;
    for (const ImuIncrement& inc : log.imu) {
      bank.for_each([&](Ekf& filter) { filter.predict(inc); });
      if (next == log.fixes.size() || log.fixes[next].time != inc.time) continue;
      const GnssFix& fix = log.fixes[next++];
      bank.update([&](Ekf& filter) { return filter.update(fix); });
      sum_rad2 += bank.covariance()(kPsi, kPsi);
    }
    const HeadingBank copy = bank;
    CHECK(guard.count() == 0);
    CHECK(copy.count() < HeadingBank::kMaxFilters);
    CHECK(sum_rad2 > 0.0);
  }
  SUBCASE("push: alignment, fixes between samples, bad data, a gap") {
    Navigator navigator{NavigatorConfig{}};
    GnssFix bad = log.fixes[0];
    bad.position->R_e_m2.setZero();
    const test::AllocationCounter guard;
    std::size_t next = 0;
    for (std::size_t k = 0; k < log.imu.size(); ++k) {
      if (k > 1000 && k < 1100) continue;
      while (next < log.fixes.size() && log.fixes[next].time <= log.imu[k].time) {
        GnssFix fix = log.fixes[next++];
        fix.time -= duration_from_seconds(0.003);
        navigator.push(fix);
      }
      navigator.push(bad);
      navigator.push(log.imu[k]);
      navigator.push(log.imu[k]);
    }
    const Solution s = navigator.solution();
    CHECK(guard.count() == 0);
    CHECK(s.nav.time == log.imu.back().time);
    CHECK(navigator.count(Verdict::kFused) > 10);
    CHECK(navigator.count(Verdict::kGap) == 1);
  }
  SUBCASE("push: late fixes, odometer, barometer, heading, an unknown mount, gaps, rivals") {
    NavigatorConfig navigator_config;
    navigator_config.vehicle = VehicleConfig::car();
    navigator_config.timing.velocity_lag_s = 0.1;  // every fix is cut in two
    bool is_known = false;
    SUBCASE("the mount is known") { is_known = true; }
    SUBCASE("the mount is not known") {}
    if (!is_known) navigator_config.C_bs.reset();
    Navigator navigator(navigator_config);
    const test::AllocationCounter guard;
    std::size_t next = 0;
    bool has_rival = false;
    for (std::size_t k = 0; k < log.imu.size(); ++k) {
      if (k > 1000 && k < 1100) continue;
      const Time t = log.imu[k].time;
      // 0.8 s late; from 16 s on 12 m off, twice a second and more.
      const Time due = t - duration_from_seconds(0.8);
      for (; next < log.fixes.size() && log.fixes[next].time <= due; ++next) {
        navigator.push(log.fixes[next]);
        navigator.push(log.fixes[next]);
      }
      if (k % 10 == 0) {
        navigator.push(OdometerSpeed{t - duration_from_seconds(0.013), 20.0, 0.1});
        navigator.push(BarometricHeight{t - duration_from_seconds(0.017), 100.0, 0.5});
        // The circle's, at 0.2 rad/s. From 3 s on they contradict what the filter had found, for
        // longer than they had been right: the heading is opened.
        const double heading_rad = 0.002 * static_cast<double>(k) + (k < 300 ? 0.0 : 2.0);
        navigator.push(MeasuredHeading{t - duration_from_seconds(0.019), heading_rad, 0.05});
      }
      if (k > 1600 && k % 10 == 5) {
        GnssFix wrong = log.fixes[10];
        wrong.time = t;
        wrong.position->r_e_m += Eigen::Vector3d(10.0 + 1e-3 * static_cast<double>(k), 0.0, 0.0);
        navigator.push(wrong);
      }
      navigator.push(log.imu[k]);
      has_rival = has_rival || navigator.health().state == Health::State::kGating;
    }
    const std::uint64_t fused = navigator.count(Verdict::kFused);
    for (std::size_t k = 0; k < 200; ++k) {
      ImuIncrement inc = log.imu[k];
      inc.time += duration_from_seconds(1e5);
      navigator.push(inc);
    }
    CHECK(guard.count() == 0);
    CHECK(navigator.count(Verdict::kClockJump) == 1);
    CHECK(fused > 0);
    CHECK(navigator.count(Verdict::kDuplicate) > 0);
    CHECK(navigator.count(Verdict::kGap) == 1);
    CHECK(has_rival);
  }
}

}  // namespace leeway
