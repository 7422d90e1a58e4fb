#include "leeway/navigator/measured_heading.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/model/claimed_solution.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/navigator/navigator.hpp"
#include "tests/filters/model/random_state.hpp"
#include "tests/filters/navigator/car.hpp"
#include "tests/filters/navigator/recording.hpp"
#include "tests/filters/navigator/same_bits.hpp"
#include "tests/support/local_trajectory.hpp"
#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::near;

constexpr double kSigmaRad = 1.0 * kRadPerDeg;
constexpr double kImuRateHz = 50.0;
const Eigen::Vector3d kStill = Eigen::Vector3d::Zero();  // of what no heading depends on

/// Holds its place to some decimetres, and turns its nose by 20 deg and back.
const sim::Trajectory& hovering() {
  static const sim::Trajectory trajectory = test::local_trajectory(120.0, [](double t_s) {
    const sim::Jet t = sim::time_jet(t_s);
    sim::LocalMotion m;
    m.north_m = 0.2 * sin(0.3 * t);
    m.east_m = 0.2 * cos(0.25 * t);
    m.down_m = -20.0 + 0.1 * sin(0.2 * t);
    m.yaw_rad = 2.0 + 0.35 * sin(0.02 * t);
    return m;
  });
  return trajectory;
}

/// Goes east at 6 m/s with its bow 20 deg into the wind, from the left.
const sim::Trajectory& crabbing() {
  static const sim::Trajectory trajectory = test::local_trajectory(120.0, [](double t_s) {
    const sim::Jet t = sim::time_jet(t_s);
    sim::LocalMotion m;
    m.east_m = 6.0 * t;
    m.yaw_rad = 70.0 * kRadPerDeg + 0.02 * sin(0.5 * t);
    m.roll_rad = 0.05 * sin(0.8 * t);
    return m;
  });
  return trajectory;
}

double true_heading_rad(const sim::Trajectory& trajectory, double t_s) {
  return ned_from_nav_state(sim::truth_at(trajectory, t_s).nav).attitude.yaw_rad;
}

/// Readings once a second from 0.3 s on, with white noise.
std::vector<MeasuredHeading> headings_of(const sim::Trajectory& trajectory, std::uint64_t seed,
                                         double sigma_rad = kSigmaRad) {
  sim::Random random(seed, 0, sim::kFirstFreeStream);
  std::vector<MeasuredHeading> headings;
  for (double t_s = 0.3; t_s < trajectory.duration_s; t_s += 1.0) {
    headings.push_back({time_from_seconds(t_s),
                        true_heading_rad(trajectory, t_s) + sigma_rad * random.normal(),
                        sigma_rad});
  }
  return headings;
}

test::Recording recording_of(const sim::Trajectory& trajectory, std::uint64_t seed) {
  return test::record(trajectory,
                      sim::true_increments(trajectory, kImuRateHz, trajectory.duration_s),
                      automotive_mems_model(), {}, 1.0, 1.0, seed);
}

NavigatorConfig config_of(VehicleKind kind) {
  NavigatorConfig config;
  config.vehicle = VehicleConfig::of(kind);
  return config;
}

/// Pushes everything after one time up to another; what is measured comes before the IMU data.
template <class F>
void run(Navigator& navigator, const test::Recording& log,
         const std::vector<MeasuredHeading>& headings, double from_s, double to_s, F&& after_imu) {
  const auto push_between = [&](const auto& messages, Time from, Time to) {
    for (const auto& m : messages) {
      if (m.time > from && m.time <= to) navigator.push(m);
    }
  };
  Time before = time_from_seconds(from_s);
  for (const ImuIncrement& inc : log.imu) {
    if (inc.time <= before || inc.time > time_from_seconds(to_s)) continue;
    push_between(log.fixes, before, inc.time);
    push_between(headings, before, inc.time);
    navigator.push(inc);
    before = inc.time;
    after_imu();
  }
}

