#include "leeway/navigator/heading_bank.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "tests/filters/model/random_state.hpp"
#include "tests/filters/navigator/recording.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::at_equator;
using test::near;
using Outcome = UpdateOutcome::Outcome;

ErrorMatrix diagonal_covariance() {
  return test::jacobian_steps(0.01, 0.1, 2.0, 0.05, 0.001).cwiseAbs2().asDiagonal();
}

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitX();

HeadingBank bank_of(double sigma_rad, const EkfConfig& config = {}) {
  return HeadingBank(config, at_equator(), diagonal_covariance(), kUp, sigma_rad);
}

/// 1 sigma of a turn about an axis.
double turn_sigma_rad(const ErrorMatrix& P, const Eigen::Vector3d& axis_e) {
  return std::sqrt(axis_e.dot(P.block<3, 3>(kPsi, kPsi) * axis_e));
}

/// An outcome of a fix that says nothing but the likelihood of each member by its turn about up.
template <class F>
auto reporting(F&& nis_of_turn) {
  return [nis_of_turn](Ekf& filter) {
    UpdateOutcome outcome;
    outcome.time = filter.estimate().nav.time;
    outcome.dof = 3;
    outcome.gate = 1e3;
    outcome.nis = nis_of_turn(log_quaternion(filter.estimate().nav.q_eb).x());
    outcome.outcome = outcome.nis <= outcome.gate ? Outcome::kFused : Outcome::kGated;
    return outcome;
  };
}

}  // namespace

TEST_CASE("one filter up to 15 deg, twelve for the circle, and the sigma asked for") {
  CHECK(HeadingBank(Ekf(EkfConfig{}, at_equator(), diagonal_covariance())).collapsed());
  struct Case {
    double sigma_deg;
    std::size_t count;
  };
  for (const Case& c : {Case{0.0, 1}, Case{15.0, 1}, Case{18.0, 6}, Case{30.0, 10}, Case{36.0, 12},
                        Case{55.0, 12}}) {
    CAPTURE(c.sigma_deg);
    const HeadingBank bank = bank_of(c.sigma_deg * kRadPerDeg);
    CHECK(bank.count() == c.count);
    CHECK(bank.collapsed() == (c.count == 1));
    // The second moment about a middle member; means between the sigmas -3 and 3 lose 2 %.
    Estimate middle = at_equator();
    const ErrorVector x = difference(middle, bank.best().estimate());
    const double offset_rad = x.segment<3>(kPsi).dot(kUp);
    const double sigma_rad = turn_sigma_rad(bank.covariance(), kUp);
    const double expected_rad = std::hypot(c.sigma_deg * kRadPerDeg, 0.01, offset_rad);
    CHECK(near(sigma_rad / expected_rad, 1.0, 0.03));
  }
  for (const double sigma_rad : {HeadingBank::kWholeCircleRad, std::numbers::pi, 1e9}) {
    const HeadingBank bank = bank_of(sigma_rad);
    CHECK(bank.count() == 12);
    CHECK(near(bank.best_weight(), 1.0 / 12.0, 1e-15));
    // Uniform on the circle: pi / sqrt(3) = 104 deg.
    CHECK(near(turn_sigma_rad(bank.covariance(), kUp), std::numbers::pi / std::sqrt(3.0),
               2.0 * kRadPerDeg));
  }
}

