#include "leeway/navigator/navigator.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "tests/filters/navigator/recording.hpp"
#include "tests/filters/navigator/same_bits.hpp"
#include "tests/support/changed.hpp"
#include "tests/support/near.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::near;

using test::kInf;
using test::kNan;
using test::same_bits;

/// A circle at 20 m/s for a minute, 100 Hz, fixes every second from t = 0.5 s on: on samples.
const sim::Trajectory& trajectory() {
  static const sim::Trajectory circle = sim::circle();
  return circle;
}

const test::Recording& recording() {
  static const test::Recording log =
      test::record(trajectory(), sim::true_increments(trajectory(), 100.0, 60.0),
                   automotive_mems_model(), {}, 1.0, 0.5, 1);
  return log;
}

Navigator started(const NavigatorConfig& config = {}) {
  Navigator navigator(config);
  const Estimate start = test::truth_estimate(trajectory(), 0.0);
  navigator.start(start, initial_covariance(start, {0.01, 0.05, 0.1, 3.0}, config.filter.imu));
  return navigator;
}

/// Pushes the log from one time to another, a fix before the increment that ends at its time.
/// `disturb` is called before every increment.
template <class F>
void run(Navigator& navigator, double from_s, double to_s, F&& disturb) {
  std::size_t next = 0;
  for (const ImuIncrement& inc : recording().imu) {
    if (inc.time <= time_from_seconds(from_s)) continue;
    if (inc.time > time_from_seconds(to_s)) break;
    while (next < recording().fixes.size() && recording().fixes[next].time <= inc.time) {
      const GnssFix& fix = recording().fixes[next++];
      if (fix.time > time_from_seconds(from_s)) CHECK(navigator.push(fix) == Verdict::kAccepted);
    }
    disturb(inc);
    navigator.push(inc);
  }
}

void run(Navigator& navigator, double from_s, double to_s) {
  run(navigator, from_s, to_s, [](const ImuIncrement&) {});
}

double horizontal_error_m(const Navigator& navigator) {
  const NavState nav = navigator.solution().nav;
  const NavState truth = sim::truth_at(trajectory(), to_seconds(nav.time)).nav;
  const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(truth.r_e_m));
  return (C_en.transpose() * (nav.r_e_m - truth.r_e_m)).head<2>().norm();
}

double horizontal_sigma_m(const Navigator& navigator) {
  return navigator.solution().sigma_position_n_m.head<2>().norm();
}

bool all_finite(const Solution& s) {
  return s.nav.q_eb.coeffs().allFinite() && s.nav.v_e_mps.allFinite() && s.nav.r_e_m.allFinite() &&
         s.b_a_mps2.allFinite() && s.b_g_radps.allFinite() && s.sigma_position_n_m.allFinite() &&
         s.sigma_velocity_n_mps.allFinite() && s.sigma_attitude_rad.allFinite() &&
         s.sigma_b_a_mps2.allFinite() && s.sigma_b_g_radps.allFinite();
}

std::uint64_t total(const Navigator& navigator) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < kVerdicts; ++i) sum += navigator.count(static_cast<Verdict>(i));
  return sum;
}

/// A fix that is right, at a time ahead of all IMU data, to be spoiled.
GnssFix fix_ahead(Time t) {
  GnssFix fix = recording().fixes.front();
  fix.time = t + duration_from_seconds(0.003);
  return fix;
}

}  // namespace