void run(Navigator& navigator, const test::Recording& log,
         const std::vector<MeasuredHeading>& headings, double from_s, double to_s) {
  run(navigator, log, headings, from_s, to_s, [] {});
}

/// At the present: the error of heading, and its sigma.
struct HeadingError {
  double rad;
  double sigma_rad;
};

HeadingError heading_error(const Navigator& navigator, const sim::Trajectory& trajectory) {
  const Solution s = navigator.solution();
  const double truth_rad = true_heading_rad(trajectory, to_seconds(s.nav.time));
  return {wrap_pi(ned_from_nav_state(s.nav).attitude.yaw_rad - truth_rad),
          heading_sigma_rad(navigator.filter())};
}

/// At rest where hovering() begins, its heading off and as uncertain as told.
Navigator started_hovering(double off_rad, double sigma_rad) {
  Navigator navigator(config_of(VehicleKind::kMultirotor));
  Estimate start = test::truth_estimate(hovering(), 0.0);
  const Eigen::Vector3d down_e = down_e_at(start.nav.r_e_m);
  start.nav.q_eb = (exp_quaternion(off_rad * down_e) * start.nav.q_eb).normalized();
  navigator.start(start,
                  initial_covariance(start, {0.02, sigma_rad, 0.1, 3.0}, automotive_mems_model()));
  return navigator;
}

}  // namespace

TEST_CASE("H of the heading is the derivative of its innovation, in attitude and mount") {
  const ErrorVector steps = test::jacobian_steps(1e-3, 1.0, 1.0, 1.0, 1.0);
  int defined = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    const Estimate estimate = test::random_estimate(seed);
    const NavState& nav = estimate.nav;
    if (!Azimuth(nav.q_eb * Eigen::Vector3d::UnitX(), nav.r_e_m).is_defined()) continue;
    ++defined;
    // The reading of an errorless sensor on a body whose axes are the vehicle's.
    const auto reads = [](const Estimate& truth, const VehicleVector& mount) {
      const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(truth.nav.r_e_m)).transpose();
      const Eigen::Matrix3d C_nb = C_ne * truth.nav.q_eb.toRotationMatrix();
      const Eigen::Matrix3d C_bv = exp_rotation({0.0, mount(kMountPitch), mount(kMountYaw)});
      return MeasuredHeading{{}, euler_from_rotation(C_nb * C_bv).yaw_rad, kSigmaRad};
    };
    const auto innovation = [&](const Estimate& truth, const VehicleVector& mount) {
      return measurement(reads(truth, mount), estimate, VehicleVector::Zero(), kStill).innovation;
    };
    const VehicleVector none = VehicleVector::Zero();
    const Measurement m = measurement(reads(estimate, none), estimate, none, kStill);
    CHECK(near(m.innovation(0), 0.0, 1e-13));  // rounding of an angle, over 0.17
    CHECK(near(m.R(0, 0), kSigmaRad * kSigmaRad, 1e-18));
    const auto numeric = test::central_jacobian(
        [&](const ErrorVector& x) -> Eigen::Matrix<double, 1, 1> {
          Estimate truth = estimate;
          inject(truth, x);
          return innovation(truth, none);
        },
        steps);
    // Steps of 1e-3 rad: 4! (1e-3 / 0.17)^4 / 30 of a derivative of 1 / 0.17.
    CHECK(near(numeric.middleCols<3>(kPsi), m.H.middleCols<3>(kPsi), 1e-8));
    CHECK(m.H.rightCols<12>().isZero(0.0));
    for (const int angle : {kMountPitch, kMountYaw}) {
      constexpr double kStepRad = 1e-4;  // (1e-4 / 0.17)^2 of 1 / 0.17: 2e-6
      const VehicleVector step = VehicleVector::Unit(angle) * kStepRad;
      const double slope =
          (innovation(estimate, step)(0) - innovation(estimate, -step)(0)) / (2.0 * kStepRad);
      CHECK(near(slope, m.H_vehicle(0, angle), 1e-5));
    }
  }
  CHECK(defined > 80);
}

