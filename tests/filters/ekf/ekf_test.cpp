#include "leeway/ekf/ekf.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "leeway/covariance/covariance.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/model/chi_square.hpp"
#include "leeway/model/claimed_solution.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "tests/filters/model/random_state.hpp"
#include "tests/filters/navigator/recording.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::at_equator;
using test::near;
using test::Wide;
using Outcome = UpdateOutcome::Outcome;

/// Errorless sensors, white fixes: closed forms apply.
EkfConfig plain_config() {
  EkfConfig config;
  config.imu = ImuErrorModel{};
  config.gnss_correlation_s = 0.0;
  return config;
}

/// At rest on the equator at t = 0, body axes along ECEF.
ErrorMatrix diagonal_covariance(double psi, double dv, double dr, double b_a, double b_g) {
  return test::jacobian_steps(psi, dv, dr, b_a, b_g).cwiseAbs2().asDiagonal();
}

GnssFix position_fix(const Eigen::Vector3d& r_e_m, double sigma_m, double t_s = 0.0) {
  GnssFix fix;
  fix.time = time_from_seconds(t_s);
  fix.position = GnssPosition{r_e_m, sigma_m * sigma_m * Eigen::Matrix3d::Identity()};
  return fix;
}

bool same_bits(const Ekf& a, const Ekf& b) {
  return a.estimate().nav.q_eb.coeffs() == b.estimate().nav.q_eb.coeffs() &&
         a.estimate().nav.v_e_mps == b.estimate().nav.v_e_mps &&
         a.estimate().nav.r_e_m == b.estimate().nav.r_e_m &&
         a.estimate().bias.b_a_mps2 == b.estimate().bias.b_a_mps2 &&
         a.estimate().bias.b_g_radps == b.estimate().bias.b_g_radps &&
         a.covariance() == b.covariance();
}

Eigen::Matrix3d random_covariance3(sim::Random& random, double sigma) {
  Eigen::Matrix3d A;
  for (double& a : A.reshaped()) a = sigma * random.normal();
  return A * A.transpose() + 0.01 * sigma * sigma * Eigen::Matrix3d::Identity();
}

Wide wide(const Eigen::MatrixXd& m) { return m.cast<long double>(); }

}  // namespace

TEST_CASE("a position fix in closed form: variances 4 and 1 share 5 m as 4 to 1") {
  Ekf ekf(plain_config(), at_equator(), diagonal_covariance(0.0, 0.1, 2.0, 0.0, 0.0));
  const Eigen::Vector3d offset_m(0.0, 5.0, 0.0);
  const UpdateOutcome outcome = ekf.update(position_fix(at_equator().nav.r_e_m + offset_m, 1.0));
  CHECK(outcome.outcome == Outcome::kFused);
  CHECK(outcome.dof == 3);
  CHECK(near(outcome.nis, 25.0 / 5.0, 1e-14));
  CHECK(outcome.covariance_positive == false);  // nothing is unknown but position and velocity
  CHECK(near(ekf.estimate().nav.r_e_m - at_equator().nav.r_e_m, 0.8 * offset_m, 2e-9));
  CHECK(near(ekf.covariance().diagonal().segment<3>(kDr), Eigen::Vector3d::Constant(0.8), 1e-15));
  CHECK(near(ekf.covariance().diagonal().segment<3>(kDv), Eigen::Vector3d::Constant(0.01), 1e-16));
}

TEST_CASE("a whole fix against the dense Kalman update in long double, and the reset") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    sim::Random random(seed, 8);
    EkfConfig config = plain_config();
    config.lever_arm_b_m = test::random_vector(random, 5.0);
    const ErrorVector sigmas = test::jacobian_steps(0.03, 0.3, 5.0, 0.1, 0.01);
    ErrorMatrix A;
    for (double& a : A.reshaped()) a = random.normal();
    A = sigmas.asDiagonal() * A;
    const ErrorMatrix P = A * A.transpose();
    Ekf ekf(config, test::random_estimate(seed), P);
    const ImuIncrement inc{Time{} + duration_from_seconds(0.01), 0.01,
                           0.01 * test::random_vector(random, 3.0),
                           0.01 * test::random_vector(random, 20.0)};
    ekf.predict(inc);
    const ErrorMatrix P_before = ekf.covariance();
    const Estimate before = ekf.estimate();

    Estimate elsewhere = before;
    inject(elsewhere,
           sigmas.cwiseProduct(ErrorVector::NullaryExpr([&] { return random.normal(); })));
    const Eigen::Vector3d omega_b_radps = inc.dtheta_b_rad / inc.dt_s;
    GnssFix fix;
    fix.time = inc.time;
    fix.position = GnssPosition{antenna_position_e(elsewhere, config.lever_arm_b_m),
                                random_covariance3(random, 2.0)};
    fix.velocity = GnssVelocity{antenna_velocity_e(elsewhere, config.lever_arm_b_m, omega_b_radps),
                                random_covariance3(random, 0.1)};
    const Measurement m = gnss_measurement(fix, before, config.lever_arm_b_m, omega_b_radps);
    const test::DenseUpdate dense =
        test::dense_update(wide(P_before), wide(m.H), wide(m.R), wide(m.innovation));
    const ErrorVector x_hat = dense.x;
    ErrorMatrix P_after = dense.P;
    transform_block(P_after, kPsi, reset_jacobian(x_hat));
    Estimate after = before;
    inject(after, x_hat);

    const UpdateOutcome outcome = ekf.update(fix);
    REQUIRE(outcome.outcome == Outcome::kFused);
    CHECK(outcome.covariance_positive);
    CHECK(near(outcome.nis / dense.nis, 1.0, 1e-9));
    // Six rows of a prior up to 50 times wider than the fix.
    CHECK(test::scaled_distance(ekf.covariance(), P_after) < 1e-9);
    const ErrorVector off = difference(ekf.estimate(), after).cwiseQuotient(sigmas);
    CHECK(off.cwiseAbs().maxCoeff() < 1e-8);  // ECEF rounds to 1e-9 m, the position sigma is 5 m
    CHECK(ekf.covariance() == ekf.covariance().transpose());
  }
}

