#include "leeway/alternatives/invariant_ekf.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "leeway/covariance/symmetric_kernel.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/model/heading.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/tools/parallel.hpp"
#include "tests/filters/covariance/carried.hpp"
#include "tests/filters/model/random_state.hpp"
#include "tests/filters/navigator/recording.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/near.hpp"
#include "tests/support/numbers.hpp"

namespace leeway {
namespace {

using test::near;
using test::random_estimate;
using test::random_vector;

using SymmetricDouble = SymmetricKernel<double>;
using PlainEkf = BasicEkf<SymmetricDouble>;
using Invariant = InvariantEkf<SymmetricDouble>;

/// As the group has it: attitude, velocity and position errors along the estimated body axes. By
/// its inverse, x = T xi to first order.
ErrorMatrix body_axes(const Estimate& estimate) {
  const Eigen::Matrix3d C_be = estimate.nav.q_eb.toRotationMatrix().transpose();
  ErrorMatrix M = ErrorMatrix::Identity();
  for (const int row : {kPsi, kDv, kDr}) M.block<3, 3>(row, row) = C_be;
  M.block<3, 3>(kDv, kDr) = C_be * skew(earth_rotation_e_radps());
  return M;
}

using GroupMatrix = Eigen::Matrix<double, 5, 5>;

/// The estimate times the group's exponential of xi_b, by the 5 x 5 matrices of SE_2(3). Positions
/// count from the estimate's, which the left-invariant error does not see.
Estimate moved(const Estimate& estimate, const ErrorVector& xi_b) {
  GroupMatrix chi = GroupMatrix::Identity();
  chi.topLeftCorner<3, 3>() = estimate.nav.q_eb.toRotationMatrix();
  chi.block<3, 1>(0, 3) = estimate.nav.v_e_mps;
  GroupMatrix algebra = GroupMatrix::Zero();
  algebra.topLeftCorner<3, 3>() = skew(xi_b.segment<3>(kPsi));
  algebra.block<3, 1>(0, 3) = xi_b.segment<3>(kDv);
  algebra.block<3, 1>(0, 4) = xi_b.segment<3>(kDr);
  chi = (chi * test::exp_of(algebra)).eval();
  Estimate result = estimate;
  const Eigen::Vector3d dr_e = chi.block<3, 1>(0, 4);
  result.nav.q_eb = Eigen::Quaterniond(Eigen::Matrix3d(chi.topLeftCorner<3, 3>()));
  result.nav.v_e_mps = chi.block<3, 1>(0, 3) - earth_rotation_e_radps().cross(dr_e);
  result.nav.r_e_m += dr_e;
  result.bias.b_a_mps2 += xi_b.segment<3>(kBa);
  result.bias.b_g_radps += xi_b.segment<3>(kBg);
  return result;
}

/// An error of this attitude part, of up to 10 m/s and 100 m.
ErrorVector random_group_error(std::uint64_t seed, double angle_rad) {
  sim::Random random(seed, 9);
  ErrorVector xi = ErrorVector::Zero();
  xi.segment<3>(kPsi) = angle_rad * random.normal3().normalized();
  xi.segment<3>(kDv) = random_vector(random, 10.0);
  xi.segment<3>(kDr) = random_vector(random, 100.0);
  return xi;
}

/// The invariant error, in body axes, that is left of xi_b after the increments.
ErrorVector error_after(const Estimate& start, const std::vector<ImuIncrement>& increments,
                        const ErrorVector& xi_b) {
  Estimate end = start;
  Estimate truth = moved(start, xi_b);
  test::carry(end, increments, test::kInf, test::kInf);
  test::carry(truth, increments, test::kInf, test::kInf);
  return body_axes(end) * InvariantError::coordinates(difference(truth, end));
}

ErrorMatrix numeric_group_transition(const Estimate& start,
                                     const std::vector<ImuIncrement>& increments) {
  return test::central_jacobian(
      [&](const ErrorVector& xi) { return error_after(start, increments, xi); },
      test::jacobian_steps(0.01, 1.0, 100.0, 0.1, 0.001));
}

/// Largest difference in units of the norm of each 3 x 3 block, and of 1e-6 of the largest.
double worst_group_block(const ErrorMatrix& actual, const ErrorMatrix& expected) {
  double worst = 0.0;
  for (int i = 0; i < kErrorStates; i += 3) {
    for (int j = 0; j < kErrorStates; j += 3) {
      const double norm = expected.block<3, 3>(i, j).norm();
      if (norm < 1e-6) continue;
      worst = std::max(worst, (actual - expected).block<3, 3>(i, j).norm() / norm);
    }
  }
  return worst;
}

Estimate at_start_of(const sim::Trajectory& trajectory) {
  return test::truth_estimate(trajectory, 0.0);
}

struct Update {
  EkfConfig config{};
  Estimate start{};
  ErrorMatrix P{};
  ImuIncrement inc{};
};

/// A random state with small, correlated errors, and an increment to be taken.
Update random_update(std::uint64_t seed) {
  sim::Random random(seed, 8);
  Update u;
  u.config.gnss_correlation_s = 0.0;
  u.config.lever_arm_b_m = random_vector(random, 5.0);
  u.start = random_estimate(seed);
  ErrorMatrix A;
  for (double& a : A.reshaped()) a = random.normal();
  A = test::jacobian_steps(0.03, 0.3, 5.0, 0.1, 0.01).asDiagonal() * A;
  u.P = A * A.transpose();
  u.inc = {u.start.nav.time + duration_from_seconds(0.01), 0.01, 0.01 * random_vector(random, 3.0),
           0.01 * random_vector(random, 20.0)};
  return u;
}

/// A fix whose innovation is what an antenna would see from this error of the estimate.
GnssFix fix_at(const Estimate& estimate, const ErrorVector& x, const Update& u, double sigma) {
  Estimate elsewhere = estimate;
  inject(elsewhere, x);
  GnssFix fix;
  fix.time = estimate.nav.time;
  fix.position = {antenna_position_e(elsewhere, u.config.lever_arm_b_m),
                  sigma * sigma * Eigen::Matrix3d::Identity()};
  fix.velocity = {
      antenna_velocity_e(elsewhere, u.config.lever_arm_b_m, u.inc.dtheta_b_rad / u.inc.dt_s),
      0.01 * sigma * sigma * Eigen::Matrix3d::Identity()};
  return fix;
}

}  // namespace

TEST_CASE("the correction is the exponential of SE_2(3), by its 5 x 5 matrices") {
  for (const double angle_rad : {0.0, 1e-8, 0.01, 1.0, 2.0, 3.0}) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      CAPTURE(angle_rad);
      CAPTURE(seed);
      const Estimate start = random_estimate(seed);
      const ErrorVector xi = random_group_error(seed, angle_rad);
      Estimate corrected = start;
      inject(corrected, InvariantError::correction(xi));
      const ErrorVector x = difference(moved(start, body_axes(start) * xi), corrected);
      // Rounding of the matrix exponential, which squares its way up to 100 m, and of 6.4e6 m.
      CHECK(near(x.segment<3>(kPsi), Eigen::Vector3d::Zero(), 1e-14));
      CHECK(near(x.segment<3>(kDv), Eigen::Vector3d::Zero(), 4e-12));
      CHECK(near(x.segment<3>(kDr), Eigen::Vector3d::Zero(), 4e-9));
    }
  }
}

