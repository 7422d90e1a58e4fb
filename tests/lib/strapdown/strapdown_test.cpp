#include "leeway/strapdown/strapdown.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "tests/support/allocation_counter.hpp"
#include "tests/support/analytic_motion.hpp"
#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::AnalyticMotion;
using test::near;

template <class F>
void for_each_policy(const F& f) {
  for (const Scheme scheme : kAll<Scheme>) {
    for (const GravityModel gravity : kAll<GravityModel>) {
      for (const EarthRotation rotation : kAll<EarthRotation>) {
        CAPTURE(static_cast<int>(scheme));
        CAPTURE(static_cast<int>(gravity));
        CAPTURE(static_cast<int>(rotation));
        f(StrapdownPolicy{scheme, gravity, rotation});
      }
    }
  }
}

/// Times from 0 to the duration, the pattern of interval lengths repeated, each times `unit`.
std::vector<Time> times(const std::vector<int>& pattern, Duration unit, Duration duration) {
  std::vector<Time> ends{Time{}};
  for (std::size_t k = 0; ends.back().time_since_epoch() < duration; ++k) {
    ends.push_back(ends.back() + pattern[k % pattern.size()] * unit);
  }
  return ends;
}

std::vector<ImuIncrement> increments(const AnalyticMotion& motion, const std::vector<Time>& ends) {
  std::vector<ImuIncrement> imu;
  for (std::size_t k = 1; k < ends.size(); ++k) {
    imu.push_back(motion.increment(ends[k - 1], ends[k]));
  }
  return imu;
}

const std::vector<Time> kTenMs = times({1}, Duration{10'000'000}, std::chrono::seconds{2});

bool same_bits(const NavState& a, const NavState& b) {
  return a.time == b.time && a.q_eb.coeffs() == b.q_eb.coeffs() && a.v_e_mps == b.v_e_mps &&
         a.r_e_m == b.r_e_m;
}

/// How often halving the intervals halves the error, from `unit` to a quarter of it.
struct Order {
  double first;
  double second;
};

Order order(Scheme scheme, const std::vector<int>& pattern, Duration unit) {
  const auto error_m = [&](Duration u) {
    return test::position_error_m(test::rough_drive(), times(pattern, u, std::chrono::seconds{20}),
                                  strapdown_function({scheme}), 4);
  };
  const double coarse = error_m(unit);
  const double middle = error_m(unit / 2);
  const double fine = error_m(unit / 4);
  MESSAGE("scheme " << static_cast<int>(scheme) << ", intervals of " << pattern.size()
                    << " lengths: " << coarse << ", " << middle << ", " << fine << " m");
  return {std::log2(coarse / middle), std::log2(middle / fine)};
}

}  // namespace

TEST_CASE("no policy of the strapdown allocates") {
  const AnalyticMotion motion = test::rough_drive();
  const std::vector<ImuIncrement> imu = increments(motion, kTenMs);
  for_each_policy([&](const StrapdownPolicy& policy) {
    NavState state = motion.state(0.0);
    ImuHistory history;
    const test::AllocationCounter allocations;
    const StrapdownFunction step = strapdown_function(policy);
    for (const ImuIncrement& inc : imu) step(state, inc, history);
    CHECK(allocations.count() == 0);
  });
  const test::AllocationCounter allocations;
  CHECK(std::make_unique<NavState>() != nullptr);
  CHECK(allocations.count() == 1);  // the counter counts
}

TEST_CASE("each scheme converges at its order" * doctest::test_suite("heavy")) {
  constexpr Duration kUnit{20'000'000};
  for (const Scheme scheme : {Scheme::kExplicitEuler, Scheme::kSemiImplicitEuler}) {
    const Order o = order(scheme, {1}, kUnit);
    CHECK(near(o.second, 1.0, 0.1));
  }
  for (const Scheme scheme : {Scheme::kTrapezoid, Scheme::kOneSample}) {
    const Order o = order(scheme, {1}, kUnit);
    CHECK(near(o.second, 2.0, 0.1));
  }
  for (const Scheme scheme : {Scheme::kTwoSample, Scheme::kRungeKutta4}) {
    const Order o = order(scheme, {1}, kUnit);
    CHECK(near(o.first, 4.0, 0.4));
  }
}