TEST_CASE("bad IMU data: its verdict, its count, and nothing else") {
  struct Case {
    const char* what;
    void (*spoil)(ImuIncrement&);
    Verdict verdict;
  };
  const Case cases[] = {
      {"NaN rate", [](ImuIncrement& i) { i.dtheta_b_rad.y() = kNan; }, Verdict::kNotFinite},
      {"infinite force", [](ImuIncrement& i) { i.dv_b_mps.z() = -kInf; }, Verdict::kNotFinite},
      {"NaN length", [](ImuIncrement& i) { i.dt_s = kNan; }, Verdict::kNotFinite},
      {"infinite length", [](ImuIncrement& i) { i.dt_s = kInf; }, Verdict::kNotFinite},
      {"no length", [](ImuIncrement& i) { i.dt_s = 0.0; }, Verdict::kImplausible},
      {"negative length", [](ImuIncrement& i) { i.dt_s = -0.01; }, Verdict::kImplausible},
      // 2026-11-28, by the fuzzer: as the very first, longer than Time can count, it threw.
      {"a length of 1e30 s", [](ImuIncrement& i) { i.dt_s = 1e30; }, Verdict::kImplausible},
      {"more than max_jump_s", [](ImuIncrement& i) { i.dt_s = 60.1; }, Verdict::kImplausible},
      {"rate", [](ImuIncrement& i) { i.dtheta_b_rad.x() = 1.01; }, Verdict::kImplausible},
      {"force", [](ImuIncrement& i) { i.dv_b_mps.x() = -10.1; }, Verdict::kImplausible},
      {"largest double", [](ImuIncrement& i) { i.dv_b_mps.setConstant(1.7e308); },
       Verdict::kImplausible},
      {"same time", [](ImuIncrement& i) { i.time -= duration_from_seconds(0.01); },
       Verdict::kDuplicate},
      {"back in time", [](ImuIncrement& i) { i.time -= duration_from_seconds(0.015); },
       Verdict::kOutOfOrder},
  };
  Navigator clean = started();
  run(clean, 0.0, 3.0);
  for (const Case& c : cases) {
    CAPTURE(std::string(c.what));
    Navigator navigator = started();
    std::uint64_t pushed = 0;
    run(navigator, 0.0, 3.0, [&](ImuIncrement inc) {
      c.spoil(inc);
      CHECK(navigator.push(inc) == c.verdict);
      ++pushed;
    });
    CHECK(navigator.count(c.verdict) == pushed);
    CHECK(navigator.count(Verdict::kAccepted) == clean.count(Verdict::kAccepted));
    CHECK(navigator.count(Verdict::kFused) == clean.count(Verdict::kFused));
    CHECK(same_bits(navigator, clean));
  }
}

TEST_CASE("bad fixes: their verdict, their count, and nothing else") {
  struct Case {
    const char* what;
    void (*spoil)(GnssFix&);
    Verdict verdict;
  };
  const Case cases[] = {
      {"NaN position", [](GnssFix& f) { f.position->r_e_m.x() = kNan; }, Verdict::kNotFinite},
      {"infinite velocity", [](GnssFix& f) { f.velocity->v_e_mps.x() = kInf; },
       Verdict::kNotFinite},
      {"NaN covariance", [](GnssFix& f) { f.position->R_e_m2(0, 1) = kNan; }, Verdict::kNotFinite},
      {"infinite covariance", [](GnssFix& f) { f.velocity->R_e_m2ps2(2, 2) = kInf; },
       Verdict::kNotFinite},
      {"zero covariance", [](GnssFix& f) { f.position->R_e_m2.setZero(); }, Verdict::kImplausible},
      {"negative covariance", [](GnssFix& f) { f.velocity->R_e_m2ps2 *= -1.0; },
       Verdict::kImplausible},
      {"asymmetric covariance", [](GnssFix& f) { f.position->R_e_m2(0, 2) += 0.5; },
       Verdict::kImplausible},
      {"correlation above 1",
       [](GnssFix& f) { f.position->R_e_m2(0, 1) = f.position->R_e_m2(1, 0) = 99.0; },
       Verdict::kImplausible},
      {"in space", [](GnssFix& f) { f.position->r_e_m *= 2.0; }, Verdict::kImplausible},
      {"at the centre", [](GnssFix& f) { f.position->r_e_m.setZero(); }, Verdict::kImplausible},
      {"20 km/s", [](GnssFix& f) { f.velocity->v_e_mps.x() = 2e4; }, Verdict::kImplausible},
      {"nothing in it", [](GnssFix& f) { f = GnssFix{f.time}; }, Verdict::kImplausible},
      {"from before the start", [](GnssFix& f) { f.time -= duration_from_seconds(1.0); },
       Verdict::kLate},
      {"from the future", [](GnssFix& f) { f.time += duration_from_seconds(10.0); },
       Verdict::kFuture},
  };
  Navigator clean = started();
  run(clean, 0.0, 0.3);
  for (const Case& c : cases) {
    CAPTURE(std::string(c.what));
    Navigator navigator = started();
    std::uint64_t pushed = 0;
    run(navigator, 0.0, 0.3, [&](const ImuIncrement& inc) {
      if (inc.time <= time_from_seconds(0.01)) return;
      GnssFix fix = fix_ahead(inc.time - duration_from_seconds(0.01));
      c.spoil(fix);
      CHECK(navigator.push(fix) == c.verdict);
      ++pushed;
    });
    CHECK(navigator.count(c.verdict) == pushed);
    CHECK(total(navigator) == total(clean) + pushed);
    CHECK(same_bits(navigator, clean));
  }
}

