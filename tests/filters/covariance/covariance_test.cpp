#include "leeway/covariance/covariance.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

#include "leeway/earth/error.hpp"
#include "leeway/ekf/ekf.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/model/process_noise.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "tests/filters/covariance/kernel_cases.hpp"
#include "tests/filters/model/random_state.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::near;
using test::positive_definite;
using test::random_covariance;
using test::random_estimate;
using test::random_vector;
using test::scaled_distance;
using test::working_sigmas;

/// Constant dynamics at a random place; the biases as given.
struct Scene {
  Eigen::Matrix3d C_eb{};
  Eigen::Vector3d f_e_mps2{};
  Eigen::Matrix3d gravity_gradient_e{};
  ErrorMatrix F{};
  ProcessNoise noise{};

  ErrorDynamics step(double dt_s) const {
    return {dt_s,
            C_eb,
            dt_s * f_e_mps2,
            gravity_gradient_e,
            bias_decay(dt_s, noise.tau_a_s),
            bias_decay(dt_s, noise.tau_g_s)};
  }
};

Scene random_scene(std::uint64_t seed) {
  sim::Random random(seed, 6);
  const Estimate e = random_estimate(seed);
  Scene s;
  s.noise = {1e-6, 1e-4, 1e-5, 1e-9, 50.0, 80.0};
  s.C_eb = e.nav.q_eb.toRotationMatrix();
  s.f_e_mps2 = random_vector(random, 20.0);
  s.gravity_gradient_e = gravity_gradient_e(e.nav.r_e_m);
  s.F = system_matrix(s.C_eb, s.f_e_mps2, s.gravity_gradient_e, s.noise.tau_a_s, s.noise.tau_g_s);
  return s;
}

ErrorMatrix noise_density(const ProcessNoise& n) {
  return test::jacobian_steps(n.attitude_rad2_per_s, n.velocity_m2_per_s3, 0.0, n.b_a_m2_per_s5,
                              n.b_g_rad2_per_s3)
      .asDiagonal();
}

/// Phi and Q of constant dynamics over t, exact. Van Loan (1978).
struct Discrete {
  ErrorMatrix Phi;
  ErrorMatrix Q;
};

Discrete van_loan(const Scene& s, double t_s) {
  using Pair = Eigen::Matrix<double, 2 * kErrorStates, 2 * kErrorStates>;
  Pair M = Pair::Zero();
  M.topLeftCorner<kErrorStates, kErrorStates>() = -s.F * t_s;
  M.topRightCorner<kErrorStates, kErrorStates>() = noise_density(s.noise) * t_s;
  M.bottomRightCorner<kErrorStates, kErrorStates>() = s.F.transpose() * t_s;
  const Pair E = test::exp_of(M);
  const ErrorMatrix Phi = E.bottomRightCorner<kErrorStates, kErrorStates>().transpose();
  return {Phi, Phi * E.topRightCorner<kErrorStates, kErrorStates>()};
}

bool exactly_symmetric(const ErrorMatrix& P) { return P == P.transpose(); }

/// Quadruple precision where the compiler has it.
#if defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 Quad;  // NOLINT(modernize-use-using)
#else
using Quad = long double;
#endif

/// Just enough linear algebra to judge by.
using QuadMatrix = std::array<std::array<Quad, kErrorStates>, kErrorStates>;

QuadMatrix quad(const ErrorMatrix& m) {
  QuadMatrix q{};
  for (std::size_t i = 0; i < kErrorStates; ++i) {
    for (std::size_t j = 0; j < kErrorStates; ++j) {
      q[i][j] = m(static_cast<int>(i), static_cast<int>(j));
    }
  }
  return q;
}

ErrorMatrix rounded(const QuadMatrix& q) {
  ErrorMatrix m;
  for (std::size_t i = 0; i < kErrorStates; ++i) {
    for (std::size_t j = 0; j < kErrorStates; ++j) {
      m(static_cast<int>(i), static_cast<int>(j)) = static_cast<double>(q[i][j]);
    }
  }
  return m;
}