TEST_CASE("on intervals of unequal length RK4 keeps its order and two-sample loses one" *
          doctest::test_suite("heavy")) {
  // Two unequal increments are not symmetric about their middle, where the next order cancels.
  for (const std::vector<int>& pattern : {std::vector{2, 3}, std::vector{3, 2, 4, 2, 3, 1}}) {
    constexpr Duration kUnit{8'000'000};
    CHECK(near(order(Scheme::kTwoSample, pattern, kUnit).second, 3.0, 0.2));
    CHECK(near(order(Scheme::kRungeKutta4, pattern, kUnit).first, 4.0, 0.4));
  }
}

TEST_CASE("a vehicle at rest stays at rest, at any latitude" * doctest::test_suite("heavy")) {
  for (const double lat_deg : {0.0, 45.0, -60.0, 89.9}) {
    for (const Scheme scheme : kAll<Scheme>) {
      AnalyticMotion rest;
      rest.origin = {lat_deg * kRadPerDeg, 37.6 * kRadPerDeg, 100.0};
      rest.roll.offset = -3.0 * kRadPerDeg;
      rest.pitch.offset = 5.0 * kRadPerDeg;
      rest.yaw.offset = 30.0 * kRadPerDeg;
      CAPTURE(lat_deg);
      CAPTURE(static_cast<int>(scheme));
      // Increments stand still too, bar rounding; 2000 steps over 20 s. Position: ulp(6.4e6 m)
      // twice, for a position as small as 1e-12 m moves no component but a zero one.
      CHECK(test::position_error_m(rest, times({1}, Duration{10'000'000}, std::chrono::seconds{20}),
                                   strapdown_function({scheme}), 1) < 2e-9);
    }
  }
}

TEST_CASE("without the Earth's rotation neither frame nor Coriolis turns the result") {
  AnalyticMotion motion = test::rough_drive();
  motion.rotation = EarthRotation::kOff;
  const auto error_m = [&](EarthRotation rotation) {
    return test::position_error_m(
        motion, times({1}, Duration{2'500'000}, std::chrono::seconds{10}),
        strapdown_function({Scheme::kTwoSample, GravityModel::kNormal, rotation}), 4);
  };
  CHECK(error_m(EarthRotation::kOff) < 5e-6);
  // 2 * 7.3e-5 rad/s * 20 m/s for 10 s would be 0.15 m on a straight line.
  CHECK(error_m(EarthRotation::kOn) > 0.01);
}

TEST_CASE("turn and Coriolis, coning and sculling: each alone, and what they leave out adds up") {
  const AnalyticMotion motion = test::rough_drive();
  const auto end_of = [&](const StrapdownPolicy& policy) {
    NavState state = motion.state(0.0);
    ImuHistory history;
    const StrapdownFunction step = strapdown_function(policy);
    for (const ImuIncrement& inc :
         increments(motion, times({1}, Duration{10'000'000}, std::chrono::seconds{10}))) {
      step(state, inc, history);
    }
    return state.r_e_m;
  };
  const auto with_rotation = [&](EarthRotation rotation) {
    return end_of({Scheme::kTwoSample, GravityModel::kNormal, rotation});
  };
  const Eigen::Vector3d still = with_rotation(EarthRotation::kOff);
  const Eigen::Vector3d by_turn_m = with_rotation(EarthRotation::kTurnAlone) - still;
  const Eigen::Vector3d by_coriolis_m = with_rotation(EarthRotation::kCoriolisAlone) - still;
  const Eigen::Vector3d by_both_m = with_rotation(EarthRotation::kOn) - still;
  CHECK(by_turn_m.norm() > 0.01);
  CHECK(by_coriolis_m.norm() > 0.01);
  // They act on each other by the Earth's turn in 10 s, 7e-4 rad.
  CHECK(near(by_both_m, Eigen::Vector3d(by_turn_m + by_coriolis_m), 1e-3 * by_both_m.norm()));

  const Eigen::Vector3d one = end_of({Scheme::kOneSample});
  const Eigen::Vector3d by_coning_m = end_of({Scheme::kConing}) - one;
  const Eigen::Vector3d by_sculling_m = end_of({Scheme::kSculling}) - one;
  const Eigen::Vector3d by_pairs_m = end_of({Scheme::kTwoSample}) - one;
  CHECK(by_coning_m.norm() > 1e-4);
  CHECK(by_sculling_m.norm() > 1e-4);
  // The attitude that coning leaves turns sculling's velocity: second order.
  CHECK(near(by_pairs_m, Eigen::Vector3d(by_coning_m + by_sculling_m), 0.01 * by_pairs_m.norm()));
}