TEST_CASE("members turn about the antenna, and the levelling error turns along") {
  EkfConfig config;
  config.lever_arm_b_m = {0.0, 3.0, 1.0};
  ErrorMatrix P = diagonal_covariance();
  // An accelerometer bias about body z that levelling took for a tilt.
  P(kPsi + 1, kBa + 2) = P(kBa + 2, kPsi + 1) = 0.9 * 0.01 * 0.05;
  HeadingBank bank(config, at_equator(), P, kUp, std::numbers::pi);
  const Eigen::Vector3d antenna_e_m = antenna_position_e(at_equator(), config.lever_arm_b_m);
  int members = 0;
  bank.for_each([&](Ekf& filter) {
    ++members;
    // Twice the rounding of ECEF coordinates.
    CHECK(near(antenna_position_e(filter.estimate(), config.lever_arm_b_m), antenna_e_m, 2e-9));
    // In body axes every member knows the same, but for its own heading sigma of 15 deg about x.
    const Eigen::Matrix3d C_be = filter.estimate().nav.q_eb.toRotationMatrix().transpose();
    const ErrorMatrix P_member = filter.covariance();
    const Eigen::Matrix3d psi_b = C_be * P_member.block<3, 3>(kPsi, kPsi) * C_be.transpose();
    const double share_rad = 15.0 * kRadPerDeg;
    CHECK(near(psi_b, P.block<3, 3>(kPsi, kPsi) + share_rad * share_rad * kUp * kUp.transpose(),
               1e-15));
    CHECK(near(C_be * P_member.block<3, 3>(kPsi, kBa), P.block<3, 3>(kPsi, kBa), 1e-18));
  });
  CHECK(members == 12);
}

TEST_CASE("two members in closed form: weights by likelihood, covariance within plus spread") {
  HeadingBank bank = bank_of(std::numbers::pi);
  // Of twelve at +-15, +-45, .. +-165 deg two are left: the rest cannot be.
  bank.update(reporting([](double turn_rad) {
    return std::abs(std::abs(turn_rad) - 75.0 * kRadPerDeg) < 0.1 ? 3.0 : 900.0;
  }));
  REQUIRE(bank.count() == 2);
  CHECK(near(bank.best_weight(), 0.5, 1e-12));
  // Long after, a measurement stands alone. Of the difference of 4 the first 2 do not count: odds
  // of exp(-0.5 * 2).
  bank.for_each([](Ekf& filter) {
    edit(filter, [](Belief& belief) { belief.estimate.nav.time = time_from_seconds(100.0); });
  });
  bank.update(reporting([](double turn_rad) { return turn_rad > 0.0 ? 3.0 : 7.0; }));
  REQUIRE(bank.count() == 2);
  const double w = 1.0 / (1.0 + std::exp(-1.0));
  CHECK(near(bank.best_weight(), w, 1e-12));
  CHECK(near(log_quaternion(bank.best().estimate().nav.q_eb).x(), 75.0 * kRadPerDeg, 1e-12));

  ErrorMatrix within = ErrorMatrix::Zero();
  bank.for_each([&](Ekf& filter) {
    const bool heavy = log_quaternion(filter.estimate().nav.q_eb).x() > 0.0;
    within += (heavy ? w : 1.0 - w) * filter.covariance();
  });
  const double apart_rad = 150.0 * kRadPerDeg;
  ErrorMatrix expected = within;
  expected(kPsi, kPsi) += (1.0 - w) * apart_rad * apart_rad;
  CHECK(near(bank.covariance(), expected, 1e-9 * within.maxCoeff()));
  CHECK(bank.covariance() == bank.covariance().transpose());
}

TEST_CASE("measurements close in time repeat each other: their evidence counts in part") {
  const auto unequal = reporting([](double turn_rad) { return turn_rad > 0.0 ? 3.0 : 6.0; });
  HeadingBank once = bank_of(std::numbers::pi);
  once.update(unequal);
  CHECK(near(once.best_weight(), 1.0 / 6.0 / (1.0 + std::exp(-0.5)), 1e-12));
  HeadingBank often = once;
  const double again_s = 0.1;
  often.for_each([&](Ekf& filter) {
    bridge(filter, time_from_seconds(again_s));
  });
  often.update(unequal);
  // Correlated over 2 s; and of the older evidence a tenth is forgotten with each whole
  // measurement.
  const double weight = std::tanh(0.5 * again_s / 2.0);
  const double nats = 0.5 * (1.0 - weight / 10.0) + 0.5 * weight;
  CHECK(near(often.best_weight(), 1.0 / 6.0 / (1.0 + std::exp(-nats)), 1e-12));
  often.update(unequal);  // the same moment once more says nothing
  CHECK(near(often.best_weight(), 1.0 / 6.0 / (1.0 + std::exp(-nats)), 1e-12));
}