TEST_CASE("coordinates undo the correction, from zero to pi, and agree with x to first order") {
  for (const double angle_rad : {0.0, 1e-8, 0.01, 1.0, 3.0, std::numbers::pi}) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      CAPTURE(angle_rad);
      CAPTURE(seed);
      const ErrorVector xi = random_group_error(seed, angle_rad);
      const ErrorVector x = InvariantError::correction(xi);
      CHECK(near(InvariantError::coordinates(x), xi, 1e-12));  // rounding of 100 m, thrice
      CHECK((x - xi).norm() <= 0.5 * angle_rad * xi.norm());
    }
  }
}

TEST_CASE("without a bias error the invariant error obeys its Phi however large it is") {
  const sim::Trajectory trajectory = sim::manoeuvre_car();
  const Estimate start = at_start_of(trajectory);
  const auto increments = sim::true_increments(trajectory, 100.0, 10.0);
  const ErrorMatrix Phi_b = numeric_group_transition(start, increments);
  Estimate end = start;
  test::carry(end, increments, test::kInf, test::kInf);
  const ErrorMatrix Phi = test::inverse_of(body_axes(end)) * Phi_b * body_axes(start);
  double worst = 0.0;
  double least_additive_m = test::kInf;
  for (const double angle_rad : {0.5, 1.0, 2.0, 3.0}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const ErrorVector xi_b = random_group_error(seed, angle_rad);
      const ErrorVector left_b = error_after(start, increments, xi_b);
      worst = std::max(worst, (left_b - Phi_b * xi_b).cwiseAbs().maxCoeff());
      // The additive error of the same start.
      Estimate truth = moved(start, xi_b);
      const ErrorVector x = difference(truth, start);
      test::carry(truth, increments, test::kInf, test::kInf);
      const ErrorVector miss = difference(truth, end) - Phi * x;
      least_additive_m = std::min(least_additive_m, miss.segment<3>(kDr).norm());
    }
  }
  MESSAGE("invariant: within " << worst << " rad, m/s, m; additive: off by " << least_additive_m
                               << " m at least");
  // The gravity gradient is outside of the group: 3e-6 / s^2 of a position error that grows as t^2
  // to 1 km, integrated twice to t^4 / 12, is 0.025 m; the errors are up to thrice as large.
  CHECK(worst < 0.1);
  CHECK(least_additive_m > 10.0);
}

