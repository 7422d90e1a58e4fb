// The timeline shows through the navigator: when a measurement is heard of does not matter.
#include "leeway/navigator/timeline.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "leeway/model/initial_covariance.hpp"
#include "leeway/navigator/navigator.hpp"
#include "tests/filters/navigator/recording.hpp"
#include "tests/filters/navigator/same_bits.hpp"
#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::near;
using test::same_bits;

constexpr double kTimelineRateHz = 100.0;

/// A message and the time at which it arrives.
struct Arrival {
  double at_s{};
  Reading reading{};
};

std::vector<Arrival> on_time(const std::vector<GnssFix>& fixes) {
  std::vector<Arrival> arrivals;
  for (const GnssFix& fix : fixes) arrivals.push_back({to_seconds(fix.time), fix});
  return arrivals;
}

/// Pushes every message before the first IMU record that ends later than it arrives.
template <class F>
void run(Navigator& navigator, const std::vector<ImuIncrement>& imu,
         const std::vector<Arrival>& arrivals, F&& after_imu) {
  std::size_t next = 0;
  for (const ImuIncrement& inc : imu) {
    for (; next < arrivals.size() && arrivals[next].at_s < to_seconds(inc.time); ++next) {
      navigator.push(arrivals[next].reading);
    }
    navigator.push(inc);
    after_imu(navigator);
  }
}

void run(Navigator& navigator, const std::vector<ImuIncrement>& imu,
         const std::vector<Arrival>& arrivals) {
  run(navigator, imu, arrivals, [](const Navigator&) {});
}

void start(Navigator& navigator, const sim::Trajectory& trajectory) {
  const Estimate estimate = test::truth_estimate(trajectory, 0.0);
  navigator.start(estimate,
                  initial_covariance(estimate, {0.01, 0.05, 0.1, 3.0}, automotive_mems_model()));
}

const sim::Trajectory& fast_circle() {
  static const sim::Trajectory circle =
      sim::circle({.radius_m = 300.0, .speed_mps = 30.0, .duration_s = 200.0});
  return circle;
}

/// 100 Hz, fixes between samples, at up to 4 Hz.
const test::Recording& timeline_log() {
  static const test::Recording log =
      test::record(fast_circle(), sim::true_increments(fast_circle(), kTimelineRateHz, 200.0),
                   automotive_mems_model(), {}, 0.25, 0.4937, 1);
  return log;
}

std::vector<GnssFix> fixes_until(double end_s) {
  std::vector<GnssFix> fixes = timeline_log().fixes;
  std::erase_if(fixes, [&](const GnssFix& f) { return to_seconds(f.time) > end_s; });
  return fixes;
}

std::vector<ImuIncrement> imu_until(double end_s) {
  return {
      timeline_log().imu.begin(),
      timeline_log().imu.begin() +
          static_cast<std::ptrdiff_t>(std::lround(end_s * kTimelineRateHz))};
}

}  // namespace

TEST_CASE("late, shuffled and repeated fixes lead to the same bits as fixes on time") {
  const auto imu = imu_until(22.5);
  const auto fixes = fixes_until(20.0);
  for (const bool is_started : {true, false}) {
    for (const bool as_car : {false, true}) {
      NavigatorConfig config;
      if (as_car) config.vehicle = VehicleConfig::car();
      Navigator clean(config);
      if (is_started) start(clean, fast_circle());
      run(clean, imu, on_time(fixes));
      REQUIRE(clean.aligned());
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        CAPTURE(is_started);
        CAPTURE(as_car);
        CAPTURE(seed);
        sim::Random random(seed);
        std::vector<Arrival> arrivals;
        for (const GnssFix& fix : fixes) {
          // 10 ms less than 2 s: a message is pushed after IMU data of its time of arrival.
          const auto delay_s = [&] { return 0.02 + (1.99 - 0.02) * random.uniform(); };
          const double t_s = to_seconds(fix.time);
          arrivals.push_back({t_s + delay_s(), fix});
          arrivals.push_back({t_s + delay_s(), fix});
        }
        std::sort(arrivals.begin(), arrivals.end(),
                  [](const Arrival& a, const Arrival& b) { return a.at_s < b.at_s; });
        Navigator late(config);
        if (is_started) start(late, fast_circle());
        run(late, imu, arrivals);
        CHECK(same_bits(late, clean));
        CHECK(late.count(Verdict::kDuplicate) == fixes.size());
        for (const Verdict v : {Verdict::kFused, Verdict::kGated, Verdict::kLate,
                                Verdict::kAccepted, Verdict::kGap, Verdict::kOverflow}) {
          // IMU data is accepted a little later when alignment hears of its fixes late.
          if (v == Verdict::kAccepted && !is_started) continue;
          CAPTURE(std::string(name(v)));
          CHECK(late.count(v) == clean.count(v));
        }
      }
    }
  }
}