TEST_CASE("an innovation is the short way round") {
  Estimate facing;
  facing.nav.r_e_m = ecef_from_geodetic(sim::kDefaultOrigin);
  const Eigen::Matrix3d C_en = ned_to_ecef(sim::kDefaultOrigin);
  const auto off_deg = [&](double estimated_deg, double measured_deg) {
    const double yaw_rad = estimated_deg * kRadPerDeg;
    facing.nav.q_eb = Eigen::Quaterniond(C_en * rotation_from_euler({0.1, 0.2, yaw_rad}));
    const MeasuredHeading heading{{}, measured_deg * kRadPerDeg, kSigmaRad};
    return measurement(heading, facing, VehicleVector::Zero(), kStill).innovation(0) / kRadPerDeg;
  };
  constexpr double kRoundingDeg = 1e-11;
  CHECK(near(off_deg(350.0, 10.0), 20.0, kRoundingDeg));
  CHECK(near(off_deg(10.0, 350.0), -20.0, kRoundingDeg));
  CHECK(near(off_deg(10.0, -10.0), -20.0, kRoundingDeg));
  CHECK(near(off_deg(90.0, 269.0), 179.0, kRoundingDeg));
  CHECK(near(off_deg(0.0, 360.0), 0.0, kRoundingDeg));
}

TEST_CASE("refused headings are believed when they agree for longer than others were fused") {
  const auto at = [](double t_s) { return time_from_seconds(t_s); };
  constexpr double kOffRad = 3.1;
  for (const double good_s : {0.0, 20.0, 1000.0}) {
    CAPTURE(good_s);
    RefusedHeadings row;
    row.fused(at(0.0));
    row.fused(at(good_s));
    const double needed_s = std::clamp(good_s, 5.0, 300.0);
    // To either side of the way back: they agree.
    for (double t_s = 1.0; t_s < needed_s + 1.0; t_s += 1.0) {
      const double off_rad = std::fmod(t_s, 2.0) < 1.0 ? kOffRad : -kOffRad;
      REQUIRE_FALSE(row.refused(at(good_s + t_s), off_rad, kSigmaRad));
    }
    CHECK(row.refused(at(good_s + needed_s + 1.0), kOffRad, kSigmaRad));
    CHECK_FALSE(row.refused(at(good_s + needed_s + 2.0), kOffRad, kSigmaRad));  // a new row
  }
  RefusedHeadings scattered;
  for (double t_s = 0.0; t_s < 100.0; t_s += 1.0) {
    CHECK_FALSE(scattered.refused(at(t_s), 1.0 + 0.3 * std::fmod(t_s, 3.0), kSigmaRad));
  }
}

TEST_CASE("any heading is possible, one is measured: the bank is one filter at once") {
  for (const double sigma_deg : {0.3, 2.0, 5.0}) {
    CAPTURE(sigma_deg);
    Navigator navigator = started_hovering(1.0, 3.0);
    const test::Recording log = recording_of(hovering(), 1);
    run(navigator, log, {}, 0.0, 0.2);
    REQUIRE(navigator.health().state == Health::State::kHeadingOpen);
    const auto headings = headings_of(hovering(), 1, sigma_deg * kRadPerDeg);
    run(navigator, log, {headings.front()}, 0.2, 0.5);
    CHECK(navigator.count(Verdict::kFused) == 1);
    CHECK(navigator.health().state == Health::State::kAligned);
    const HeadingError error = heading_error(navigator, hovering());
    CHECK(std::abs(error.rad) < 3.0 * error.sigma_rad);
    // A member of the bank knows its own to 15 deg: the measurement decides.
    CHECK(near(error.sigma_rad, sigma_deg * kRadPerDeg, 0.1 * sigma_deg * kRadPerDeg));
  }
}