TEST_CASE("fixes twice, in any order, too many, and an outlier") {
  Navigator navigator = started();
  run(navigator, 0.0, 1.0);
  Navigator clean = navigator;
  const auto fix_at = [](double t_s) {
    GnssFix fix = recording().fixes[1];
    fix.time = time_from_seconds(t_s);
    const NavState truth = sim::truth_at(trajectory(), t_s).nav;
    fix.position->r_e_m = truth.r_e_m;
    fix.velocity->v_e_mps = truth.v_e_mps;
    return fix;
  };
  CHECK(navigator.push(fix_at(1.5)) == Verdict::kAccepted);
  CHECK(navigator.push(fix_at(1.5)) == Verdict::kDuplicate);
  CHECK(navigator.push(fix_at(1.2)) == Verdict::kAccepted);
  CHECK(clean.push(fix_at(1.2)) == Verdict::kAccepted);
  CHECK(clean.push(fix_at(1.5)) == Verdict::kAccepted);
  GnssFix outlier = fix_at(1.7);
  outlier.position->r_e_m += Eigen::Vector3d(0.0, 0.0, 100.0);
  outlier.velocity->v_e_mps += Eigen::Vector3d(0.0, 0.0, 50.0);
  CHECK(navigator.push(outlier) == Verdict::kAccepted);
  // The flush before the gate is the same at any time: refused there, the outlier moves no estimate
  // and leaves P as a propagation in two pieces would.
  for (const ImuIncrement& inc : recording().imu) {
    if (inc.time <= time_from_seconds(1.0) || inc.time > time_from_seconds(2.0)) continue;
    navigator.push(inc);
    clean.push(inc);
  }
  CHECK(navigator.count(Verdict::kGated) == 1);
  CHECK(clean.count(Verdict::kGated) == 0);
  CHECK(navigator.filter().estimate().nav.r_e_m == clean.filter().estimate().nav.r_e_m);
  CHECK(navigator.last_update().outcome == UpdateOutcome::Outcome::kGated);
  CHECK(navigator.last_update().nis > navigator.last_update().gate);

  int accepted = 0;
  for (int k = 0; k < 300; ++k) {
    accepted += navigator.push(fix_at(2.001 + 0.01 * k)) == Verdict::kAccepted;
  }
  CHECK(accepted == 256);
  CHECK(navigator.count(Verdict::kOverflow) == 44);
}

// Known to fail, 2026-11-24: the NIS of a refused fix counts whole in the mean by which the filter
// follows a receiver's drift, and widens P to 257 m. The one after it, 300 m off, is fused.
TEST_CASE("one outlier does not open the gate to the next") {
  Navigator navigator = started();
  run(navigator, 0.0, 40.4);
  const double sigma_m = horizontal_sigma_m(navigator);
  const auto wrong_by = [](double t_s, double off_m) {
    GnssFix fix = recording().fixes[40];
    fix.time = time_from_seconds(t_s);
    fix.position->r_e_m = sim::truth_at(trajectory(), t_s).nav.r_e_m;
    fix.position->r_e_m.z() += off_m;
    fix.velocity.reset();
    return fix;
  };
  CHECK(navigator.push(wrong_by(40.1, 1000.0)) == Verdict::kGated);
  CHECK(horizontal_sigma_m(navigator) < 1.5 * sigma_m);
  CHECK(navigator.push(wrong_by(40.3, 300.0)) == Verdict::kGated);
  CHECK(horizontal_error_m(navigator) < 10.0);
}