TEST_CASE("a coarser gravity model costs half its error times the time squared") {
  AnalyticMotion rest;
  rest.origin = {90.0 * kRadPerDeg, 0.0, 0.0};
  const auto error_m = [&](GravityModel gravity) {
    return test::position_error_m(
        rest, times({1}, Duration{10'000'000}, std::chrono::seconds{20}),
        strapdown_function({Scheme::kTwoSample, gravity, EarthRotation::kOn}), 1);
  };
  const Eigen::Vector3d r_e_m = ecef_from_geodetic(rest.origin);
  const Eigen::Vector3d exact = gravity_e<GravityModel::kNormal>(r_e_m);
  for (const GravityModel gravity : {GravityModel::kConstant, GravityModel::kJ2}) {
    const double expected_m = 0.5 * 20.0 * 20.0 * (gravity_e(gravity, r_e_m) - exact).norm();
    CAPTURE(static_cast<int>(gravity));
    // The vertical gradient of 3.1e-6 1/s^2 feeds back t^2 / 12 of itself: 1.0e-4.
    CHECK(near(error_m(gravity), expected_m, 2e-4 * expected_m + 2e-9));
  }
}

TEST_CASE("a step reports the mean attitude and the force integral in Earth axes") {
  const AnalyticMotion motion = test::rough_drive();
  constexpr Duration kStep{10'000'000};
  // Of 0.1 m/s and 3 mrad in a step: Euler takes the attitude of the start, half a turn too early;
  // the others miss h^3, two-sample h^4, sculling alone that and what coning would turn,
  // 1e-7 m/s. RK4 reports the trapezoid.
  const std::array kForceTolerance_mps{5e-4, 5e-4, 1e-5, 1e-5, 5e-7, 1e-5, 1e-5, 1e-6};
  const std::array kAttitudeTolerance{5e-3, 5e-3, 4e-5, 4e-5, 4e-5, 4e-5, 4e-5, 4e-5};
  static_assert(kForceTolerance_mps.size() == kAll<Scheme>.size());
  static_assert(kAttitudeTolerance.size() == kAll<Scheme>.size());
  for (std::size_t i = 0; i < kAll<Scheme>.size(); ++i) {
    const StrapdownFunction step = strapdown_function({kAll<Scheme>[i]});
    NavState state = motion.state(0.0);
    ImuHistory history;
    double force_error = 0.0;
    double attitude_error = 0.0;
    for (int k = 0; k < 100; ++k) {
      const Time from = Time{} + k * kStep;
      const StrapdownStep seen = step(state, motion.increment(from, from + kStep), history);
      if (k < 4) continue;
      Eigen::Vector3d dv_e = Eigen::Vector3d::Zero();
      Eigen::Matrix3d C_mean = Eigen::Matrix3d::Zero();
      constexpr int kPanels = 100;
      for (int p = 0; p < kPanels; ++p) {  // midpoint rule: 1e-9 of the integral
        const double t = to_seconds(from) + (p + 0.5) * 0.01 / kPanels;
        const Eigen::Matrix3d C_eb = motion.state(t).q_eb.toRotationMatrix();
        C_mean += C_eb / kPanels;
        dv_e += C_eb * motion.sample(t).f_ib_b_mps2 * 0.01 / kPanels;
      }
      force_error = std::max(force_error, (seen.dv_f_e_mps - dv_e).norm());
      attitude_error = std::max(attitude_error, test::distance(seen.C_eb_mean, C_mean));
    }
    CAPTURE(i);
    CAPTURE(force_error);
    CAPTURE(attitude_error);
    CHECK(force_error < kForceTolerance_mps[i]);
    CHECK(attitude_error < kAttitudeTolerance[i]);
  }
}