TEST_CASE("Phi in body axes is that of the increments, whatever attitude and speed are believed") {
  const sim::Trajectory trajectory = sim::manoeuvre_car();
  const Estimate start = at_start_of(trajectory);
  const Estimate believed = moved(start, random_group_error(1, 2.0));
  const auto phi_b = [&](double rate_hz, const Estimate& from) -> ErrorMatrix {
    const auto increments = sim::true_increments(trajectory, rate_hz, 1.0);
    Estimate end = from;
    test::carry(end, increments, test::kInf, test::kInf);
    return body_axes(end) * dense(test::accumulated(from.nav, increments)) *
           test::inverse_of(body_axes(from));
  };
  SUBCASE("against central differences through the strapdown: second order in the increment") {
    const ErrorMatrix numeric =
        numeric_group_transition(start, sim::true_increments(trajectory, 800.0, 1.0));
    const double at_100_hz = worst_group_block(phi_b(100.0, start), numeric);
    const double at_200_hz = worst_group_block(phi_b(200.0, start), numeric);
    MESSAGE("worst block, relative: " << at_100_hz << " " << at_200_hz);
    CHECK(at_100_hz < 1e-4);
    CHECK(at_100_hz > 3.5 * at_200_hz);
  }
  SUBCASE("another attitude by 2 rad, another velocity and place") {
    // What is left is the gravity gradient, which is another one in other axes: 3e-6 / s^2. It
    // turns velocity and position by as much in 1 s.
    const ErrorMatrix here = phi_b(100.0, start);
    const ErrorMatrix there = phi_b(100.0, believed);
    for (int i = 0; i < kErrorStates; i += 3) {
      for (int j = 0; j < kErrorStates; j += 3) {
        const double size = here.block<3, 3>(i, j).norm();
        CHECK((here - there).block<3, 3>(i, j).norm() < 1e-5 * std::max(size, 1.0));
      }
    }
    // In Earth axes it is another Phi altogether.
    const auto increments = sim::true_increments(trajectory, 100.0, 1.0);
    const Transition Phi = test::accumulated(start.nav, increments);
    const Transition other = test::accumulated(believed.nav, increments);
    CHECK((Phi.v - other.v).leftCols<3>().norm() > 0.5 * Phi.v.leftCols<3>().norm());
  }
}