// Known to fail, 2026-11-24: after the end of the week no sample is later than the one before it.
TEST_CASE("samples over the end of a GPS week go on as without one") {
  constexpr double kWeekS = 604800.0;
  const auto drive = [](double begin_s, bool wraps) {
    Navigator navigator{NavigatorConfig{}};
    const auto time = [&](double t_s) {
      const double at_s = begin_s + t_s;
      return time_from_seconds(wraps && at_s >= kWeekS ? at_s - kWeekS : at_s);
    };
    std::size_t next = 0;
    for (int k = 0; k <= 2000; ++k) {
      const double t_s = 0.01 * k;
      const sim::TruthPoint truth = sim::truth_at(trajectory(), t_s);
      for (; next < 60 && to_seconds(recording().fixes[next].time) <= t_s; ++next) {
        GnssFix fix = recording().fixes[next];
        fix.time = time(to_seconds(fix.time));
        navigator.push(fix);
      }
      navigator.push(ImuSample{time(t_s), truth.omega_ib_b_radps, truth.f_ib_b_mps2});
    }
    return navigator;
  };
  const Navigator wrapped = drive(kWeekS - 10.0, true);
  const Navigator counted = drive(kWeekS - 10.0, false);
  REQUIRE(counted.aligned());
  REQUIRE(wrapped.aligned());
  CHECK(same_bits(wrapped, counted));
  CHECK(wrapped.count(Verdict::kFused) == counted.count(Verdict::kFused));
}

TEST_CASE("a fix acts at its own time: on a sample, between two, several within one") {
  // An errorless world: only a fix used at the wrong time leaves an innovation, 0.2 m for 10 ms.
  sim::GnssErrorModel gnss;
  gnss.position_sigma_n_m.setConstant(1e-4);
  gnss.velocity_sigma_n_mps.setConstant(1e-4);
  NavigatorConfig config;
  config.filter.imu = ImuErrorModel{};
  config.filter.gnss_correlation_s = 0.0;
  const auto truth = sim::true_increments(trajectory(), 100.0, 1.0);
  for (const double first_fix_s : {0.01, 0.013, 0.0177777}) {
    for (const double interval_s : {0.1, 0.0031}) {
      CAPTURE(first_fix_s);
      CAPTURE(interval_s);
      const auto log = test::record(trajectory(), truth, {}, gnss, interval_s, first_fix_s, 1);
      Navigator navigator(config);
      const Estimate start = test::truth_estimate(trajectory(), 0.0);
      navigator.start(start,
                      initial_covariance(start, {1e-6, 1e-6, 1e-3, 1e-3}, config.filter.imu));
      std::size_t next = 0;
      for (const ImuIncrement& inc : log.imu) {
        while (next < log.fixes.size() && log.fixes[next].time <= inc.time) {
          navigator.push(log.fixes[next++]);
        }
        navigator.push(inc);
        CHECK(navigator.filter().estimate().nav.time == inc.time);
      }
      CHECK(next == log.fixes.size());
      CHECK(navigator.count(Verdict::kFused) == next);
      CHECK(navigator.last_update().time == log.fixes.back().time);
      CHECK(horizontal_error_m(navigator) < 1e-3);
    }
  }
}

TEST_CASE("no IMU data for a while: a gap is bridged, sigmas grow, the filter recovers" *
          doctest::test_suite("heavy")) {
  // In a turn of 11 deg/s the heading held over a gap is 60 deg wrong after 5 s: too far for the
  // linearized filter to find back reliably. 2 s in the turn, 5 s in the straight.
  struct Case {
    sim::Trajectory trajectory;
    double gap_s;
  };
  for (const Case& c : {Case{trajectory(), 2.0}, Case{sim::straight(), 5.0}}) {
    CAPTURE(c.gap_s);
    const auto truth = sim::true_increments(c.trajectory, 100.0, 60.0);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      CAPTURE(seed);
      const auto log =
          test::record(c.trajectory, truth, automotive_mems_model(), {}, 1.0, 0.5, seed);
      NavigatorConfig config;
      Navigator navigator(config);
      const Estimate start = test::truth_estimate(c.trajectory, 0.0);
      navigator.start(start, initial_covariance(start, {0.01, 0.05, 0.1, 3.0}, config.filter.imu));
      const auto error_m = [&] {
        const NavState nav = navigator.solution().nav;
        return (nav.r_e_m - sim::truth_at(c.trajectory, to_seconds(nav.time)).nav.r_e_m).norm();
      };
      std::size_t next = 0;
      const Time begin = time_from_seconds(30.0);
      const Time end = begin + duration_from_seconds(c.gap_s);
      for (const ImuIncrement& inc : log.imu) {
        if (inc.time > begin && inc.time < end) continue;
        const double sigma_before_m = horizontal_sigma_m(navigator);
        // The receiver is down as well; a fix that waited is tried in the next case.
        for (; next < log.fixes.size() && log.fixes[next].time <= inc.time; ++next) {
          if (inc.time != end) navigator.push(log.fixes[next]);
        }
        // The time of the first record after the hole may be wrong: the second confirms it.
        const Verdict verdict = navigator.push(inc);
        CHECK((verdict == Verdict::kFuture) == (inc.time == end));
        CHECK((verdict == Verdict::kGap) == (inc.time == end + duration_from_seconds(0.01)));
        if (verdict != Verdict::kGap) continue;
        CHECK(horizontal_sigma_m(navigator) > 3.0 * sigma_before_m);
        CHECK(error_m() < 3.0 * horizontal_sigma_m(navigator));
      }
      CHECK(navigator.count(Verdict::kGap) == 1);
      CHECK(navigator.count(Verdict::kGated) == 0);
      CHECK(error_m() < 10.0);
      CHECK(horizontal_sigma_m(navigator) < 10.0);
    }
  }
}