TEST_CASE("an outlier that all refuse decides nothing; a member that is not a number goes") {
  HeadingBank bank = bank_of(std::numbers::pi);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const UpdateOutcome outcome =
      bank.update(reporting([](double turn_rad) { return 5e3 + 1e3 * turn_rad; }));
  CHECK(outcome.outcome == Outcome::kGated);
  CHECK(bank.count() == 12);
  CHECK(near(bank.best_weight(), 1.0 / 12.0, 1e-15));
  bank.update([&](Ekf& filter) {
    UpdateOutcome r = reporting([](double) { return 3.0; })(filter);
    if (log_quaternion(filter.estimate().nav.q_eb).x() > 0.0) r.log_det_S = nan;
    return r;
  });
  CHECK(bank.count() == 6);
  CHECK(near(bank.best_weight(), 1.0 / 6.0, 1e-15));
  // Never the last one.
  bank.update(reporting([&](double) { return nan; }));
  CHECK(bank.count() == 6);
}

TEST_CASE("members that agree become one, with the weight of both") {
  HeadingBank bank = bank_of(20.0 * kRadPerDeg);
  const std::size_t before = bank.count();
  REQUIRE(before > 2);
  // A fix of the attitude itself: all members take the same estimate. The bank sees it from there.
  bank.update([&](Ekf& filter) {
    filter = Ekf(filter.inertial().config(), at_equator(), diagonal_covariance());
    return reporting([](double) { return 3.0; })(filter);
  });
  CHECK(bank.collapsed());
  CHECK(near(bank.best_weight(), 1.0, 1e-12));
  CHECK(bank.covariance() == bank.best().covariance());
}

TEST_CASE("members that differ by little more than their sigma are joined in their middle") {
  const ErrorMatrix P = diagonal_covariance();
  const Ekf heavy(EkfConfig{}, at_equator(), P);
  // One and a half sigma of position (2 m) and velocity (0.1 m/s): too far to be the same, and the
  // variance of the two is below three times that of one.
  Estimate estimate = at_equator();
  estimate.nav.r_e_m.y() += 3.0;
  estimate.nav.v_e_mps.z() += 0.15;
  HeadingBank bank(heavy);
  bank.add(Ekf(EkfConfig{}, estimate, P), 0.5);
  REQUIRE(bank.count() == 2);
  bank.update(reporting([](double) { return 3.0; }));
  REQUIRE(bank.collapsed());
  // A tenth of what was known is forgotten with a measurement.
  const double odds = std::pow(0.5, 0.9);
  const double w = odds / (1.0 + odds);
  const NavState& nav = bank.best().estimate().nav;
  // Rounding of ECEF coordinates, and of numbers of the order of 1.
  CHECK(near(nav.r_e_m, at_equator().nav.r_e_m + Eigen::Vector3d(0.0, 3.0 * w, 0.0), 2e-9));
  CHECK(near(nav.v_e_mps, Eigen::Vector3d(0.0, 0.0, 0.15 * w), 1e-14));
  ErrorVector x = ErrorVector::Zero();
  x(kDr + 1) = 3.0;
  x(kDv + 2) = 0.15;
  const ErrorMatrix expected = P + w * (1.0 - w) * x * x.transpose();
  CHECK(near(bank.covariance(), expected, 1e-8));  // m^2: the rounding of 3 m, squared
}