TEST_CASE("H in body axes knows the increment and the lever arm alone") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    const Update u = random_update(seed);
    const Eigen::Vector3d& lever_b_m = u.config.lever_arm_b_m;
    const Eigen::Vector3d omega_m_radps = u.inc.dtheta_b_rad / u.inc.dt_s;
    const Eigen::Matrix3d C_be = u.start.nav.q_eb.toRotationMatrix().transpose();
    const Eigen::Matrix3d Omega_ie = skew(earth_rotation_e_radps());
    // The innovation of velocity told as the group has it.
    Eigen::Matrix<double, 6, 6> rows = Eigen::Matrix<double, 6, 6>::Zero();
    rows.topLeftCorner<3, 3>() = rows.bottomRightCorner<3, 3>() = C_be;
    rows.bottomLeftCorner<3, 3>() = C_be * Omega_ie;
    const GnssFix fix = fix_at(u.start, ErrorVector::Zero(), u, 1.0);
    const Measurement m = gnss_measurement(fix, u.start, lever_b_m, omega_m_radps);
    const Eigen::Matrix<double, 6, kErrorStates> H_b =
        rows * m.H * test::inverse_of(body_axes(u.start));

    Eigen::Matrix<double, 6, kErrorStates> expected =
        Eigen::Matrix<double, 6, kErrorStates>::Zero();
    const Eigen::Vector3d omega_b_radps = omega_m_radps - u.start.bias.b_g_radps;
    expected.block<3, 3>(0, kPsi) = -skew(lever_b_m);
    expected.block<3, 3>(0, kDr).setIdentity();
    expected.block<3, 3>(3, kPsi) = -skew(omega_b_radps.cross(lever_b_m));
    expected.block<3, 3>(3, kDv).setIdentity();
    expected.block<3, 3>(3, kBg) = skew(lever_b_m);
    CHECK(near(H_b, expected, 1e-14));

    const auto innovation = [&](const ErrorVector& xi) -> Eigen::Matrix<double, 6, 1> {
      const GnssFix seen = fix_at(u.start, InvariantError::correction(xi), u, 1.0);
      return gnss_measurement(seen, u.start, lever_b_m, omega_m_radps).innovation;
    };
    // Rounding: 1e-9 m over 0.01 rad, and the same over 1e-3 rad/s of gyro bias.
    const auto numeric =
        test::central_jacobian(innovation, test::jacobian_steps(0.01, 10.0, 1e3, 1.0, 0.01));
    CHECK(near(numeric, m.H, 1e-6));
  }
}

TEST_CASE("a whole fix against the textbook's filter in body axes") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    const Update u = random_update(seed);
    Invariant filter(u.config, u.start, SymmetricDouble(u.P));
    filter.predict(u.inc);
    const Estimate before = filter.estimate();
    const ErrorMatrix to_body = body_axes(before);
    const ErrorMatrix P_b = to_body * filter.covariance() * to_body.transpose();
    sim::Random random(seed, 10);
    const ErrorVector unit = ErrorVector::NullaryExpr([&] { return random.normal(); });
    const ErrorVector x = test::jacobian_steps(0.03, 0.3, 5.0, 0.1, 0.01).cwiseProduct(unit);
    const GnssFix fix = fix_at(before, x, u, 0.5);
    const Measurement m =
        gnss_measurement(fix, before, u.config.lever_arm_b_m, u.inc.dtheta_b_rad / u.inc.dt_s);
    const Eigen::MatrixXd H = m.H * test::inverse_of(to_body);
    const test::DenseUpdate dense =
        test::dense_update(P_b.cast<long double>(), H.cast<long double>(), m.R.cast<long double>(),
                           m.innovation.cast<long double>());
    const Estimate expected = moved(before, dense.x);
    const ErrorMatrix P_expected = dense.P;

    filter.update(fix);
    const ErrorMatrix T = body_axes(filter.estimate());
    const ErrorVector sigma = filter.covariance().diagonal().cwiseSqrt();
    const ErrorVector off = difference(expected, filter.estimate()).cwiseQuotient(sigma);
    CHECK(off.cwiseAbs().maxCoeff() < 1e-6);
    // P is not changed by the correction, seen from the body. 1e-8: what P - K H P loses of P.
    CHECK(test::scaled_distance(T * filter.covariance() * T.transpose(), P_expected) < 1e-6);
  }
}

TEST_CASE("from small errors it is the plain filter to second order") {
  const Update u = random_update(1);
  const auto apart = [&](double scale) {
    PlainEkf plain(u.config, u.start, SymmetricDouble(scale * scale * u.P));
    Invariant invariant(u.config, u.start, SymmetricDouble(scale * scale * u.P));
    plain.predict(u.inc);
    invariant.predict(u.inc);
    const ErrorVector x = scale * test::jacobian_steps(0.03, 0.3, 5.0, 0.1, 0.01);
    const GnssFix fix = fix_at(plain.estimate(), x, u, 0.5 * scale);
    plain.update(fix);
    invariant.update(fix);
    return difference(plain.estimate(), invariant.estimate());
  };
  const ErrorVector whole = apart(1.0);
  const ErrorVector half = apart(0.5);
  for (const int block : {kDv, kDr}) {
    const double ratio = whole.segment<3>(block).norm() / half.segment<3>(block).norm();
    CHECK(near(ratio, 4.0, 0.3));  // what is left is of third order
  }
  // |x - xi| = |psi| |xi| / 2 at most, and the correction of the attitude is within 0.2 rad.
  CHECK(whole.segment<3>(kDr).norm() < 0.5 * 0.2 * 20.0);
  CHECK(whole.segment<3>(kPsi).norm() < 1e-15);
}