TEST_CASE("a multirotor hovers with its heading measured: within three sigma" *
          doctest::test_suite("heavy")) {
  double sum_rad2 = 0.0;
  double sigma_rad = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    Navigator navigator(config_of(VehicleKind::kMultirotor));
    double aligned_s = 0.0;
    int beyond = 0;
    run(navigator, recording_of(hovering(), seed), headings_of(hovering(), seed), 0.0, 120.0, [&] {
      if (!navigator.aligned()) return;
      const double now_s = to_seconds(navigator.solution().nav.time);
      if (aligned_s == 0.0) aligned_s = now_s;
      const HeadingError error = heading_error(navigator, hovering());
      beyond += std::abs(error.rad) > 3.0 * error.sigma_rad;
    });
    CHECK(aligned_s < 5.0);
    CHECK(beyond == 0);
    CHECK(navigator.count(Verdict::kGated) == 0);
    CHECK(navigator.health().state == Health::State::kAligned);
    const HeadingError error = heading_error(navigator, hovering());
    CHECK(error.sigma_rad < 2.0 * kSigmaRad);
    sum_rad2 += error.rad * error.rad;
    sigma_rad = error.sigma_rad;
  }
  MESSAGE("after 2 minutes " << std::sqrt(sum_rad2 / 10.0) / kRadPerDeg << " deg RMS, claimed "
                             << sigma_rad / kRadPerDeg << " deg");
}

TEST_CASE("headings whose errors last for 30 s are not believed too much, nor too little" *
          doctest::test_suite("heavy")) {
  double sum = 0.0;
  int epochs = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sim::Random random(seed, 0, sim::kFirstFreeStream);
    const double a = std::exp(-1.0 / 30.0);
    double unit_error = random.normal();
    auto headings = headings_of(hovering(), seed, 0.0);
    for (MeasuredHeading& heading : headings) {
      heading.heading_rad += kSigmaRad * unit_error;
      heading.sigma_rad = kSigmaRad;
      unit_error = a * unit_error + std::sqrt(1.0 - a * a) * random.normal();
    }
    Navigator navigator(config_of(VehicleKind::kMultirotor));
    run(navigator, recording_of(hovering(), seed), headings, 0.0, 120.0, [&] {
      if (!navigator.aligned()) return;
      const HeadingError error = heading_error(navigator, hovering());
      sum += error.rad * error.rad / (error.sigma_rad * error.sigma_rad);
      ++epochs;
    });
  }
  const double ratio = std::sqrt(sum / epochs);
  MESSAGE("error over sigma " << ratio);
  // Each run has four errors of its own, 80 in all: their RMS is known to 8 %; 3 of these.
  CHECK(ratio < 1.25);
  CHECK(ratio > 0.75);
}

TEST_CASE("a boat that crabs starts with the heading it has, not with its course") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    Navigator navigator(config_of(VehicleKind::kBoat));
    const auto headings = headings_of(crabbing(), seed, 2.0 * kRadPerDeg);
    bool has_started = false;
    run(navigator, recording_of(crabbing(), seed), headings, 0.0, 10.0, [&] {
      if (has_started || !navigator.aligned()) return;
      has_started = true;
      const HeadingError error = heading_error(navigator, crabbing());
      CAPTURE(error.rad);
      CHECK(navigator.health().state == Health::State::kAligned);
      CHECK(std::abs(error.rad) < 3.0 * error.sigma_rad);
      // Carried on by a gyro with its bias for less than a second.
      CHECK(error.sigma_rad < 4.0 * kRadPerDeg);
    });
    CHECK(has_started);
  }
}

TEST_CASE("a vehicle that is told its heading starts at rest, whatever it is") {
  for (const VehicleKind kind : kAll<VehicleKind>) {
    CAPTURE(name(kind));
    Navigator navigator(config_of(kind));
    navigator.push(MeasuredHeading{time_from_seconds(0.0), 2.0, 3.0 * kRadPerDeg});
    run(navigator, recording_of(hovering(), 1), {}, 0.0, 5.0);
    REQUIRE(navigator.aligned());
    const HeadingError error = heading_error(navigator, hovering());
    CHECK(std::abs(error.rad) < 3.0 * error.sigma_rad);
    CHECK(error.sigma_rad < HeadingBank::kOneFilterRad);
  }
}