TEST_CASE("what comes at a steady pace, and steadily late, leads to the same bits as in order") {
  const auto imu = imu_until(20.0);
  for (const bool on_samples : {true, false}) {
    for (const double velocity_lag_s : {0.0, 0.1}) {  // cuts every fix in two
      std::vector<Arrival> in_order;
      for (GnssFix fix : fixes_until(18.0)) {
        const double t_s = std::round(to_seconds(fix.time) * kTimelineRateHz) / kTimelineRateHz;
        if (on_samples) fix.time = time_from_seconds(t_s);
        const Time between = fix.time + std::chrono::milliseconds{100};
        in_order.push_back({to_seconds(fix.time), fix});
        in_order.push_back({to_seconds(fix.time), OdometerSpeed{fix.time, 30.0, 0.1}});
        in_order.push_back({to_seconds(fix.time), BarometricHeight{fix.time, 100.0, 0.5}});
        in_order.push_back({to_seconds(between), OdometerSpeed{between, 30.0, 0.1}});
      }
      const auto driven = [&](std::vector<Arrival> arrivals, double late_s) {
        for (Arrival& a : arrivals) a.at_s += late_s;
        std::stable_sort(arrivals.begin(), arrivals.end(),
                         [](const Arrival& a, const Arrival& b) { return a.at_s < b.at_s; });
        NavigatorConfig config;
        config.vehicle = VehicleConfig::car();
        config.timing.velocity_lag_s = velocity_lag_s;
        Navigator navigator(config);
        start(navigator, fast_circle());
        run(navigator, imu, arrivals);
        return navigator;
      };
      const Navigator clean = driven(in_order, -1.0);
      const std::vector<Arrival> reversed(in_order.rbegin(), in_order.rend());
      // 0: right after the sample of their time. Up to a sample, a fix's interval, several.
      for (const double late_s : {0.0, 0.013, 0.13, 0.31, 1.2}) {
        for (const auto& arrivals : {in_order, reversed}) {
          CAPTURE(on_samples);
          CAPTURE(velocity_lag_s);
          CAPTURE(late_s);
          const Navigator late = driven(arrivals, late_s);
          CHECK(same_bits(late, clean));
          CHECK(late.count(Verdict::kFused) == clean.count(Verdict::kFused));
          CHECK(late.count(Verdict::kGated) == clean.count(Verdict::kGated));
          CHECK(late.count(Verdict::kLate) == 0);
        }
      }
      CHECK(clean.count(Verdict::kFused) > 200);
    }
  }
}

TEST_CASE("the push of a late fix answers what became of it, and the answer is counted once") {
  const auto imu = imu_until(10.0);
  Navigator navigator{NavigatorConfig{}};
  start(navigator, fast_circle());
  auto fixes = fixes_until(9.0);
  run(navigator, imu, on_time(std::vector(fixes.begin(), fixes.end() - 1)));
  const std::uint64_t fused = navigator.count(Verdict::kFused);
  CHECK(navigator.push(fixes.back()) == Verdict::kFused);
  CHECK(navigator.count(Verdict::kFused) == fused + 1);
  CHECK(navigator.push(fixes.back()) == Verdict::kDuplicate);
  GnssFix outlier = fixes.back();
  outlier.time += duration_from_seconds(0.1);
  outlier.position->r_e_m.z() += 500.0;
  CHECK(navigator.push(outlier) == Verdict::kGated);
  CHECK(navigator.count(Verdict::kGated) == 1);
  CHECK(navigator.count(Verdict::kFused) == fused + 1);
  CHECK(navigator.solution().nav.time == imu.back().time);
}

TEST_CASE("too late is late, and changes nothing") {
  const auto imu = imu_until(10.0);
  const auto fixes = fixes_until(10.0);
  Navigator navigator{NavigatorConfig{}};
  start(navigator, fast_circle());
  run(navigator, imu, on_time(fixes));
  const Navigator copy = navigator;
  for (const double lateness_s : {2.001, 2.3, 5.0, 9.9, 1e6}) {
    CAPTURE(lateness_s);
    GnssFix fix = fixes[20];
    fix.time = imu.back().time - duration_from_seconds(lateness_s);
    CHECK(navigator.push(fix) == Verdict::kLate);
  }
  CHECK(navigator.count(Verdict::kLate) == 5);
  CHECK(same_bits(navigator, copy));
  CHECK(navigator.count(Verdict::kFused) == copy.count(Verdict::kFused));

  NavigatorConfig patient;
  patient.timing.max_lateness_s = 8.0;
  Navigator waits(patient);
  start(waits, fast_circle());
  run(waits, imu, {});
  GnssFix fix = fixes[20];
  CHECK(waits.push(fix) == Verdict::kFused);  // 4.5 s old
}