TEST_CASE("with the vehicle's parameters: the dense Kalman update of all twenty, in long double") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    sim::Random random(seed, 8);
    JointVector sigmas;
    sigmas << test::jacobian_steps(0.03, 0.3, 5.0, 0.1, 0.01), 0.05, 0.05, 0.5, 0.03, 10.0;
    JointMatrix A;
    for (double& a : A.reshaped()) a = random.normal();
    A = sigmas.asDiagonal() * A;
    const JointMatrix P = A * A.transpose();
    const Estimate before = test::random_estimate(seed);
    Ekf ekf(plain_config(), before, P.topLeftCorner<kErrorStates, kErrorStates>());
    VehicleState vehicle;
    for (double& v : vehicle.value) v = random.normal();
    vehicle.P = P.bottomRightCorner<kVehicleStates, kVehicleStates>();
    vehicle.cross = P.topRightCorner<kErrorStates, kVehicleStates>();
    CHECK_FALSE(ekf.vehicle().has_value());
    edit(ekf, [&](Belief& belief) { belief.vehicle = vehicle; });
    CHECK(ekf.vehicle().has_value());

    Measurement m(1 + static_cast<int>(seed % 6));
    for (double& h : m.H.reshaped()) h = random.normal();
    m.H = (m.H * sigmas.head<kErrorStates>().cwiseInverse().asDiagonal()).eval();
    for (double& h : m.H_vehicle.reshaped()) h = random.normal();
    m.H_vehicle = (m.H_vehicle * sigmas.tail<kVehicleStates>().cwiseInverse().asDiagonal()).eval();
    for (double& z : m.innovation) z = random.normal();
    Eigen::MatrixXd B(m.rows(), m.rows());
    for (double& b : B.reshaped()) b = random.normal();
    m.R = B * B.transpose() + 0.1 * Eigen::MatrixXd::Identity(m.rows(), m.rows());

    Wide H(m.rows(), kJointStates);
    H << wide(m.H), wide(m.H_vehicle);
    const test::DenseUpdate dense = test::dense_update(wide(P), H, wide(m.R), wide(m.innovation));
    const JointVector x_hat = dense.x;
    const Eigen::Matrix3d J = reset_jacobian(x_hat.head<kErrorStates>());
    JointMatrix P_after = dense.P;
    P_after.topRows<3>() = (J * P_after.topRows<3>()).eval();
    P_after.leftCols<3>() = (P_after.leftCols<3>() * J.transpose()).eval();
    Estimate after = before;
    inject(after, x_hat.head<kErrorStates>());

    const UpdateOutcome outcome = ekf.update(m);
    REQUIRE(outcome.outcome == Outcome::kFused);
    CHECK(outcome.dof == m.rows());
    CHECK(near(outcome.nis / dense.nis, 1.0, 1e-9));
    CHECK(near(outcome.log_det_S, std::log(dense.det_S), 1e-9));
    JointMatrix P_joint;
    P_joint << ekf.covariance(), ekf.vehicle()->cross, ekf.vehicle()->cross.transpose(),
        ekf.vehicle()->P;
    CHECK(test::scaled_distance(P_joint, P_after) < 1e-9);
    const ErrorVector off =
        difference(ekf.estimate(), after).cwiseQuotient(sigmas.head<kErrorStates>());
    CHECK(off.cwiseAbs().maxCoeff() < 1e-8);  // ECEF rounds to 1e-9 m, the position sigma is 5 m
    const VehicleVector vehicle_off =
        (ekf.vehicle()->value - vehicle.value - x_hat.tail<kVehicleStates>())
            .cwiseQuotient(sigmas.tail<kVehicleStates>());
    CHECK(vehicle_off.cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("the vehicle's parameters through time: the cross covariance follows Phi, P its walk") {
  const sim::Trajectory trajectory = sim::circle();
  const Estimate start = test::truth_estimate(trajectory, 0.0);
  Ekf with(EkfConfig{}, start, diagonal_covariance(0.03, 0.3, 5.0, 0.1, 0.01));
  VehicleState vehicle;
  vehicle.P.diagonal() << 1.0, 2.0, 3.0, 4.0, 5.0;
  vehicle.random_walk_per_s << 0.1, 0.2, 0.3, 0.4, 0.5;
  vehicle.cross = 0.01 * VehicleCross::Random();
  edit(with, [&](Belief& belief) { belief.vehicle = vehicle; });
  Ekf without(EkfConfig{}, start, diagonal_covariance(0.03, 0.3, 5.0, 0.1, 0.01));
  for (const ImuIncrement& inc : sim::true_increments(trajectory, 100.0, 2.0)) {
    with.predict(inc);
    without.predict(inc);
  }
  // Parameters that nothing has been measured of leave the 15 states alone.
  CHECK(same_bits(with, without));
  // 0.1 s at a time: after 2 s the walk of 20 of them.
  CHECK(near(with.vehicle()->P.diagonal(), vehicle.P.diagonal() + 2.0 * vehicle.random_walk_per_s,
             1e-12));
  // A velocity error that goes with a parameter has become a position error: 2 s, to the turn of
  // the Earth (1e-4 rad/s) and what the attitude adds: 10 m/s^2 for 2 s, twice integrated.
  const VehicleCross& cross = with.vehicle()->cross;
  const Eigen::Matrix<double, 3, kVehicleStates> moved = cross.middleRows<3>(kDr) -
                                                         vehicle.cross.middleRows<3>(kDr) -
                                                         2.0 * vehicle.cross.middleRows<3>(kDv);
  const double from_attitude = 0.5 * 4.0 * 10.0 * vehicle.cross.middleRows<3>(kPsi).norm();
  const double from_bias = 0.5 * 4.0 * vehicle.cross.middleRows<3>(kBa).norm();
  CHECK(moved.norm() < 1.2 * (from_attitude + from_bias));
  // A turn-on bias is constant, and so is what goes with it.
  CHECK(near(cross.middleRows<3>(kBg), vehicle.cross.middleRows<3>(kBg), 1e-15));
}

TEST_CASE("widen multiplies every covariance and moves nothing") {
  Ekf ekf(EkfConfig{}, at_equator(), diagonal_covariance(0.01, 0.1, 2.0, 0.1, 0.01));
  VehicleState vehicle;
  vehicle.P.setIdentity();
  vehicle.cross.setConstant(0.001);
  edit(ekf, [&](Belief& belief) { belief.vehicle = vehicle; });
  const Ekf before = ekf;
  edit(ekf, [](Belief& belief) { widen(belief, 4.0); });
  CHECK(near(ekf.covariance(), 4.0 * before.covariance(), 1e-15));
  CHECK(near(ekf.vehicle()->P, 4.0 * vehicle.P, 1e-15));
  CHECK(near(ekf.vehicle()->cross, 4.0 * vehicle.cross, 1e-15));
  CHECK(ekf.estimate().nav.r_e_m == before.estimate().nav.r_e_m);
  CHECK(ekf.estimate().nav.v_e_mps == before.estimate().nav.v_e_mps);
}

TEST_CASE("turn_body_axes renames: same motion in n, the same filter from there on") {
  // Two filters of one IMU, whose axes one of them renames half way.
  const sim::Trajectory trajectory = sim::manoeuvre_car();
  const auto truth = sim::true_increments(trajectory, 100.0, 4.0);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    sim::Random random(seed, 8);
    const Eigen::Matrix3d C_new_old =
        Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
            .normalized()
            .toRotationMatrix();
    EkfConfig config;
    config.lever_arm_b_m = {1.0, -0.5, 0.3};
    Estimate start = test::truth_estimate(trajectory, 0.0);
    start.bias.b_a_mps2 = {0.1, 0.2, -0.3};
    start.bias.b_g_radps = {0.001, -0.002, 0.003};
    ErrorMatrix A;
    for (double& a : A.reshaped()) a = random.normal();
    A = test::jacobian_steps(0.01, 0.1, 1.0, 0.05, 0.001).asDiagonal() * A;
    Ekf old(config, start, A * A.transpose());
    for (std::size_t k = 0; k < 200; ++k) old.predict(truth[k]);
    Ekf renamed = old;
    const Solution before = solution(old.estimate(), old.covariance());
    renamed.turn_body_axes(C_new_old, C_new_old * config.lever_arm_b_m);

    CHECK(near(renamed.estimate().bias.b_a_mps2, C_new_old * old.estimate().bias.b_a_mps2, 1e-15));
    CHECK(
        near(renamed.estimate().bias.b_g_radps, C_new_old * old.estimate().bias.b_g_radps, 1e-15));
    CHECK(near(renamed.inertial().omega_ib_b_radps(), C_new_old * old.inertial().omega_ib_b_radps(),
               1e-14));
    CHECK(near(renamed.inertial().mean_omega_ib_b_radps(),
               C_new_old * old.inertial().mean_omega_ib_b_radps(), 1e-14));
    CHECK(near(renamed.estimate().nav.q_eb.toRotationMatrix() * C_new_old,
               old.estimate().nav.q_eb.toRotationMatrix(), 1e-14));
    const Solution after = solution(renamed.estimate(), renamed.covariance());
    CHECK(after.nav.r_e_m == before.nav.r_e_m);
    CHECK(after.nav.v_e_mps == before.nav.v_e_mps);
    CHECK(after.sigma_position_n_m == before.sigma_position_n_m);
    CHECK(after.sigma_velocity_n_mps == before.sigma_velocity_n_mps);

    // The same fixes and the same data in other axes lead to the same place.
    for (std::size_t k = 200; k < 400; ++k) {
      ImuIncrement inc = truth[k];
      old.predict(inc);
      inc.dtheta_b_rad = (C_new_old * inc.dtheta_b_rad).eval();
      inc.dv_b_mps = (C_new_old * inc.dv_b_mps).eval();
      renamed.predict(inc);
    }
    GnssFix fix = position_fix(old.estimate().nav.r_e_m + random.normal3(), 2.0, 4.0);
    fix.velocity = GnssVelocity{old.estimate().nav.v_e_mps, 0.01 * Eigen::Matrix3d::Identity()};
    CHECK(old.update(fix).outcome == Outcome::kFused);
    CHECK(renamed.update(fix).outcome == Outcome::kFused);
    // 200 steps of rounding in ECEF.
    CHECK(near(renamed.estimate().nav.r_e_m, old.estimate().nav.r_e_m, 1e-6));
    CHECK(near(renamed.estimate().nav.v_e_mps, old.estimate().nav.v_e_mps, 1e-9));
    ErrorMatrix turn = ErrorMatrix::Identity();
    turn.block<3, 3>(kBa, kBa) = C_new_old;
    turn.block<3, 3>(kBg, kBg) = C_new_old;
    CHECK(test::scaled_distance(renamed.covariance(),
                                (turn * old.covariance() * turn.transpose()).eval()) < 1e-9);
  }
}