TEST_CASE("a fix without numbers changes nothing") {
  const Update u = random_update(1);
  Invariant filter(u.config, u.start, SymmetricDouble(u.P));
  filter.update(GnssFix{});
  CHECK(filter.covariance() == SymmetricDouble(u.P).matrix());
  CHECK(filter.estimate().nav.r_e_m == u.start.nav.r_e_m);
}

namespace {

constexpr double kCourseRateHz = 50.0;
constexpr double kCourseS = 200.0;
constexpr int kCourseSeeds = 100;

/// A trajectory with what its runs share.
struct Course {
  std::string name;
  sim::Trajectory trajectory;
  std::vector<ImuIncrement> increments{sim::true_increments(trajectory, kCourseRateHz, kCourseS)};
};

struct CourseDrive {
  EkfConfig config{};
  Estimate start{};
  ErrorMatrix P{};
  test::Recording log{};
};

CourseDrive drive_course(const Course& course, const ImuErrorModel& imu, const InitialSigma& sigma,
                         std::uint64_t seed) {
  CourseDrive drive;
  drive.config.imu = imu;
  drive.config.gate_probability = 0.0;  // from a wrong heading right fixes look wrong
  drive.config.gnss_correlation_s = 0.0;
  drive.config.lever_arm_b_m = {1.0, -0.5, -1.5};
  sim::GnssErrorModel gnss;
  gnss.lever_arm_b_m = drive.config.lever_arm_b_m;
  drive.log = test::record(course.trajectory, course.increments, imu, gnss, 1.0, 1.0, seed);
  const Estimate truth = at_start_of(course.trajectory);
  drive.P = initial_covariance(truth, sigma, imu);
  drive.start = test::drawn_start(truth, drive.P, seed);
  return drive;
}

/// Calls look(filter, increment number) before every fix.
template <class Filter, class Look>
void run_course(Filter& filter, const CourseDrive& drive, const Look& look) {
  auto fix = drive.log.fixes.begin();
  for (std::size_t k = 0; k < drive.log.imu.size(); ++k) {
    filter.predict(drive.log.imu[k]);
    if (fix == drive.log.fixes.end() || fix->time > drive.log.imu[k].time) continue;
    look(filter, k);
    filter.update(*fix++);
  }
}

ImuErrorModel without_bias(ImuErrorModel imu) {
  for (TriadErrorModel* triad : {&imu.accelerometer, &imu.gyro}) {
    triad->bias_sigma = 1e-9;  // as good as none
    triad->in_run.sigma = 0.0;
  }
  return imu;
}

struct HeadingEnd {
  bool good{false};         // within 3 deg and 3 sigma of its own, as in heading_test.cpp
  bool false_claim{false};  // beyond 4 sigma
  double settled_s{0.0};    // within 3 deg from here on
};

/// The heading is off by as much as the filter's sigma says, its sign alternates.
template <class Filter>
HeadingEnd heading_end(const Course& course, const ImuErrorModel& imu, double heading_rad,
                       std::uint64_t seed) {
  InitialSigma sigma{0.01, 1e-6, 0.05, 2.5};
  CourseDrive drive = drive_course(course, imu, sigma, seed);
  const Eigen::Vector3d down_e = down_e_at(drive.start.nav.r_e_m);
  const double sign = seed % 2 == 0 ? 1.0 : -1.0;
  drive.start.nav.q_eb = exp_quaternion(sign * heading_rad * down_e) * drive.start.nav.q_eb;
  sigma.heading_rad = heading_rad;
  Filter filter(drive.config, drive.start,
                SymmetricDouble(initial_covariance(drive.start, sigma, imu)));
  HeadingEnd end;
  run_course(filter, drive, [&](const Filter& f, std::size_t k) {
    const double t_s = to_seconds(course.increments[k].time);
    const Estimate truth = test::truth_estimate(course.trajectory, t_s);
    const ErrorVector x = difference(truth, f.estimate());
    const double error_rad = std::abs(down_e.dot(x.segment<3>(kPsi)));
    const double sigma_rad = std::sqrt(heading_variance_rad2(f.estimate(), f.covariance()));
    const double limit_rad = 3.0 * kRadPerDeg;
    if (!(error_rad < limit_rad)) end.settled_s = t_s;
    end.good = error_rad < limit_rad && error_rad < 3.0 * sigma_rad;
    end.false_claim = !(error_rad < 4.0 * sigma_rad);
  });
  return end;
}

struct HeadingEnds {
  int good{0};
  int false_claims{0};
  double median_settled_s{0.0};
};

template <class Filter>
HeadingEnds heading_ends(const Course& course, const ImuErrorModel& imu, double heading_rad) {
  std::vector<HeadingEnd> ends(kCourseSeeds);
  sim::parallel_for(ends.size(), [&](std::size_t k) {
    ends[k] = heading_end<Filter>(course, imu, heading_rad, k + 1);
  });
  HeadingEnds sum;
  std::vector<double> settled_s;
  for (const HeadingEnd& end : ends) {
    sum.good += end.good ? 1 : 0;
    sum.false_claims += end.false_claim ? 1 : 0;
    settled_s.push_back(end.settled_s);
  }
  std::nth_element(settled_s.begin(), settled_s.begin() + kCourseSeeds / 2, settled_s.end());
  sum.median_settled_s = settled_s[kCourseSeeds / 2];
  return sum;
}

}  // namespace