TEST_CASE("fixes that wait through a gap act at their own times") {
  Navigator navigator = started();
  run(navigator, 0.0, 30.0);
  for (std::size_t k = 30; k < 35; ++k) navigator.push(recording().fixes[k]);
  CHECK(navigator.push(recording().imu[3498]) == Verdict::kFuture);
  CHECK(navigator.push(recording().imu[3499]) == Verdict::kGap);
  CHECK(navigator.count(Verdict::kFused) + navigator.count(Verdict::kGated) == 35);
  CHECK(horizontal_error_m(navigator) < 10.0);  // the last fix is half a second old
}

TEST_CASE("a hole of 30 ms is bridged at the rates after it") {
  Navigator navigator = started();
  run(navigator, 0.0, 10.0);
  Navigator whole = navigator;
  run(navigator, 10.03, 10.5);
  run(whole, 10.0, 10.5);
  CHECK(navigator.count(Verdict::kGap) == 0);
  CHECK(navigator.solution().nav.time == whole.solution().nav.time);
  // The rates of the circle are constant, the noise of three samples is not: 2e-3 m/s.
  CHECK(near(navigator.solution().nav.v_e_mps, whole.solution().nav.v_e_mps, 0.02));
}

TEST_CASE("a copy goes its own way") {
  Navigator original = started();
  run(original, 0.0, 10.0);
  const Navigator snapshot = original;
  Navigator branch = original;
  run(branch, 10.0, 20.0);
  CHECK(same_bits(original, snapshot));
  run(original, 10.0, 20.0);
  CHECK(same_bits(original, branch));
}

TEST_CASE("without a start it aligns on the move, then fuses") {
  Navigator navigator{NavigatorConfig{}};
  CHECK_FALSE(navigator.aligned());
  CHECK(navigator.last_update().dof == 0);
  run(navigator, 0.0, 30.0);
  REQUIRE(navigator.aligned());
  CHECK(navigator.count(Verdict::kAligning) ==
        149 + 2);  // IMU before the second fix, and two fixes
  CHECK(navigator.count(Verdict::kFused) + navigator.count(Verdict::kGated) == 28);
  CHECK(navigator.last_update().dof == 6);
  CHECK(horizontal_error_m(navigator) < 3.0 * horizontal_sigma_m(navigator));
}

TEST_CASE("a hole while aligning starts it anew") {
  Navigator navigator{NavigatorConfig{}};
  run(navigator, 0.0, 1.0);
  run(navigator, 2.99, 3.2);
  CHECK(navigator.count(Verdict::kGap) == 1);
  CHECK_FALSE(navigator.aligned());
  run(navigator, 3.2, 6.0);
  CHECK(navigator.aligned());
}

TEST_CASE(
    "start: what is refused leaves the navigator as it was; waiting fixes from before are late") {
  Navigator navigator = started();
  run(navigator, 0.0, 1.0);
  const Navigator before = navigator;
  CHECK_THROWS_AS(navigator.start(Estimate{}, ErrorMatrix::Identity()), Error);
  REQUIRE(navigator.aligned());
  CHECK(same_bits(navigator, before));

  // 2026-11-24: a fix that waited from before the start was fused at the time of the start.
  Navigator fresh{NavigatorConfig{}};
  CHECK(fresh.push(recording().fixes[0]) == Verdict::kAccepted);
  const Estimate start = test::truth_estimate(trajectory(), 10.0);
  fresh.start(start, initial_covariance(start, {0.01, 0.05, 0.1, 3.0}, automotive_mems_model()));
  run(fresh, 10.0, 10.2);
  CHECK(fresh.count(Verdict::kLate) == 1);
  CHECK(fresh.count(Verdict::kFused) == 0);
}