TEST_CASE("restart_motion: position and velocity anew, attitude and biases as they were") {
  sim::Random random(1, 8);
  ErrorMatrix A;
  for (double& a : A.reshaped()) a = random.normal();
  A = test::jacobian_steps(0.01, 0.1, 1.0, 0.05, 0.001).asDiagonal() * A;
  Ekf ekf(EkfConfig{}, at_equator(), A * A.transpose());
  VehicleState vehicle;
  vehicle.P.setIdentity();
  vehicle.cross.setConstant(0.001);
  edit(ekf, [&](Belief& belief) { belief.vehicle = vehicle; });
  const Ekf before = ekf;
  const Eigen::Vector3d r_e_m = at_equator().nav.r_e_m + Eigen::Vector3d(10.0, 300.0, -500.0);
  const Eigen::Vector3d v_e_mps(1.0, 20.0, 3.0);
  const Eigen::Matrix3d P_rr = random_covariance3(random, 2.0);
  const Eigen::Matrix3d P_vv = random_covariance3(random, 0.1);
  edit(ekf, [&](Belief& belief) { restart_motion(belief, r_e_m, P_rr, v_e_mps, P_vv); });
  CHECK(ekf.estimate().nav.r_e_m == r_e_m);
  CHECK(ekf.estimate().nav.v_e_mps == v_e_mps);
  CHECK(ekf.estimate().nav.q_eb.coeffs() == before.estimate().nav.q_eb.coeffs());
  const ErrorMatrix P = ekf.covariance();
  const ErrorMatrix P_before = before.covariance();
  CHECK(P.block<3, 3>(kDv, kDv) == P_vv);
  CHECK(P.block<3, 3>(kDr, kDr) == P_rr);
  CHECK(P.block<3, 3>(kDr, kDv).isZero(0.0));
  for (const int kept : {kPsi, kBa, kBg}) {
    CHECK(P.block<3, 6>(kept, kDv).isZero(0.0));
    CHECK(P.block<6, 3>(kDv, kept).isZero(0.0));
    for (const int other : {kPsi, kBa, kBg}) {
      CHECK(P.block<3, 3>(kept, other) == P_before.block<3, 3>(kept, other));
    }
    CHECK(ekf.vehicle()->cross.middleRows<3>(kept) == vehicle.cross.middleRows<3>(kept));
  }
  CHECK(ekf.vehicle()->cross.middleRows<6>(kDv).isZero(0.0));
  CHECK(ekf.vehicle()->P == vehicle.P);
}