QuadMatrix product(const QuadMatrix& a, const QuadMatrix& b) {
  QuadMatrix c{};
  for (std::size_t i = 0; i < kErrorStates; ++i) {
    for (std::size_t k = 0; k < kErrorStates; ++k) {
      for (std::size_t j = 0; j < kErrorStates; ++j) c[i][j] += a[i][k] * b[k][j];
    }
  }
  return c;
}

/// Gauss-Jordan without pivoting: the matrix is positive definite.
QuadMatrix inverse(QuadMatrix a) {
  QuadMatrix inv = quad(ErrorMatrix::Identity());
  for (std::size_t k = 0; k < kErrorStates; ++k) {
    const Quad pivot = a[k][k];
    for (std::size_t j = 0; j < kErrorStates; ++j) {
      a[k][j] /= pivot;
      inv[k][j] /= pivot;
    }
    for (std::size_t i = 0; i < kErrorStates; ++i) {
      if (i == k) continue;
      const Quad factor = a[i][k];
      for (std::size_t j = 0; j < kErrorStates; ++j) {
        a[i][j] -= factor * a[k][j];
        inv[i][j] -= factor * inv[k][j];
      }
    }
  }
  return inv;
}

void add_information(QuadMatrix& information, const ErrorVector& h) {
  for (std::size_t i = 0; i < kErrorStates; ++i) {
    for (std::size_t j = 0; j < kErrorStates; ++j) {
      information[i][j] += static_cast<Quad>(h(static_cast<int>(i))) * h(static_cast<int>(j));
    }
  }
}

}  // namespace

TEST_CASE("propagate is Phi (P + Q/2) Phi^T + Q/2 written out") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    const Scene scene = random_scene(seed);
    Transition Phi;
    for (std::uint64_t k = 0; k < 10; ++k) {
      advance(Phi, random_scene(seed + k).step(0.01));
    }
    ErrorMatrix P = random_covariance(seed);
    using Wide = Eigen::Matrix<long double, kErrorStates, kErrorStates>;
    const Wide M = dense(Phi).cast<long double>();
    const Wide half_Q = (0.5 * Phi.dt_s * noise_density(scene.noise)).cast<long double>();
    const Wide expected = M * (P.cast<long double>() + half_Q) * M.transpose() + half_Q;
    propagate(P, Phi, scene.noise);
    CHECK(scaled_distance(P, expected.cast<double>().eval()) < 1e-14);  // a dozen roundings
    CHECK(exactly_symmetric(P));
  }
}

TEST_CASE("P of many steps is Van Loan's, with an error that falls as dt^2") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    const Scene scene = random_scene(seed);
    const ErrorMatrix P_start = working_sigmas().cwiseAbs2().asDiagonal();
    const Discrete exact = van_loan(scene, 1.0);
    const ErrorMatrix expected = exact.Phi * P_start * exact.Phi.transpose() + exact.Q;
    const auto error = [&](int steps) {
      const ErrorDynamics step = scene.step(1.0 / steps);
      ErrorMatrix P = P_start;
      for (int k = 0; k < steps; ++k) {
        Transition Phi;
        advance(Phi, step);
        propagate(P, Phi, scene.noise);
      }
      return scaled_distance(P, expected);
    };
    const double tenths = error(10);
    const double twentieths = error(20);
    CHECK(tenths < 2e-3);
    CHECK(tenths > 3.8 * twentieths);
    CHECK(twentieths > 3.8 * error(40));
  }
}