TEST_CASE("one heading of ten is off by 180 deg: it is refused, before the start as after it") {
  for (std::size_t wrong = 0; wrong < 10; ++wrong) {
    CAPTURE(wrong);
    Navigator navigator(config_of(VehicleKind::kMultirotor));
    auto headings = headings_of(hovering(), 1);
    for (std::size_t k = wrong; k < headings.size(); k += 10) {
      headings[k].heading_rad += std::numbers::pi;
    }
    std::uint64_t aligning = 0;
    run(navigator, recording_of(hovering(), 1), headings, 0.0, 60.2, [&] {
      if (!navigator.aligned()) aligning = navigator.count(Verdict::kAligning);
    });
    CHECK(aligning > 0);
    // Of the 60 of a minute; those before the start are no verdicts of the gate.
    CHECK(navigator.count(Verdict::kGated) >= 5);
    CHECK(navigator.count(Verdict::kGated) <= 7);
    CHECK(navigator.health().state == Health::State::kAligned);
    const HeadingError error = heading_error(navigator, hovering());
    CHECK(std::abs(error.rad) < 3.0 * error.sigma_rad);
  }
}

TEST_CASE("a start with a wrong heading is not believed for good") {
  Navigator navigator = started_hovering(90.0 * kRadPerDeg, 2.0 * kRadPerDeg);
  run(navigator, recording_of(hovering(), 1), headings_of(hovering(), 1), 0.0, 20.0);
  CHECK(navigator.count(Verdict::kGated) >= 5);
  CHECK(navigator.health().state == Health::State::kAligned);
  const HeadingError error = heading_error(navigator, hovering());
  CHECK(std::abs(error.rad) < 3.0 * error.sigma_rad);
}

TEST_CASE("a compass that iron turns by 40 deg for 20 s is refused for as long") {
  Navigator navigator(config_of(VehicleKind::kMultirotor));
  auto headings = headings_of(hovering(), 1);
  for (std::size_t k = 60; k < 80; ++k) headings[k].heading_rad += 40.0 * kRadPerDeg;
  double largest = 0.0;
  run(navigator, recording_of(hovering(), 1), headings, 0.0, 100.0, [&] {
    if (!navigator.aligned()) return;
    const HeadingError error = heading_error(navigator, hovering());
    largest = std::max(largest, std::abs(error.rad) / error.sigma_rad);
  });
  CHECK(navigator.count(Verdict::kGated) == 20);
  CHECK(largest < 3.0);
}

TEST_CASE("headings that are not used say why") {
  const MeasuredHeading heading{time_from_seconds(0.5), 1.0, kSigmaRad};
  const test::Recording log = recording_of(hovering(), 1);
  const auto answer = [&](Navigator navigator) {
    run(navigator, log, {}, 0.0, 1.0);
    return navigator.push(heading);
  };
  NavigatorConfig off;
  off.vehicle.heading = false;
  CHECK(answer(Navigator(off)) == Verdict::kUnused);
  NavigatorConfig seeking_mount;
  seeking_mount.C_bs.reset();
  CHECK(answer(Navigator(seeking_mount)) == Verdict::kAligning);
  // On its tail the x axis is vertical, and points nowhere over ground.
  Navigator on_its_tail{NavigatorConfig{}};
  Estimate start = test::truth_estimate(hovering(), 0.0);
  const Eigen::Quaterniond nose_up(rotation_from_euler({0.0, 85.0 * kRadPerDeg, 0.0}));
  start.nav.q_eb = (start.nav.q_eb * nose_up).normalized();
  on_its_tail.start(start, initial_covariance(start, {}, automotive_mems_model()));
  CHECK(answer(on_its_tail) == Verdict::kUnused);
  Navigator navigator{NavigatorConfig{}};
  CHECK(navigator.push(MeasuredHeading{{}, NAN, 0.1}) == Verdict::kNotFinite);
  CHECK(navigator.push(MeasuredHeading{{}, 7.0, 0.1}) == Verdict::kImplausible);
  CHECK(navigator.push(MeasuredHeading{{}, 1.0, 0.0}) == Verdict::kImplausible);
}