TEST_CASE("after a gap the past is forgotten") {
  const AnalyticMotion motion = test::rough_drive();
  const std::vector<ImuIncrement> imu = increments(motion, kTenMs);
  for_each_policy([&](const StrapdownPolicy& policy) {
    const StrapdownFunction step = strapdown_function(policy);
    NavState state = motion.state(0.0);
    ImuHistory history;
    for (std::size_t k = 0; k < 7; ++k) step(state, imu[k], history);
    // 30 ms lost; someone moved the state over them.
    state.time = imu[9].time;
    NavState fresh = state;
    ImuHistory empty;
    for (std::size_t k = 10; k < 16; ++k) {
      step(state, imu[k], history);
      step(fresh, imu[k], empty);
      CHECK(same_bits(state, fresh));
    }
  });
}

TEST_CASE("a correction of the state does not cost the past") {
  // Put right at the end of every pair, the scheme still errs within one step like one that looks
  // back, and not like a one-sample step.
  const AnalyticMotion motion = test::rough_drive();
  const std::vector<ImuIncrement> imu = increments(motion, kTenMs);
  const auto one_step_error_rad = [&](Scheme scheme) {
    const StrapdownFunction step = strapdown_function({scheme});
    NavState state = motion.state(0.0);
    ImuHistory history;
    double largest = 0.0;
    for (std::size_t k = 0; k < imu.size(); ++k) {
      if (k % 2 == 0) state = motion.state(to_seconds(imu[k].time - Duration{10'000'000}));
      step(state, imu[k], history);
      const NavState truth = motion.state(to_seconds(imu[k].time));
      if (k > 4 && k % 2 == 0) {
        largest = std::max(largest, log_quaternion(state.q_eb * truth.q_eb.conjugate()).norm());
      }
    }
    return largest;
  };
  const double one = one_step_error_rad(Scheme::kOneSample);
  CHECK(one_step_error_rad(Scheme::kTwoSample) < 0.2 * one);
  CHECK(one_step_error_rad(Scheme::kRungeKutta4) < 0.2 * one);
}

TEST_CASE("the same inputs give the same bits") {
  const AnalyticMotion motion = test::rough_drive();
  const std::vector<ImuIncrement> imu = increments(motion, kTenMs);
  for_each_policy([&](const StrapdownPolicy& policy) {
    const auto run = [&] {
      const StrapdownFunction step = strapdown_function(policy);
      NavState state = motion.state(0.0);
      ImuHistory history;
      for (const ImuIncrement& inc : imu) step(state, inc, history);
      return state;
    };
    CHECK(same_bits(run(), run()));
  });
}

TEST_CASE("the dispatch table holds the templates") {
  const auto check = []<Scheme scheme, GravityModel gravity>() {
    CHECK((strapdown_function({scheme, gravity, EarthRotation::kOff}) ==
           &strapdown_step<scheme, gravity, EarthRotation::kOff>));
    CHECK((strapdown_function({scheme, gravity, EarthRotation::kOn}) ==
           &strapdown_step<scheme, gravity, EarthRotation::kOn>));
    CHECK((strapdown_function({scheme, gravity, EarthRotation::kTurnAlone}) ==
           &strapdown_step<scheme, gravity, EarthRotation::kTurnAlone>));
    CHECK((strapdown_function({scheme, gravity, EarthRotation::kCoriolisAlone}) ==
           &strapdown_step<scheme, gravity, EarthRotation::kCoriolisAlone>));
  };
  const auto check_scheme = [&]<Scheme scheme>() {
    check.operator()<scheme, GravityModel::kConstant>();
    check.operator()<scheme, GravityModel::kJ2>();
    check.operator()<scheme, GravityModel::kNormal>();
  };
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (check_scheme.operator()<kAll<Scheme>[i]>(), ...);
  }
  (std::make_index_sequence<kAll<Scheme>.size()>{});
  CHECK((strapdown_function({}) == &strapdown_step<>));
}

}  // namespace leeway