TEST_CASE("an invalid configuration is refused at once") {
  const auto message = [](auto spoil) {
    NavigatorConfig config;
    spoil(config);
    return test::message_of<Error>([&] { Navigator{config}; });
  };
  CHECK(test::contains(message([](auto& c) { c.max_gap_s = 0.0; }), "max_gap_s"));
  CHECK(test::contains(message([](auto& c) { c.max_rate_radps = kNan; }), "max_rate_radps"));
  CHECK(test::contains(message([](auto& c) { c.max_force_mps2 = -1.0; }), "max_force_mps2"));
  CHECK(test::contains(message([](auto& c) { c.filter.gnss_correlation_s = -1.0; }),
                       "gnss_correlation_s"));
  CHECK(test::contains(message([](auto& c) { c.alignment.min_speed_mps = 0.0; }), "min_speed_mps"));
  test::for_each_changed(
      NavigatorConfig{}, test::ToNan{}, [](const std::string& field, const NavigatorConfig& bad) {
        CAPTURE(field);
        CHECK(test::contains(test::message_of<Error>([&] { Navigator{bad}; }), field + " is nan"));
      });
}

TEST_CASE("1e5 damaged inputs: no exception, no NaN, and every one is counted" *
          doctest::test_suite("heavy")) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    sim::Random random(seed, 9);
    const double specials[] = {kNan, kInf, -kInf, 0.0, -0.0, 1e308, -1e308, 1e-308, 1e9, -1.0};
    const auto damage = [&](double& x) {
      if (random.uniform() < 0.01) x = specials[static_cast<int>(10.0 * random.uniform())];
      if (random.uniform() < 0.01) x *= std::exp(20.0 * random.normal());
    };
    NavigatorConfig config;
    if (seed > 5) config.vehicle = VehicleConfig::car();
    Navigator navigator = seed % 2 == 0 ? started(config) : Navigator{config};
    Time now{};
    std::uint64_t inputs = 0;
    bool was_aligned = false;
    for (int k = 0; k < 10'000; ++k) {
      now += duration_from_seconds(random.uniform() < 0.001 ? 3.0 * random.uniform() : 0.01);
      const Time jittered =
          now + duration_from_seconds(random.uniform() < 0.01 ? 0.1 * random.normal() : 0.0);
      if (random.uniform() < 0.1) {
        GnssFix fix = recording().fixes[static_cast<std::size_t>(k) % 60];
        fix.time = jittered + duration_from_seconds(0.01 * random.uniform());
        for (double& x : fix.position->r_e_m) damage(x);
        for (double& x : fix.position->R_e_m2.reshaped()) damage(x);
        for (double& x : fix.velocity->v_e_mps) damage(x);
        fix.position->R_e_m2 *= std::exp(5.0 * random.normal());
        if (random.uniform() < 0.1) fix.position.reset();
        if (random.uniform() < 0.1) fix.velocity.reset();
        navigator.push(fix);
      } else if (random.uniform() < 0.05) {
        OdometerSpeed odometer{jittered, 20.0, 0.1};
        damage(odometer.speed_mps);
        damage(odometer.sigma_mps);
        navigator.push(odometer);
      } else if (random.uniform() < 0.05) {
        BarometricHeight barometer{jittered, 100.0, 0.5};
        damage(barometer.height_m);
        damage(barometer.sigma_m);
        navigator.push(barometer);
      } else {
        ImuIncrement inc = recording().imu[static_cast<std::size_t>(k) % 6000];
        inc.time = jittered;
        damage(inc.dt_s);
        for (double& x : inc.dtheta_b_rad) damage(x);
        for (double& x : inc.dv_b_mps) damage(x);
        navigator.push(inc);
      }
      ++inputs;
      was_aligned = was_aligned || navigator.aligned();
      if (navigator.aligned() && k % 10 == 0) REQUIRE(all_finite(navigator.solution()));
    }
    CHECK(was_aligned);
    CHECK(total(navigator) <= inputs);
    CHECK(total(navigator) + 256 >= inputs);  // up to 256 fixes wait for their verdict
    CHECK(navigator.count(Verdict::kFused) > 0);
  }
}

}  // namespace leeway