TEST_CASE("repair_covariance makes an indefinite P positive definite, and says so") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    sim::Random random(seed, 8);
    const ErrorVector sigmas = test::jacobian_steps(0.01, 0.1, 1.0, 0.05, 0.001);
    ErrorMatrix A;
    for (double& a : A.reshaped()) a = random.normal();
    const test::Spectrum spectrum = test::spectrum_of(A * A.transpose());
    const ErrorMatrix vectors = spectrum.vectors;
    ErrorVector values = spectrum.values;
    values(0) = -1e-6;
    values(1) = 0.0;
    const ErrorMatrix whole = vectors * values.asDiagonal() * vectors.transpose();
    ErrorMatrix P = sigmas.asDiagonal() * whole * sigmas.asDiagonal();
    P = (0.5 * (P + P.transpose())).eval();
    REQUIRE(P.diagonal().minCoeff() > 0.0);
    Ekf ekf(EkfConfig{}, at_equator(), P);
    CHECK_FALSE(repair_covariance(ekf));
    const ErrorMatrix repaired = ekf.covariance();
    CHECK(repaired == repaired.transpose());
    const Eigen::LLT<ErrorMatrix> llt(repaired);
    CHECK(llt.info() == Eigen::Success);
    // What was negative by a millionth of the correlations is now a billionth.
    CHECK(test::scaled_distance(repaired, P) < 1e-5);
    CHECK(repair_covariance(ekf));
    CHECK(ekf.covariance() == repaired);
  }
  Ekf healthy(EkfConfig{}, at_equator(), diagonal_covariance(0.01, 0.1, 2.0, 0.1, 0.01));
  const Ekf before = healthy;
  CHECK(repair_covariance(healthy));
  CHECK(same_bits(healthy, before));
}