TEST_CASE("propagating every 0.1 s instead of at every increment") {
  const sim::Trajectory trajectory = sim::manoeuvre_car();
  Estimate start;
  start.nav = sim::truth_at(trajectory, 0.0).nav;
  EkfConfig config;
  config.covariance_interval_s = 0.0;
  const ErrorMatrix P = initial_covariance(start, {0.01, 0.05, 0.1, 2.0}, config.imu);
  Ekf every(config, start, P);
  config.covariance_interval_s = 0.1;
  Ekf decimated(config, start, P);
  double worst = 0.0;
  for (const ImuIncrement& inc : sim::true_increments(trajectory, 100.0, 60.0)) {
    every.predict(inc);
    decimated.predict(inc);
    worst = std::max(worst, scaled_distance(decimated.covariance(), every.covariance()));
  }
  MESSAGE("largest difference, in sigmas squared: " << worst);
  // A 2 Hz body motion against half of 0.1 s of noise at either end.
  CHECK(worst < 1e-6);
  CHECK(worst > 0.0);
}

TEST_CASE("scalar update against the dense Kalman formulas in long double") {
  using Wide = Eigen::Matrix<long double, kErrorStates, kErrorStates>;
  using WideVector = Eigen::Matrix<long double, kErrorStates, 1>;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    sim::Random random(seed, 7);
    ErrorMatrix P = random_covariance(seed);
    ErrorVector x;
    ErrorVector h;
    for (int i = 0; i < kErrorStates; ++i) {
      x(i) = working_sigmas()(i) * random.normal();
      h(i) = random.normal() / working_sigmas()(i);
    }
    const double z = random.normal();
    const Wide P_wide = P.cast<long double>();
    const WideVector h_wide = h.cast<long double>();
    const long double s = h_wide.dot(P_wide * h_wide) + 1.0L;
    const WideVector K = P_wide * h_wide / s;
    const WideVector x_expected =
        x.cast<long double>() + K * (z - h_wide.dot(x.cast<long double>()));
    const Wide P_expected = P_wide - K * (P_wide * h_wide).transpose();

    CHECK(near(scalar_update(P, x, h, z) / static_cast<double>(s), 1.0, 1e-14));
    CHECK(scaled_distance(P, P_expected.cast<double>().eval()) < 1e-13);  // S is up to 400
    CHECK(exactly_symmetric(P));
    const ErrorVector off = (x - x_expected.cast<double>()).cwiseQuotient(working_sigmas());
    CHECK(off.cwiseAbs().maxCoeff() < 1e-13);
  }
}

TEST_CASE("precise fixes on a vague prior leave P positive definite and accurate") {
  // Prior 1000 m, fixes at an antenna 1 m off, one predict and three rows a cycle.
  struct Case {
    double sigma_m;
    double tolerance;  // of sqrt(P_ii P_jj): grows with the squared ratio of the sigmas
  };
  for (const Case& c : {Case{0.1, 1e-9}, Case{0.01, 1e-7}, Case{1e-4, 1e-3}}) {
    CAPTURE(c.sigma_m);
    const Scene scene = random_scene(1);
    Transition Phi;
    advance(Phi, scene.step(0.1));
    const QuadMatrix Phi_quad = quad(dense(Phi));
    const QuadMatrix Phi_transposed = quad(dense(Phi).transpose());
    const ErrorMatrix half_Q = 0.5 * Phi.dt_s * noise_density(scene.noise);

    ErrorMatrix P = test::jacobian_steps(0.1, 10.0, 1000.0, 0.3, 0.01).cwiseAbs2().asDiagonal();
    QuadMatrix reference = quad(P);
    const Eigen::Matrix3d lever = skew(Eigen::Vector3d(0.6, -0.64, 0.48));
    for (int cycle = 1; cycle <= 20; ++cycle) {
      CAPTURE(cycle);
      propagate(P, Phi, scene.noise);
      for (std::size_t i = 0; i < kErrorStates; ++i) {
        reference[i][i] += half_Q(static_cast<int>(i), static_cast<int>(i));
      }
      reference = product(product(Phi_quad, reference), Phi_transposed);
      for (std::size_t i = 0; i < kErrorStates; ++i) {
        reference[i][i] += half_Q(static_cast<int>(i), static_cast<int>(i));
      }
      QuadMatrix information = inverse(reference);
      ErrorVector x = ErrorVector::Zero();
      for (int axis = 0; axis < 3; ++axis) {
        ErrorVector h = ErrorVector::Zero();
        h.segment<3>(kPsi) = -lever.row(axis).transpose() / c.sigma_m;
        h(kDr + axis) = 1.0 / c.sigma_m;
        CHECK(scalar_update(P, x, h, 0.0) > 1.0);
        add_information(information, h);
      }
      reference = inverse(information);
      REQUIRE(positive_definite(P));
      CHECK(exactly_symmetric(P));
      CHECK(scaled_distance(P, rounded(reference)) < c.tolerance);
    }
  }
}