namespace {

struct Weights {
  double incumbent;
  double other;
  double rival;
};

/// Of three filters 1 km apart: one challenged, one beside it, and the rival. Both of the first
/// refuse the fixes of 1 s and 2 s; the rival, of 1 s, explains the second.
/// @param in_part  whether they fuse the position or the velocity
Weights after_two_refusals(double imu_scale, double interval_s, bool in_part = false) {
  constexpr double kApartM = 1e3;
  const ErrorMatrix P = diagonal_covariance();
  const auto filter_at = [&](double y_m, double z_m) {
    Estimate estimate = at_equator();
    estimate.nav.r_e_m += Eigen::Vector3d(0.0, y_m, z_m);
    return Ekf(EkfConfig{}, estimate, P);
  };
  const auto fix = [in_part](double t_s, auto explains) {
    return [=](const Ekf& filter) {
      const bool fuses = explains(filter.estimate().nav.r_e_m);
      UpdateOutcome outcome;
      outcome.time = time_from_seconds(t_s);
      outcome.dof = 6;
      outcome.gate = 40.0;
      outcome.nis = fuses ? 6.0 : 500.0;
      outcome.outcome = fuses ? Outcome::kFused : Outcome::kGated;
      outcome.fused_in_part = !fuses && in_part;
      return outcome;
    };
  };
  HeadingBank bank(filter_at(0.0, 0.0));
  bank.best().scale_imu_noise(imu_scale);
  bank.add(filter_at(kApartM, 0.0), 1.0);
  bank.update(fix(0.0, [](const Eigen::Vector3d&) { return true; }));
  bank.update(fix(0.5 * interval_s, [](const Eigen::Vector3d&) { return false; }));
  bank.challenge(filter_at(0.0, kApartM), 0.5);
  bank.update(fix(interval_s, [](const Eigen::Vector3d& r_e_m) { return r_e_m.z() > 1.0; }));
  REQUIRE(bank.count() == 3);
  // About the best, the distance of each of the others shows its weight.
  const ErrorMatrix spread = (bank.covariance() - P) / (kApartM * kApartM);
  const bool is_rival_best = bank.best().estimate().nav.r_e_m.z() > 1.0;
  const double other = spread(kDr + 1, kDr + 1);
  const double first = is_rival_best ? spread(kDr + 2, kDr + 2) - other : bank.best_weight();
  return {first, other, 1.0 - first - other};
}

}  // namespace

TEST_CASE("an incumbent that goes on to refuse loses 0.5 nats per second, in part 0.1, any other at once") {
  constexpr double kIntervalS = 2.0;
  const double b = std::tanh(0.5 * kIntervalS / 2.0);
  // Two fifths, two fifths and one fifth; a tenth of what is known goes, but for the incumbent.
  const double kept = 1.0 - b / 10.0;
  const double at_once = 0.5 * b * (40.0 - 6.0 - 2.0);  // the gate, to the best NIS, less 2
  const double other = std::pow(0.4, kept) * std::exp(-at_once);
  const double rival = std::pow(0.2, kept);
  // Rounding, magnified by distances of 1 km in coordinates of 6400 km: 1e-9 m / 1e3 m.
  constexpr double kTolerance = 1e-11;
  for (const bool in_part : {false, true}) {
    const Weights seen = after_two_refusals(1.0, kIntervalS, in_part);
    const double incumbent = 0.4 * std::exp((in_part ? -0.1 : -0.5) * kIntervalS);
    const double sum = incumbent + other + rival;
    CHECK(near(seen.incumbent, incumbent / sum, kTolerance));
    CHECK(near(seen.other, other / sum, kTolerance));
  }
  // Who takes its own IMU for twice as noisy as it should be has no standing.
  const Weights seen = after_two_refusals(2.0, kIntervalS);
  CHECK(near(seen.incumbent, other / (2.0 * other + rival), kTolerance));
  CHECK(near(seen.other, seen.incumbent, kTolerance));
}