TEST_CASE("the gate refuses a 100 m outlier whole and changes nothing") {
  const ErrorMatrix P = diagonal_covariance(0.01, 0.1, 2.0, 0.1, 0.01);
  Ekf ekf(EkfConfig{}, at_equator(), P);
  const Ekf untouched = ekf;
  GnssFix fix = position_fix(at_equator().nav.r_e_m + Eigen::Vector3d(0.0, 100.0, 0.0), 2.0);
  fix.velocity = GnssVelocity{};  // right, but of the same receiver
  const UpdateOutcome outcome = ekf.update(fix);
  CHECK(outcome.outcome == Outcome::kGated);
  CHECK(near(outcome.gate, 38.26, 0.01));  // chi-square, 6 degrees, 1e-6
  CHECK(near(outcome.nis, 1e4 / 8.0, 0.1));
  CHECK(same_bits(ekf, untouched));
  fix.position->r_e_m.y() = 4.0;
  CHECK(ekf.update(fix).outcome == Outcome::kFused);
}

TEST_CASE("a gate probability of 0 lets everything in") {
  EkfConfig config;
  config.gate_probability = 0.0;
  Ekf ekf(config, at_equator(), diagonal_covariance(0.01, 0.1, 2.0, 0.1, 0.01));
  const Eigen::Vector3d far_m(0.0, 1e5, 0.0);
  CHECK(ekf.update(position_fix(at_equator().nav.r_e_m + far_m, 2.0)).outcome == Outcome::kFused);
  CHECK(near(ekf.estimate().nav.r_e_m.y(), 5e4, 1e-6));
}

TEST_CASE("an unusable fix changes nothing") {
  Ekf ekf(EkfConfig{}, at_equator(), diagonal_covariance(0.01, 0.1, 2.0, 0.1, 0.01));
  const Ekf untouched = ekf;
  CHECK(ekf.update(GnssFix{}).outcome == Outcome::kUnusable);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(ekf.update(position_fix({nan, 0.0, 0.0}, 1.0)).outcome == Outcome::kUnusable);
  CHECK(ekf.update(position_fix(at_equator().nav.r_e_m, nan)).outcome == Outcome::kUnusable);
  CHECK(same_bits(ekf, untouched));
}

TEST_CASE("a position that repeats the error of the last one weighs (1 - a) / (1 + a)") {
  EkfConfig config = plain_config();
  config.gnss_correlation_s = 30.0;
  // Position alone is uncertain, and nothing drives it.
  Ekf ekf(config, at_equator(), diagonal_covariance(0.0, 0.0, 2.0, 0.0, 0.0));
  const auto information = [&] { return 1.0 / ekf.covariance()(kDr + 1, kDr + 1); };
  const auto fuse_here = [&] {
    ekf.update(position_fix(ekf.estimate().nav.r_e_m, 0.5, to_seconds(ekf.estimate().nav.time)));
  };
  fuse_here();
  CHECK(near(information(), 0.25 + 4.0, 1e-12));
  const Eigen::Vector3d g_e = gravity_e(GravityModel::kNormal, at_equator().nav.r_e_m);
  ekf.predict({Time{} + duration_from_seconds(1.0), 1.0, earth_rotation_e_radps(), -g_e});
  const double before = information();
  fuse_here();
  const double a = std::exp(-1.0 / 30.0);
  CHECK(near(information() - before, 4.0 * (1.0 - a) / (1.0 + a), 1e-9));

  // 2026-11-24: at the same time a = 1 divided by zero; such a fix says nothing new.
  const double settled = information();
  fuse_here();
  CHECK(near(information(), settled, 1e-12));
}

TEST_CASE("NIS over seeds 1 to 20 of a consistent scene is chi-square, on both sides" *
          doctest::test_suite("heavy")) {
  const sim::Trajectory trajectory = sim::square_loop({.straight_s = 20.0, .duration_s = 100.0});
  const auto truth = sim::true_increments(trajectory, 50.0, 100.0);
  EkfConfig config;
  config.imu = imu_class_model(ImuClass::kTactical, RangeEnd::kMid);
  config.gnss_correlation_s = 0.0;
  double nis = 0.0;
  int dof = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto log = test::record(trajectory, truth, config.imu, {}, 1.0, 1.0, seed);
    const Estimate start = test::truth_estimate(trajectory, 0.0);
    const ErrorMatrix P = initial_covariance(start, {0.01, 0.05, 0.1, 3.0}, config.imu);
    Ekf ekf(config, test::drawn_start(start, P, seed), P);
    std::size_t next = 0;
    for (const ImuIncrement& inc : log.imu) {
      ekf.predict(inc);
      if (next == log.fixes.size() || log.fixes[next].time != inc.time) continue;
      const UpdateOutcome outcome = ekf.update(log.fixes[next++]);
      CHECK(outcome.covariance_positive);
      nis += outcome.nis;
      dof += outcome.dof;
    }
    CHECK(next == 100);
  }
  REQUIRE(dof == 20 * 100 * 6);
  MESSAGE("mean NIS of 6: " << nis / (dof / 6));
  CHECK(nis > chi_square_threshold(0.995, dof));
  CHECK(nis < chi_square_threshold(0.005, dof));
}

