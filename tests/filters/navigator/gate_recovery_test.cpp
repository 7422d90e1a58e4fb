#include "leeway/navigator/gate_recovery.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/model/initial_covariance.hpp"

namespace leeway {
namespace {

constexpr VehicleLimits kCar = limits_of(VehicleKind::kCar);

/// North along a meridian at 10 m/s, and as far east as told.
GnssFix fix_at(double t_s, double east_m = 0.0) {
  constexpr double kLat = 45.0 * kRadPerDeg;
  const Geodetic place{kLat + 10.0 * t_s / 6.37e6, east_m / (6.37e6 * std::cos(kLat)), 0.0};
  GnssFix fix{time_from_seconds(t_s)};
  const Eigen::Matrix3d R = 0.01 * Eigen::Matrix3d::Identity();
  fix.position = GnssPosition::from_geodetic(place, R);
  fix.velocity = GnssVelocity::from_ned(place, {10.0, 0.0, 0.0}, R);
  return fix;
}

/// Where a right fix says.
Ekf filter_at(double t_s) {
  const GnssFix fix = fix_at(t_s);
  Estimate estimate;
  estimate.nav.time = fix.time;
  estimate.nav.r_e_m = fix.position->r_e_m;
  estimate.nav.v_e_mps = fix.velocity->v_e_mps;
  const InitialSigma sigma{
      .tilt_rad = 0.01, .heading_rad = 0.05, .velocity_mps = 0.1, .position_m = 0.1};
  return {EkfConfig{}, estimate, initial_covariance(estimate, sigma, EkfConfig{}.imu)};
}

/// Good for so long, by a fix a second.
GateRecovery good_until(double t_s) {
  GateRecovery recovery(kCar);
  recovery.begin(time_from_seconds(0.0));
  for (double t = 1.0; t <= t_s; t += 1.0) recovery.fused(fix_at(t), filter_at(t));
  return recovery;
}

TEST_CASE("a fix where the vehicle cannot be is refused until it could, at any rate of fixes") {
  for (const double interval_s : {0.1, 1.0, 5.0}) {
    CAPTURE(interval_s);
    GateRecovery recovery = good_until(100.0);
    double reached_s = 0.0;
    for (double t_s = interval_s; reached_s == 0.0 && t_s < 60.0; t_s += interval_s) {
      if (recovery.odds_of(fix_at(100.0 + t_s, 1000.0)) > 0.0) reached_s = t_s;
    }
    // a t^2 / 2 = 1000 m at 10 m/s^2 is 14.1 s; five sigmas of 0.1 m/s shorten it by 0.1 s.
    CHECK(reached_s >= 14.0);
    CHECK(reached_s <= 14.2 + interval_s);
  }
}

TEST_CASE("fixes that agree for longer than the filter was confirmed are heard wherever they are") {
  GateRecovery recovery = good_until(20.0);
  double heard_s = 0.0;
  for (double t_s = 1.0; heard_s == 0.0 && t_s < 100.0; t_s += 1.0) {
    if (recovery.odds_of(fix_at(20.0 + t_s, 5e6)) > 0.0) heard_s = t_s;
  }
  CHECK(heard_s == doctest::Approx(22.0));  // longer than 20 s, counted from the first of them
}

TEST_CASE("the longer the filter was without a fix, the more a refused one is believed") {
  const auto odds_after = [](double t_s) {
    GateRecovery recovery = good_until(100.0);
    return recovery.odds_of(fix_at(100.0 + t_s, 3.0));
  };
  CHECK(odds_after(1.0) == doctest::Approx(0.1));
  CHECK(odds_after(5.0) == doctest::Approx(0.5));
  CHECK(odds_after(60.0) == 1.0);
}

TEST_CASE("a row of refusals begins with the first and ends with a fix that is fused") {
  GateRecovery recovery = good_until(10.0);
  CHECK_FALSE(recovery.is_row());
  recovery.odds_of(fix_at(11.0, 3.0));
  recovery.odds_of(fix_at(12.0, 3.0));
  REQUIRE(recovery.since());
  CHECK(*recovery.since() == time_from_seconds(11.0));
  recovery.fused(fix_at(13.0), filter_at(13.0));
  CHECK_FALSE(recovery.is_row());
}

TEST_CASE("the rival is where the fix says, antenna and IMU told apart, attitude as it was") {
  EkfConfig config;
  config.lever_arm_b_m = {1.0, 0.5, -2.0};
  const Ekf base = filter_at(10.0);
  const Ekf filter(config, base.estimate(), base.covariance());
  const GnssFix fix = fix_at(10.0, 50.0);
  UpdateOutcome refusal;
  refusal.nis = 400.0;
  refusal.gate = 40.0;
  const Ekf rival = rival_of(filter, fix, refusal, 1.0);
  const Eigen::Vector3d antenna_e_m =
      rival.estimate().nav.r_e_m + rival.estimate().nav.q_eb * config.lever_arm_b_m;
  CHECK((antenna_e_m - fix.position->r_e_m).norm() < 1e-6);  // m: rounding at the Earth's radius
  CHECK(rival.estimate().nav.q_eb.coeffs() == filter.estimate().nav.q_eb.coeffs());
  CHECK(rival.covariance()(kPsi, kPsi) == filter.covariance()(kPsi, kPsi));
  CHECK(rival.inertial().noise_scale() == 2.0);
  // Refused again, it doubts attitude and biases too, as far as the refusal goes.
  const Ekf second = rival_of(rival, fix, refusal, 1.0);
  CHECK(second.covariance()(kBg, kBg) == doctest::Approx(10.0 * filter.covariance()(kBg, kBg)));
}

TEST_CASE("where the position alone was refused the rival doubts nothing else") {
  EkfConfig config;
  config.lever_arm_b_m = {1.0, 0.5, -2.0};
  Estimate estimate = filter_at(10.0).estimate();
  estimate.nav.q_eb = Eigen::Quaterniond(rotation_from_euler({0.1, -0.2, 0.7}));
  estimate.bias = {{0.1, -0.2, 0.3}, {1e-3, 2e-3, -3e-3}};
  Ekf filter(config, estimate, filter_at(10.0).covariance());
  filter.scale_imu_noise(3.0);
  const GnssFix fix = fix_at(10.0, 50.0);
  UpdateOutcome refusal;
  refusal.nis = 502.0;
  refusal.gate = 40.0;
  refusal.position_nis = 500.0;
  refusal.velocity_nis = 2.0;
  refusal.fused_in_part = true;
  REQUIRE(refuses_position_alone(refusal));
  const Ekf rival = rival_of(filter, fix, refusal, 1.0);
  const Eigen::Vector3d antenna_e_m =
      rival.estimate().nav.r_e_m + rival.estimate().nav.q_eb * config.lever_arm_b_m;
  CHECK((antenna_e_m - fix.position->r_e_m).norm() < 1e-6);  // m: rounding at the Earth's radius
  // The rest is copied: to the bit.
  CHECK(rival.estimate().nav.v_e_mps == filter.estimate().nav.v_e_mps);
  CHECK(rival.estimate().nav.q_eb.coeffs() == filter.estimate().nav.q_eb.coeffs());
  CHECK(rival.estimate().bias.b_a_mps2 == filter.estimate().bias.b_a_mps2);
  CHECK(rival.estimate().bias.b_g_radps == filter.estimate().bias.b_g_radps);
  CHECK(rival.inertial().noise_scale() == 3.0);
  ErrorVector variance = filter.covariance().diagonal();
  variance.segment<3>(kDr) = fix.position->R_e_m2.diagonal();
  CHECK(rival.covariance().diagonal() == variance);
  // Where the velocity was refused, and the position fused, the whole is in doubt.
  std::swap(refusal.position_nis, refusal.velocity_nis);
  CHECK_FALSE(refuses_position_alone(refusal));
  CHECK(rival_of(filter, fix, refusal, 1.0).inertial().noise_scale() == 6.0);
}

}  // namespace
}  // namespace leeway