TEST_CASE("every row of H reduces a variance, and none grows") {
  const Estimate estimate = random_estimate(1);
  GnssFix fix;
  fix.position = GnssPosition{estimate.nav.r_e_m};
  fix.velocity = GnssVelocity{estimate.nav.v_e_mps};
  const Measurement m = gnss_measurement(fix, estimate, {1.0, 2.0, -1.0}, {0.1, 0.2, 0.3});
  const ErrorMatrix before = random_covariance(1);
  for (int row = 0; row < m.rows(); ++row) {
    CAPTURE(row);
    ErrorMatrix P = before;
    ErrorVector x = ErrorVector::Zero();
    scalar_update(P, x, m.H.row(row).transpose(), 1.0);
    const ErrorVector left = P.diagonal().cwiseQuotient(before.diagonal());
    CHECK(left.maxCoeff() <= 1.0 + 1e-15);
    const int observed = (row < 3 ? kDr : kDv - 3) + row;
    CHECK(left(observed) < 0.999);
    CHECK(x(observed) != 0.0);
  }
}

TEST_CASE("process noise of an error model") {
  const double infinity = std::numeric_limits<double>::infinity();
  ImuErrorModel model;
  model.accelerometer.noise_density = 2e-3;
  model.gyro.noise_density = 3e-4;
  SUBCASE("constant biases have no drive") {
    model.accelerometer.bias_sigma = 0.1;
    model.gyro.bias_sigma = 0.01;
    const ProcessNoise noise = process_noise(model);
    CHECK(noise.attitude_rad2_per_s == 3e-4 * 3e-4);
    CHECK(noise.velocity_m2_per_s3 == 2e-3 * 2e-3);
    CHECK(noise.b_a_m2_per_s5 == 0.0);
    CHECK(noise.b_g_rad2_per_s3 == 0.0);
    CHECK(noise.tau_a_s == infinity);
    CHECK(noise.tau_g_s == infinity);
  }
  SUBCASE("in-run drift alone is Gauss-Markov, with a turn-on bias a random walk") {
    model.accelerometer.in_run = {0.05, 200.0};
    model.gyro.in_run = {0.002, 400.0};
    model.gyro.bias_sigma = 0.01;
    const ProcessNoise noise = process_noise(model);
    CHECK(near(noise.b_a_m2_per_s5, 2.5e-5, 1e-18));  // 2 sigma^2 / tau
    CHECK(near(noise.b_g_rad2_per_s3, 2e-8, 1e-21));
    CHECK(noise.tau_a_s == 200.0);
    CHECK(noise.tau_g_s == infinity);
  }
  SUBCASE("an in-run drift of infinite time is a constant") {
    model.gyro.in_run = {0.002, infinity};
    CHECK(process_noise(model).b_g_rad2_per_s3 == 0.0);
    CHECK(process_noise(model).tau_g_s == infinity);
  }
  SUBCASE("an invalid model is refused") {
    model.gyro.noise_density = -1.0;
    CHECK_THROWS_AS(process_noise(model), Error);
  }
}

}  // namespace leeway