TEST_CASE("a spinning vehicle: the lever arm makes innovations unbiased, without it they are not") {
  sim::Trajectory spin;
  spin.name = "spin";
  spin.plane = sim::TangentPlane(sim::kDefaultOrigin);
  spin.duration_s = 60.0;
  spin.motion = [](double t_s) {
    sim::LocalMotion m;
    m.yaw_rad = sim::time_jet(t_s) * 1.0;
    return m;
  };
  const auto truth = sim::true_increments(spin, 100.0, 60.0);
  sim::GnssErrorModel gnss;
  gnss.position_sigma_n_m.setConstant(0.05);
  gnss.velocity_sigma_n_mps.setConstant(0.02);
  gnss.lever_arm_b_m = {2.0, 0.0, 0.0};
  // Mean innovation in body axes over 59 fixes; the filter takes no notice of what it is told.
  const auto mean_innovation = [&](const Eigen::Vector3d& told_b_m, int row) -> Eigen::Vector3d {
    const auto log = test::record(spin, truth, {}, gnss, 1.0, 1.0, 1);
    const Estimate start = test::truth_estimate(spin, 0.0);
    Ekf ekf(plain_config(), start, ErrorMatrix::Zero());
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::size_t next = 0;
    for (const ImuIncrement& inc : log.imu) {
      ekf.predict(inc);
      if (next == log.fixes.size() || log.fixes[next].time != inc.time) continue;
      const Measurement m = gnss_measurement(log.fixes[next++], ekf.estimate(), told_b_m,
                                             inc.dtheta_b_rad / inc.dt_s);
      sum += ekf.estimate().nav.q_eb.conjugate() * Eigen::Vector3d(m.innovation.segment<3>(row));
    }
    return sum / static_cast<double>(next);
  };
  // Four sigmas of a mean of 60.
  CHECK(mean_innovation(gnss.lever_arm_b_m, 0).cwiseAbs().maxCoeff() <
        4.0 * 0.05 / std::sqrt(60.0));
  CHECK(mean_innovation(gnss.lever_arm_b_m, 3).cwiseAbs().maxCoeff() <
        4.0 * 0.02 / std::sqrt(60.0));
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  CHECK(near(mean_innovation(zero, 0), Eigen::Vector3d(2.0, 0.0, 0.0), 0.03));
  CHECK(near(mean_innovation(zero, 3), Eigen::Vector3d(0.0, 2.0, 0.0), 0.012));  // w x l

  // The whole filter: all fused with the lever arm, gated without.
  for (const bool told : {true, false}) {
    EkfConfig config;
    config.gnss_correlation_s = 0.0;
    if (told) config.lever_arm_b_m = gnss.lever_arm_b_m;
    const auto log = test::record(spin, truth, {}, gnss, 1.0, 1.0, 2);
    const Estimate start = test::truth_estimate(spin, 0.0);
    Ekf ekf(config, start, initial_covariance(start, {0.01, 0.01, 0.02, 0.05}, config.imu));
    int gated = 0;
    std::size_t next = 0;
    for (const ImuIncrement& inc : log.imu) {
      ekf.predict(inc);
      if (next == log.fixes.size() || log.fixes[next].time != inc.time) continue;
      gated += ekf.update(log.fixes[next++]).outcome == Outcome::kGated;
    }
    CHECK((told ? gated == 0 : gated > 50));
  }
}

TEST_CASE("reading the covariance changes no later bit") {
  const sim::Trajectory trajectory = sim::circle();
  const auto log = test::record(trajectory, sim::true_increments(trajectory, 100.0, 10.0),
                                automotive_mems_model(), {}, 1.0, 1.0, 1);
  const Estimate start = test::truth_estimate(trajectory, 0.0);
  const EkfConfig config;
  Ekf silent(config, start, initial_covariance(start, {0.01, 0.05, 0.1, 3.0}, config.imu));
  Ekf watched = silent;
  std::size_t next = 0;
  for (const ImuIncrement& inc : log.imu) {
    silent.predict(inc);
    watched.predict(inc);
    CHECK(watched.covariance().diagonal().minCoeff() > 0.0);
    if (next == log.fixes.size() || log.fixes[next].time != inc.time) continue;
    silent.update(log.fixes[next]);
    watched.update(log.fixes[next++]);
  }
  CHECK(same_bits(silent, watched));
}