TEST_CASE("consistent from errors of a degree, seeds 1 to 100, two-sided" *
          doctest::test_suite("heavy")) {
  const Course course{"car", sim::car_drive({.initial_rest_s = 1.0, .duration_s = 400.0})};
  for (const ImuErrorModel& imu :
       {imu_class_model(ImuClass::kTactical, RangeEnd::kMid), automotive_mems_model()}) {
    std::vector<double> nees(kCourseSeeds);
    sim::parallel_for(nees.size(), [&](std::size_t k) {
      const CourseDrive drive = drive_course(course, imu, {0.01, 0.02, 0.05, 2.5}, k + 1);
      Invariant filter(drive.config, drive.start, SymmetricDouble(drive.P));
      run_course(filter, drive, [](const Invariant&, std::size_t) {});
      Estimate truth = test::truth_estimate(course.trajectory, kCourseS);
      truth.bias = drive.log.bias;
      const ErrorVector xi = InvariantError::coordinates(difference(truth, filter.estimate()));
      nees[k] = xi.dot(filter.covariance().llt().solve(xi));
    });
    double sum = 0.0;
    for (const double value : nees) sum += value;
    const int degrees = kErrorStates * kCourseSeeds;
    MESSAGE("mean NEES of 15 states " << sum / kCourseSeeds);
    CHECK(test::is_chi_square_mean(sum / degrees, degrees));
  }
}

TEST_CASE("from headings of 60 to 120 deg, seeds 1 to 100, the plain filter beside it" *
          doctest::test_suite("heavy")) {
  const Course courses[] = {{"car", sim::car_drive({.initial_rest_s = 1.0, .duration_s = 400.0})},
                            {"square loop", sim::square_loop()}};
  struct Sensor {
    std::string name;
    ImuErrorModel imu;
  };
  const ImuErrorModel tactical = imu_class_model(ImuClass::kTactical, RangeEnd::kMid);
  // Their biases turn the heading by little before the first turn.
  const Sensor sensors[] = {{"automotive without bias", without_bias(automotive_mems_model())},
                            {"tactical", tactical}};
  for (const Course& course : courses) {
    for (const Sensor& sensor : sensors) {
      for (const double heading_deg : {60.0, 90.0, 120.0}) {
        const double heading_rad = heading_deg * kRadPerDeg;
        const auto plain = heading_ends<PlainEkf>(course, sensor.imu, heading_rad);
        const auto invariant = heading_ends<Invariant>(course, sensor.imu, heading_rad);
        MESSAGE(course.name << ", " << sensor.name << ", " << heading_deg << " deg: good "
                            << plain.good << " -> " << invariant.good << ", false claims "
                            << plain.false_claims << " -> " << invariant.false_claims
                            << ", settled after " << plain.median_settled_s << " -> "
                            << invariant.median_settled_s << " s");
        CHECK(invariant.good > plain.good);
        CHECK(invariant.false_claims < std::max(plain.false_claims, 1));
        if (heading_deg < 100.0) CHECK(invariant.good >= 90);
      }
    }
  }
}

}  // namespace leeway