TEST_CASE("headings are the vehicle's: with a mount 3 deg off they help to find it" *
          doctest::test_suite("heavy")) {
  const Eigen::Vector3d mount_rad(0.0, 0.0, 3.0 * kRadPerDeg);
  NavigatorConfig config = config_of(VehicleKind::kCar);
  config.vehicle.rear_axle_x_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    test::CarOptions options;
    options.C_sv = exp_rotation(mount_rad);
    Navigator navigator = test::started_car(config, options.C_sv);
    sim::Random random(seed, 1, sim::kFirstFreeStream);
    const Duration second = std::chrono::seconds{1};
    test::run(navigator, test::drive(options, seed), 100.0, {}, [&](const ImuIncrement& inc) {
      if (inc.time.time_since_epoch() % second != Duration{0}) return;
      const double heading_rad = true_heading_rad(test::stop_and_go(), to_seconds(inc.time));
      navigator.push(
          MeasuredHeading{inc.time, heading_rad + kSigmaRad * random.normal(), kSigmaRad});
    });
    const VehicleState& vehicle = *navigator.filter().vehicle();
    const double sigma_rad = std::sqrt(vehicle.P(kMountYaw, kMountYaw));
    CHECK(near(vehicle.value(kMountYaw), mount_rad.z(), 3.0 * sigma_rad));
    CHECK(sigma_rad < kSigmaRad);
    CHECK(navigator.count(Verdict::kGated) <= 1);
  }
}

TEST_CASE("the heading of a fix counts as one that came by itself") {
  test::Recording log = recording_of(hovering(), 1);
  std::vector<MeasuredHeading> alone;
  test::Recording without = log;
  for (GnssFix& fix : log.fixes) {
    const double heading_rad = true_heading_rad(hovering(), to_seconds(fix.time));
    fix.heading = {heading_rad, kSigmaRad};
    alone.push_back({fix.time, heading_rad, kSigmaRad});
  }
  Navigator whole(config_of(VehicleKind::kMultirotor));
  run(whole, log, {}, 0.0, 20.0);
  Navigator apart(config_of(VehicleKind::kMultirotor));
  run(apart, without, alone, 0.0, 20.0);
  CHECK(whole.health().state == Health::State::kAligned);
  CHECK(test::same_bits(whole, apart));
  CHECK(whole.count(Verdict::kFused) == apart.count(Verdict::kFused));
  CHECK(whole.count(Verdict::kFused) > 30);  // of 20 fixes and 20 headings
}

TEST_CASE("a navigator restored amid headings goes on bit by bit" * doctest::test_suite("heavy")) {
  const test::Recording log = recording_of(hovering(), 1);
  auto headings = headings_of(hovering(), 1);
  for (std::size_t k = 30; k < 34; ++k) headings[k].heading_rad += 1.0;  // a row of refused ones
  Navigator original(config_of(VehicleKind::kMultirotor));
  double now_s = 0.0;
  for (const double at_s : {0.61, 1.51, 10.5, 32.5}) {
    CAPTURE(at_s);
    run(original, log, headings, now_s, at_s);
    now_s = at_s;
    Navigator restored(config_of(VehicleKind::kMultirotor));
    CHECK(restored.restore(test::bytes_of(original)) == Restore::kRestored);
    Navigator other = original;
    run(restored, log, headings, at_s, at_s + 10.0);
    run(other, log, headings, at_s, at_s + 10.0);
    CHECK(test::same_bits(restored, other));
    CHECK(test::bytes_of(restored) == test::bytes_of(other));
  }
}

}  // namespace leeway