TEST_CASE("coasting in closed form") {
  Estimate start = at_equator();
  start.nav.v_e_mps = {0.0, 20.0, 0.0};
  Ekf ekf(plain_config(), start, diagonal_covariance(0.01, 0.1, 2.0, 0.1, 0.01));
  bridge(ekf, time_from_seconds(10.0));
  const Estimate& end = ekf.estimate();
  CHECK(end.nav.time == time_from_seconds(10.0));
  CHECK(near(end.nav.r_e_m - start.nav.r_e_m, Eigen::Vector3d(0.0, 200.0, 0.0), 2e-9));
  CHECK(end.nav.v_e_mps == start.nav.v_e_mps);
  CHECK(end.nav.q_eb.coeffs() == start.nav.q_eb.coeffs());
  // 3 m/s^2 for 10 s: 30 m/s, as a random walk of velocity 30 m/s * 10 s / sqrt(3); and 0.1 m/s
  // moves 1 m. 0.5 rad/s make 1.8 rad at most about the vertical, here -x, and 0.1 rad about the
  // level axes; the 200 m turn the vertical by 3e-5 rad, which mixes 3e-9 of it into its neighbour.
  const ErrorMatrix P = ekf.covariance();
  CHECK(near(P(kPsi, kPsi), 1.8 * 1.8 + 1e-4, 4e-9));
  CHECK(near(P(kPsi + 1, kPsi + 1), 0.01 + 1e-4, 4e-9));
  CHECK(near(P(kPsi + 2, kPsi + 2), 0.01 + 1e-4, 1e-12));
  CHECK(near(P(kDv, kDv), 900.0 + 0.01, 1e-10));
  CHECK(near(P(kDr, kDr), 30'000.0 + 1.0 + 4.0, 1e-8));
  CHECK(near(P(kDr, kDv), 900.0 * 5.0 + 0.1, 1e-9));
  CHECK(near(P(kBa, kBa), 0.01, 1e-16));
  CHECK(P == P.transpose());
}

TEST_CASE("a hole bridged in pieces is as uncertain as in one") {
  Estimate start = at_equator();
  start.nav.v_e_mps = {0.0, 20.0, 0.0};
  Ekf whole(plain_config(), start, diagonal_covariance(0.01, 0.1, 2.0, 0.1, 0.01));
  Ekf pieces = whole;
  bridge(whole, time_from_seconds(2.0));
  for (int k = 0; k < 100; ++k) bridge(pieces, time_from_seconds(0.02 * (k + 1)), 0.02 * k);
  // Turn and velocity to rounding; a velocity that is unsure by 6 m/s only at the end has moved the
  // place by less, 0.87 times in the limit: sqrt(1.5 / 2).
  CHECK(near(pieces.covariance()(kPsi, kPsi), whole.covariance()(kPsi, kPsi), 1e-9));
  CHECK(near(pieces.covariance()(kDv, kDv), whole.covariance()(kDv, kDv), 1e-9));
  const double ratio = pieces.covariance()(kDr, kDr) / whole.covariance()(kDr, kDr);
  CHECK(ratio > 0.5);
  CHECK(ratio < 1.0);
}

TEST_CASE("an in-run bias alone decays, with a turn-on part it stays") {
  for (const double turn_on : {0.0, 0.1}) {
    EkfConfig config = plain_config();
    config.imu.accelerometer.in_run = {0.05, 20.0};
    config.imu.accelerometer.bias_sigma = turn_on;
    Estimate start = at_equator();
    start.bias.b_a_mps2 = {0.2, 0.0, 0.0};
    Ekf ekf(config, start, diagonal_covariance(0.01, 0.1, 2.0, 0.1, 0.01));
    for (int k = 1; k <= 1000; ++k) {
      ekf.predict({time_from_seconds(0.01 * k), 0.01, Eigen::Vector3d::Zero(),
                   Eigen::Vector3d(0.098, 0.0, 0.0)});
    }
    const double expected = turn_on > 0.0 ? 0.2 : 0.2 * std::exp(-0.5);
    CHECK(near(ekf.estimate().bias.b_a_mps2.x(), expected, 1e-13));
  }
}

TEST_CASE("solution: sigmas in the axes of the reader, for any attitude") {
  const Estimate estimate = test::random_estimate(3);
  ErrorMatrix P = ErrorMatrix::Zero();
  const NavStateNed ned = ned_from_nav_state(estimate.nav);
  const Eigen::Matrix3d C_en = ned_to_ecef(ned.position);
  const Eigen::Vector3d sigma_n(1.0, 2.0, 3.0);
  P.block<3, 3>(kDr, kDr) = C_en * sigma_n.cwiseAbs2().asDiagonal() * C_en.transpose();
  P.block<3, 3>(kDv, kDv) = 0.01 * P.block<3, 3>(kDr, kDr);
  P(kBa, kBa) = 4.0;
  P(kBg + 2, kBg + 2) = 9.0;
  // d (roll, pitch, yaw) / d psi by differences, through the conversion people use.
  const auto euler_after = [&](const ErrorVector& x) -> Eigen::Vector3d {
    Estimate e = estimate;
    inject(e, x);
    const EulerAngles a = ned_from_nav_state(e.nav).attitude;
    return {wrap_pi(a.roll_rad - ned.attitude.roll_rad), a.pitch_rad - ned.attitude.pitch_rad,
            wrap_pi(a.yaw_rad - ned.attitude.yaw_rad)};
  };
  const Eigen::Matrix3d J =
      test::central_jacobian(euler_after, test::jacobian_steps(1e-3, 1.0, 1.0, 1.0, 1.0))
          .leftCols<3>();
  sim::Random random(1);
  P.block<3, 3>(kPsi, kPsi) = random_covariance3(random, 0.01);
  const Eigen::Vector3d sigma_rad =
      (J * P.block<3, 3>(kPsi, kPsi) * J.transpose()).diagonal().cwiseSqrt();

  const Solution s = solution(estimate, P);
  CHECK(near(s.sigma_position_n_m, sigma_n, 1e-14));
  CHECK(near(s.sigma_velocity_n_mps, 0.1 * sigma_n, 1e-15));
  CHECK(near(s.sigma_attitude_rad, sigma_rad, 1e-9));
  CHECK(s.sigma_b_a_mps2 == Eigen::Vector3d(2.0, 0.0, 0.0));
  CHECK(s.sigma_b_g_radps == Eigen::Vector3d(0.0, 0.0, 3.0));
  CHECK(s.nis_dof == 0);
  CHECK(std::isnan(s.nis));
}

TEST_CASE("initial covariance: tilt and heading about the local axes") {
  const Estimate estimate = test::random_estimate(5);
  const ErrorMatrix P =
      initial_covariance(estimate, {0.01, 0.2, 0.1, 3.0}, automotive_mems_model());
  const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(estimate.nav.r_e_m));
  const Eigen::Matrix3d psi_n = C_en.transpose() * P.block<3, 3>(kPsi, kPsi) * C_en;
  CHECK(near(psi_n, Eigen::Vector3d(1e-4, 1e-4, 0.04).asDiagonal().toDenseMatrix(), 1e-16));
  CHECK(near(P(kDv, kDv), 0.01, 1e-17));
  CHECK(near(P(kDr, kDr), 9.0, 1e-14));
  CHECK(near(P(kBa, kBa), 0.3 * 0.3 + 0.005 * 0.005, 1e-16));
}

TEST_CASE("mean rate: all there is at first, then exponentially weighted over 5 s") {
  Ekf ekf(plain_config(), at_equator(), ErrorMatrix::Identity());
  CHECK(ekf.inertial().mean_omega_ib_b_radps().isZero(0.0));
  constexpr double kStepS = 0.01;
  Time time = ekf.estimate().nav.time;
  const auto feed = [&](double rate_radps, int count) {
    for (int k = 0; k < count; ++k) {
      time += duration_from_seconds(kStepS);
      ekf.predict({time, kStepS, {0.0, 0.0, kStepS * rate_radps}, {0.0, 0.0, 0.0}});
    }
  };
  feed(0.2, 1);
  CHECK(near(ekf.inertial().mean_omega_ib_b_radps().z(), 0.2, 1e-15));
  feed(0.4, 1);
  CHECK(near(ekf.inertial().mean_omega_ib_b_radps().z(), 0.3, 1e-15));
  feed(0.3, 1000);
  feed(0.0, 500);
  // (1 - dt / 5 s)^(5 s / dt): 1/e but for the step.
  CHECK(near(ekf.inertial().mean_omega_ib_b_radps().z(), 0.3 * std::pow(1.0 - kStepS / 5.0, 500.0),
             1e-12));
}

TEST_CASE("an invalid configuration or start is refused: the field, its value, its range") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    std::function<void(EkfConfig&, Estimate&, ErrorMatrix&)> spoil;
    std::string field;
    std::string value;
    std::string range;
  };
  const Case cases[] = {
      {[](auto& c, auto&, auto&) { c.gnss_correlation_s = -1.0; }, "gnss_correlation_s", "-1",
       "0 to 1e+06"},
      {[&](auto& c, auto&, auto&) { c.gnss_correlation_s = nan; }, "gnss_correlation_s", "nan",
       "1e+06"},
      {[](auto& c, auto&, auto&) { c.covariance_interval_s = 11.0; }, "covariance_interval_s", "11",
       "0 to 10"},
      {[](auto& c, auto&, auto&) { c.gate_probability = 1.5; }, "gate_probability", "1.5",
       "0 or 1e-100 to 1"},
      {[](auto& c, auto&, auto&) { c.lever_arm_b_m.x() = 2000.0; }, "lever_arm_b_m", "2000",
       "-1000 to 1000"},
      {[](auto& c, auto&, auto&) { c.imu.gyro.noise_density = -2.0; }, "gyro.noise_density", "-2",
       ">= 0"},
      {[&](auto&, auto& e, auto&) { e.nav.v_e_mps.x() = nan; }, "navigation state", "", "finite"},
      {[](auto&, auto& e, auto&) { e.nav.q_eb.coeffs() *= 2.0; }, "q_eb", "2", "must be 1"},
      {[](auto&, auto& e, auto&) { e.nav.r_e_m *= 0.5; }, "r_e_m", "3189068", "6.3e6"},
      {[&](auto&, auto&, auto& P) { P(0, 0) = nan; }, "covariance", "", "finite"},
      {[](auto&, auto&, auto& P) { P(0, 0) = -1.0; }, "covariance", "", "negative diagonal"},
      {[](auto&, auto&, auto& P) { P(0, 1) = 0.5; }, "covariance", "", "symmetric"},
  };
  for (const Case& c : cases) {
    EkfConfig config;
    Estimate estimate = at_equator();
    ErrorMatrix P = ErrorMatrix::Identity();
    c.spoil(config, estimate, P);
    const std::string message = test::message_of<Error>([&] { Ekf(config, estimate, P); });
    CAPTURE(c.field);
    CAPTURE(message);
    CHECK(test::contains(message, c.field));
    CHECK(test::contains(message, c.value));
    CHECK(test::contains(message, c.range));
  }
}

}  // namespace leeway