TEST_CASE("at rest heading stays unknown: ten minutes do not make a false choice" *
          doctest::test_suite("heavy")) {
  struct Case {
    std::string name;
    ImuErrorModel imu;
    bool compass;  // its gyros feel the Earth's rotation
  };
  const sim::Trajectory rest = sim::static_trajectory();
  const auto truth = sim::true_increments(rest, 5.0, 600.0);
  for (const Case& c :
       {Case{"tactical", imu_class_model(ImuClass::kTactical, RangeEnd::kMid), true},
        Case{"automotive", imu_class_model(ImuClass::kAutomotive, RangeEnd::kMid), false}}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      CAPTURE(c.name);
      CAPTURE(seed);
      EkfConfig config;
      config.imu = c.imu;
      sim::GnssErrorModel gnss;
      gnss.correlated_sigma_n_m.setConstant(2.5);
      const auto log = test::record(rest, truth, c.imu, gnss, 1.0, 1.0, seed);
      Estimate start = test::truth_estimate(rest, 0.0);
      const Eigen::Vector3d down_e = ned_to_ecef(sim::kDefaultOrigin).col(2);
      const double error_rad = 30.0 * kRadPerDeg * static_cast<double>(seed);
      start.nav.q_eb = exp_quaternion(error_rad * down_e) * start.nav.q_eb;
      const double tilt_rad = c.imu.accelerometer.bias_sigma / kStandardGravityMps2;
      const ErrorMatrix P = initial_covariance(start, {tilt_rad, 0.0, 0.1, 4.0}, c.imu);
      HeadingBank bank(config, start, P, down_e, std::numbers::pi);
      std::size_t next = 0;
      double least_rad = std::numbers::pi;
      for (const ImuIncrement& inc : log.imu) {
        bank.for_each([&](Ekf& filter) { filter.predict(inc); });
        if (next == log.fixes.size() || log.fixes[next].time != inc.time) continue;
        const GnssFix& fix = log.fixes[next++];
        bank.update([&](Ekf& filter) { return filter.update(fix); });
        least_rad = std::min(least_rad, turn_sigma_rad(bank.covariance(), down_e));
      }
      REQUIRE(next == 600);
      const ErrorVector x = difference(test::truth_estimate(rest, 600.0), bank.best().estimate());
      const double sigma_rad = turn_sigma_rad(bank.covariance(), down_e);
      MESSAGE(c.name << ", seed " << seed << ": " << bank.count() << " left, sigma "
                     << sigma_rad / kRadPerDeg << " deg, least " << least_rad / kRadPerDeg
                     << " deg, error " << x.segment<3>(kPsi).dot(down_e) / kRadPerDeg << " deg");
      CHECK(std::abs(x.segment<3>(kPsi).dot(down_e)) < 3.0 * sigma_rad);
      if (!c.compass) CHECK(least_rad > 60.0 * kRadPerDeg);
    }
  }
}

TEST_CASE("same inputs, same bits; a copy goes its own way") {
  const sim::Trajectory trajectory = sim::circle();
  const auto log = test::record(trajectory, sim::true_increments(trajectory, 20.0, 30.0),
                                automotive_mems_model(), {}, 1.0, 1.0, 1);
  const Estimate start = test::truth_estimate(trajectory, 0.0);
  const EkfConfig config;
  const Eigen::Vector3d down_e = ned_to_ecef(sim::kDefaultOrigin).col(2);
  const ErrorMatrix P = initial_covariance(start, {0.03, 0.0, 0.1, 3.0}, config.imu);
  HeadingBank a(config, start, P, down_e, std::numbers::pi);
  HeadingBank b = a;
  const auto run = [&](HeadingBank& bank) {
    std::size_t next = 0;
    for (const ImuIncrement& inc : log.imu) {
      bank.for_each([&](Ekf& filter) { filter.predict(inc); });
      if (next == log.fixes.size() || log.fixes[next].time != inc.time) continue;
      const GnssFix& fix = log.fixes[next++];
      bank.update([&](Ekf& filter) { return filter.update(fix); });
    }
  };
  run(a);
  CHECK(b.count() == 12);
  CHECK(b.best().estimate().nav.time == Time{});
  run(b);
  CHECK(a.count() < 12);
  CHECK(a.count() == b.count());
  CHECK(a.best_weight() == b.best_weight());
  CHECK(a.covariance() == b.covariance());
  CHECK(a.best().estimate().nav.q_eb.coeffs() == b.best().estimate().nav.q_eb.coeffs());
  CHECK(a.best().estimate().nav.r_e_m == b.best().estimate().nav.r_e_m);
}

TEST_CASE("an axis that is not of unit length and a negative sigma are refused") {
  const auto message = [](const Eigen::Vector3d& axis_e, double sigma_rad) {
    return test::message_of<Error>(
        [&] { HeadingBank(EkfConfig{}, at_equator(), diagonal_covariance(), axis_e, sigma_rad); });
  };
  CHECK(test::contains(message(2.0 * kUp, 1.0), "axis_e"));
  CHECK(test::contains(message(2.0 * kUp, 1.0), "2.0"));
  CHECK(test::contains(message(kUp, -1.0), "sigma_rad is -1"));
  CHECK(test::contains(message(kUp, std::numeric_limits<double>::quiet_NaN()), "must be >= 0"));
}

}  // namespace leeway