TEST_CASE("half a second of latency at 30 m/s in a circle costs less than 1 %" *
          doctest::test_suite("heavy")) {
  // 2026-11-24: fused at its arrival, a fix this late is 15 m off.
  const auto rms_m = [](double latency_s, std::uint64_t seed) {
    const auto log =
        test::record(fast_circle(), timeline_log().imu, ImuErrorModel{}, {}, 0.25, 0.5, seed);
    Navigator navigator{NavigatorConfig{}};
    start(navigator, fast_circle());
    auto arrivals = on_time(log.fixes);
    for (Arrival& a : arrivals) a.at_s += latency_s;
    double sum_m2 = 0.0;
    int count = 0;
    run(navigator, log.imu, arrivals, [&](const Navigator& n) {
      const NavState& nav = n.filter().estimate().nav;
      const double t_s = to_seconds(nav.time);
      if (t_s < 30.0 || std::lround(t_s * kTimelineRateHz) % 10 != 0) return;
      sum_m2 += (nav.r_e_m - sim::truth_at(fast_circle(), t_s).nav.r_e_m).squaredNorm();
      ++count;
    });
    CHECK(navigator.count(Verdict::kLate) == 0);
    return std::sqrt(sum_m2 / count);
  };
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    const double without_m = rms_m(0.0, seed);
    const double with_m = rms_m(0.5, seed);
    CAPTURE(without_m);
    CAPTURE(with_m);
    CHECK(near(with_m / without_m, 1.0, 0.01));
  }
}

TEST_CASE("velocity_lag_s: a receiver that reports the mean of its epoch") {
  // On the circle the mean over 0.25 s points where the antenna went 0.125 s ago: 0.0125 rad of
  // 30 m/s, 0.37 m/s across.
  const double epoch_s = 0.25;
  test::Recording log = timeline_log();
  for (GnssFix& fix : log.fixes) {
    const double t_s = to_seconds(fix.time);
    const auto r_e_m = [](double t) { return sim::truth_at(fast_circle(), t).nav.r_e_m; };
    const Eigen::Vector3d noise_mps =
        fix.velocity->v_e_mps - sim::truth_at(fast_circle(), t_s).nav.v_e_mps;
    fix.velocity->v_e_mps = (r_e_m(t_s) - r_e_m(t_s - epoch_s)) / epoch_s + noise_mps;
  }
  const auto rms_mps = [&](double velocity_lag_s) {
    NavigatorConfig config;
    config.timing.velocity_lag_s = velocity_lag_s;
    Navigator navigator(config);
    start(navigator, fast_circle());
    double sum = 0.0;
    int count = 0;
    run(navigator, log.imu, on_time(log.fixes), [&](const Navigator& n) {
      const NavState& nav = n.filter().estimate().nav;
      const double t_s = to_seconds(nav.time);
      if (t_s < 30.0 || std::lround(t_s * kTimelineRateHz) % 10 != 0) return;
      sum += (nav.v_e_mps - sim::truth_at(fast_circle(), t_s).nav.v_e_mps).squaredNorm();
      ++count;
    });
    CHECK(navigator.count(Verdict::kFused) + navigator.count(Verdict::kGated) == log.fixes.size());
    return std::sqrt(sum / count);
  };
  const double plain_mps = rms_mps(0.0);
  const double lagged_mps = rms_mps(0.5 * epoch_s);
  MESSAGE("velocity error " << plain_mps << " m/s taken at the time of the fix, " << lagged_mps
                            << " m/s half an epoch before");
  CHECK(plain_mps > 0.3);
  CHECK(lagged_mps < 0.5 * plain_mps);
}

TEST_CASE("position_lag_s: a position that is older than its stamp") {
  const auto imu = imu_until(20.0);
  const auto fixes = fixes_until(19.5);
  Navigator clean{NavigatorConfig{}};
  start(clean, fast_circle());
  run(clean, imu, on_time(fixes));
  std::vector<GnssFix> stamped_late = fixes;
  for (GnssFix& fix : stamped_late) fix.time += duration_from_seconds(0.1);
  NavigatorConfig config;
  config.timing.position_lag_s = 0.1;
  config.timing.velocity_lag_s = 0.1;
  Navigator lagged(config);
  start(lagged, fast_circle());
  run(lagged, imu, on_time(stamped_late));
  CHECK(same_bits(lagged, clean));  // with both the same it is nothing but another stamp
}

TEST_CASE("IMU data faster than foreseen leaves room for less lateness, and nothing breaks") {
  const auto imu = imu_until(10.0);
  const auto fixes = fixes_until(10.0);
  NavigatorConfig config;
  config.timing.max_imu_rate_hz = 25.0;  // a quarter of what comes
  Navigator narrow(config);
  start(narrow, fast_circle());
  run(narrow, imu, on_time(fixes));
  Navigator clean{NavigatorConfig{}};
  start(clean, fast_circle());
  run(clean, imu, on_time(fixes));
  CHECK(same_bits(narrow, clean));
  GnssFix fix = fixes[20];
  fix.time = imu.back().time - duration_from_seconds(1.5);
  CHECK(narrow.push(fix) == Verdict::kLate);
  fix.time = imu.back().time - duration_from_seconds(0.1);
  CHECK(narrow.push(fix) == Verdict::kGated);  // its data is of another time
}

}  // namespace leeway
