#include "leeway/sim/sensors/imu_simulator.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/strapdown/strapdown.hpp"
#include "tests/sim/tools/reference_table.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

using test::is_chi_square_mean;
using test::near;

constexpr double kDtS = 0.01;

/// A true increment that exercises every axis.
ImuIncrement some_increment(double dt_s = kDtS) {
  ImuIncrement inc;
  inc.dt_s = dt_s;
  inc.time = time_from_seconds(dt_s);
  inc.dtheta_b_rad = dt_s * Eigen::Vector3d(0.3, -0.2, 0.1);
  inc.dv_b_mps = dt_s * Eigen::Vector3d(1.0, 2.0, -9.8);
  return inc;
}

/// Sum of the reported velocity increments of a sensor at rest in free fall.
Eigen::Vector3d summed_dv(ImuErrorSimulator& simulator, double dt_s, int count) {
  ImuIncrement nothing;
  nothing.dt_s = dt_s;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < count; ++k) sum += simulator.measure(nothing).dv_b_mps;
  return sum;
}

}  // namespace

TEST_CASE("increments agree with the reference vectors at 400 and 100 Hz" *
          doctest::test_suite("heavy")) {
  struct Case {
    const char* vector;
    Trajectory trajectory;
  };
  const Case cases[] = {
      {"circle20", circle20()},
      {"manoeuvre_car", manoeuvre_car()},
      {"static_lat45",
       static_trajectory({.attitude = {-3.0 * kRadPerDeg, 5.0 * kRadPerDeg, 30.0 * kRadPerDeg}})}};
  for (const Case& c : cases) {
    for (const double rate_hz : {400.0, 100.0}) {
      const char* file = rate_hz == 400.0 ? "/imu.csv.gz" : "/imu_100.csv.gz";
      const auto rows = test::reference_table(std::string(c.vector) + file);
      if (rows.empty()) {
        MESSAGE("skipped: no reference vector " << c.vector);
        continue;
      }
      CAPTURE(c.vector);
      CAPTURE(rate_hz);
      const double duration_s = static_cast<double>(rows.size()) / rate_hz;
      const auto increments = true_increments(c.trajectory, rate_hz, duration_s);
      REQUIRE(increments.size() == rows.size());
      for (std::size_t k = 0; k < rows.size(); ++k) {
        CAPTURE(k);
        const Eigen::Map<const Eigen::Vector3d> dtheta(&rows[k][1]), dv(&rows[k][4]);
        REQUIRE(increments[k].time == time_from_seconds(rows[k][0]));
        // 1e-14 of the largest, 0.005 rad and 0.1 m/s, plus the time's rounding of up to 7e-15 s
        // at 100 s.
        REQUIRE(near(increments[k].dtheta_b_rad, dtheta, 1e-15));
        REQUIRE(near(increments[k].dv_b_mps, dv, 2e-15));
      }
    }
  }
}

TEST_CASE("a long increment is the sum of short ones, across breaks of the motion too") {
  const Trajectory trajectory = square_loop({.duration_s = 100.0});
  for (const double from_s : {49.993, 45.0, 59.9975}) {
    CAPTURE(from_s);
    const double to_s = from_s + 1.0;
    const ImuIncrement whole = true_increment(trajectory, from_s, to_s);
    const double break_s = from_s < 50.0 && to_s > 50.0 ? 50.0 : (from_s < 60.0 ? 60.0 : to_s);
    const double middle_s = break_s < to_s ? break_s : 45.5;
    const ImuIncrement a = true_increment(trajectory, from_s, middle_s);
    const ImuIncrement b = true_increment(trajectory, middle_s, to_s);
    // 100 panels of 0.1 m/s, and 1e-14 s of the break's place times 3 m/s^2.
    CHECK(near(whole.dtheta_b_rad, a.dtheta_b_rad + b.dtheta_b_rad, 1e-14));
    CHECK(near(whole.dv_b_mps, a.dv_b_mps + b.dv_b_mps, 1e-13));
  }
}

TEST_CASE("an increment across a break has the share of the turn that it covers") {
  const Trajectory trajectory = square_loop({.duration_s = 100.0});
  const ImuIncrement inc = true_increment(trajectory, 49.996, 50.006);
  const ImuIncrement before = true_increment(trajectory, 49.98, 49.99);
  // 9 deg/s for 6 ms, and pi m/s^2 to the right; the Earth's share changes by its rate times the
  // 1e-3 rad turned, the lateral force by that of 10 m/s^2 times the tilt of 2e-4 rad.
  const double turn_rad = 9.0 * kRadPerDeg * 0.006;
  CHECK(near(inc.dtheta_b_rad - before.dtheta_b_rad, Eigen::Vector3d(0.0, 0.0, turn_rad), 1e-9));
  CHECK(near(inc.dv_b_mps.y() - before.dv_b_mps.y(), 3.14159265 * 0.006, 1e-5));
}

TEST_CASE("increments tile the time without a gap, at rates that are no whole nanoseconds too") {
  const Trajectory trajectory = circle20();
  for (const double rate_hz : {100.0, 300.0, 125.3}) {
    CAPTURE(rate_hz);
    const auto increments = true_increments(trajectory, rate_hz, 2.0);
    REQUIRE(increments.size() == static_cast<std::size_t>(2.0 * rate_hz));
    Time end{};
    for (const ImuIncrement& inc : increments) {
      REQUIRE(inc.time - duration_from_seconds(inc.dt_s) == end);
      end = inc.time;
    }
  }
  CHECK(true_increments(trajectory, 100.0, 60.0).back().time == time_from_seconds(60.0));
  CHECK(true_increments(trajectory, 100.0, 0.0).empty());
}

TEST_CASE("increments outside the trajectory, backwards or at no rate are refused") {
  const Trajectory trajectory = circle20();
  CHECK_THROWS_AS(true_increment(trajectory, -0.1, 0.1), Error);
  CHECK_THROWS_AS(true_increment(trajectory, 59.0, 60.1), Error);
  CHECK_THROWS_AS(true_increment(trajectory, 1.0, 1.0), Error);
  CHECK_THROWS_AS(true_increments(trajectory, 0.0, 1.0), Error);
  CHECK_THROWS_AS(true_increments(trajectory, 100.0, 61.0), Error);
  CHECK_THROWS_AS(true_increments(trajectory, 100.0, std::nan("")), Error);
}

TEST_CASE("the increments carry a strapdown back to the truth" * doctest::test_suite("heavy")) {
  const Trajectory trajectories[] = {static_trajectory(), straight({.climb_rate_mps = 2.0}),
                                     circle(), car_drive({.duration_s = 200.0})};
  for (const Trajectory& trajectory : trajectories) {
    CAPTURE(trajectory.name);
    NavState state = truth_at(trajectory, 0.0).nav;
    ImuHistory history;
    for (const ImuIncrement& inc : true_increments(trajectory, 100.0, 200.0)) {
      strapdown_step<Scheme::kRungeKutta4>(state, inc, history);
    }
    const NavState truth = truth_at(trajectory, 200.0).nav;
    // The position is added up in steps rounded to 5e-10 m: 1e-5 m were all 20 000 of one sign. The
    // Runge-Kutta scheme follows the bumps of the road to 1e-11 rad.
    CHECK(near(state.r_e_m, truth.r_e_m, 2e-5));
    CHECK(near(state.v_e_mps, truth.v_e_mps, 2e-8));
    CHECK(log_quaternion(truth.q_eb.conjugate() * state.q_eb).norm() < 1e-10);
  }
}

TEST_CASE("the default model reports the truth") {
  ImuErrorSimulator simulator({}, Random(1));
  const ImuIncrement truth = some_increment();
  const ImuIncrement reported = simulator.measure(truth);
  CHECK(reported.time == truth.time);
  CHECK(reported.dt_s == truth.dt_s);
  CHECK(reported.dtheta_b_rad == truth.dtheta_b_rad);
  CHECK(reported.dv_b_mps == truth.dv_b_mps);
}

TEST_CASE("without noise the report is [seed (1)-(2)], by hand") {
  ImuErrorModel model;
  model.accelerometer.bias = {0.1, 0.2, 0.3};
  model.accelerometer.M << 1.01, 0.02, 0.0, 0.0, 0.99, 0.0, 0.0, 0.03, 1.0;
  model.gyro.bias = {0.01, -0.02, 0.03};
  model.gyro.M << 1.0, 0.0, 0.1, 0.2, 1.0, 0.0, 0.0, 0.0, 0.9;
  model.G_g_radps_per_mps2 << 0.0, 0.0, 0.001, 0.002, 0.0, 0.0, 0.0, 0.003, 0.0;
  ImuErrorSimulator simulator(model, Random(1));
  const ImuIncrement reported = simulator.measure(some_increment());
  // f = (1, 2, -9.8), omega = (0.3, -0.2, 0.1); sums of a few numbers below 0.1.
  CHECK(near(reported.dv_b_mps / kDtS,
             Eigen::Vector3d(0.1 + 1.01 + 0.04, 0.2 + 1.98, 0.3 + 0.06 - 9.8), 1e-14));
  CHECK(near(
      reported.dtheta_b_rad / kDtS,
      Eigen::Vector3d(0.01 + 0.3 + 0.01 - 0.0098, -0.02 + 0.06 - 0.2 + 0.002, 0.03 + 0.09 + 0.006),
      1e-15));
  CHECK(simulator.accelerometer_bias_mps2() == model.accelerometer.bias);
  CHECK(simulator.gyro_bias_radps() == model.gyro.bias);
}

TEST_CASE("turn-on biases have their sigma about the known part, and are what is reported") {
  ImuErrorModel model;
  model.accelerometer.bias = {1.0, 2.0, 3.0};
  model.accelerometer.bias_sigma = 0.5;
  model.gyro.bias_sigma = 0.01;
  const int trials = 2000;
  double accelerometer_ratio = 0.0;
  double gyro_ratio = 0.0;
  for (std::uint32_t trial = 1; trial <= trials; ++trial) {
    ImuErrorSimulator simulator(model, Random(1, trial, kImuStream));
    const Eigen::Vector3d b_a = simulator.accelerometer_bias_mps2();
    accelerometer_ratio += (b_a - model.accelerometer.bias).squaredNorm() / 0.25 / (3.0 * trials);
    gyro_ratio += simulator.gyro_bias_radps().squaredNorm() / 1e-4 / (3.0 * trials);
    REQUIRE(near(summed_dv(simulator, kDtS, 10), 0.1 * b_a, 1e-15));
  }
  CHECK(is_chi_square_mean(accelerometer_ratio, 3 * trials));
  CHECK(is_chi_square_mean(gyro_ratio, 3 * trials));
}

TEST_CASE("scale factors, misalignments and g-sensitivity have their spread from unit to unit") {
  ImuErrorModel model;
  model.accelerometer.scale_sigma = 1e-3;
  model.accelerometer.misalignment_sigma_rad = 2e-3;
  model.gyro.scale_sigma = 5e-4;
  model.gyro.misalignment_sigma_rad = 3e-3;
  model.G_g_sigma_radps_per_mps2 = 1e-4;
  // What a sensor reports of 1 m/s^2 and 1 rad/s along one axis after the other: M and G, column by
  // column, one unit for each of the trials 1..N.
  const int trials = 2000;
  double scale_a = 0.0, scale_g = 0.0, skew_a = 0.0, skew_g = 0.0, g_sensitivity = 0.0;
  for (std::uint32_t trial = 1; trial <= trials; ++trial) {
    ImuErrorSimulator simulator(model, Random(1, trial, kImuStream));
    for (int axis = 0; axis < 3; ++axis) {
      ImuIncrement force;
      force.dt_s = 1.0;
      ImuIncrement turn = force;
      force.dv_b_mps = Eigen::Vector3d::Unit(axis);
      turn.dtheta_b_rad = Eigen::Vector3d::Unit(axis);
      const ImuIncrement forced = simulator.measure(force);
      const Eigen::Vector3d error_a = forced.dv_b_mps - force.dv_b_mps;
      const Eigen::Vector3d error_g = simulator.measure(turn).dtheta_b_rad - turn.dtheta_b_rad;
      scale_a += error_a[axis] * error_a[axis];
      scale_g += error_g[axis] * error_g[axis];
      skew_a += error_a.squaredNorm() - error_a[axis] * error_a[axis];
      skew_g += error_g.squaredNorm() - error_g[axis] * error_g[axis];
      g_sensitivity += forced.dtheta_b_rad.squaredNorm();
    }
  }
  CHECK(is_chi_square_mean(scale_a / (3 * trials) / 1e-6, 3 * trials));
  CHECK(is_chi_square_mean(scale_g / (3 * trials) / 2.5e-7, 3 * trials));
  CHECK(is_chi_square_mean(skew_a / (6 * trials) / 4e-6, 6 * trials));
  CHECK(is_chi_square_mean(skew_g / (6 * trials) / 9e-6, 6 * trials));
  CHECK(is_chi_square_mean(g_sensitivity / (9 * trials) / 1e-8, 9 * trials));
}

TEST_CASE("spreads of zero draw nothing: the numbers are those of a model that has no spreads") {
  ImuErrorModel model;
  model.accelerometer.bias_sigma = 0.5;
  model.accelerometer.noise_density = 0.02;
  model.gyro.bias_sigma = 0.01;
  model.gyro.noise_density = 0.001;
  ImuErrorSimulator simulator(model, Random(7));
  ImuIncrement nothing;
  nothing.dt_s = 0.25;
  const ImuIncrement reported = simulator.measure(nothing);
  // Bias, start of the in-run drift, of each triad; then the noise of the first increment.
  Random random(7);
  const Eigen::Vector3d b_a = 0.5 * random.normal3();
  random.normal3();
  const Eigen::Vector3d b_g = 0.01 * random.normal3();
  random.normal3();
  const Eigen::Vector3d dv = 0.25 * b_a + 0.02 * 0.5 * random.normal3();
  const Eigen::Vector3d dtheta = 0.25 * b_g + 0.001 * 0.5 * random.normal3();
  CHECK(near(reported.dv_b_mps, dv, 1e-16));  // a rounding of 0.5
  CHECK(near(reported.dtheta_b_rad, dtheta, 1e-18));
}

TEST_CASE("white noise has its density at 1 s by the Allan variance, at any sampling rate") {
  ImuErrorModel model;
  model.accelerometer.noise_density = 0.02;
  const int clusters = 4000;
  for (const double dt_s : {0.5, 0.1, 0.02}) {
    CAPTURE(dt_s);
    ImuErrorSimulator simulator(model, Random(1));
    const int per_cluster = static_cast<int>(std::lround(1.0 / dt_s));
    Eigen::Vector3d previous = summed_dv(simulator, dt_s, per_cluster);
    double allan = 0.0;
    for (int k = 1; k < clusters; ++k) {
      const Eigen::Vector3d mean = summed_dv(simulator, dt_s, per_cluster);
      allan += 0.5 * (mean - previous).squaredNorm() / (3.0 * (clusters - 1));
      previous = mean;
    }
    // Allan variance at tau = 1 s is density^2. Neighbouring differences share a cluster: 1.5 times
    // the variance of independent ones.
    CHECK(is_chi_square_mean(allan / (0.02 * 0.02), 3 * clusters * 2 / 3));
  }
}

TEST_CASE("gyro and accelerometer noise are independent of each other and between axes") {
  ImuErrorModel model;
  model.accelerometer.noise_density = 1.0;
  model.gyro.noise_density = 1.0;
  ImuErrorSimulator simulator(model, Random(1));
  const int count = 100'000;
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  ImuIncrement nothing;
  nothing.dt_s = 1.0;
  for (int k = 0; k < count; ++k) {
    const ImuIncrement inc = simulator.measure(nothing);
    Eigen::Matrix<double, 6, 1> noise;
    noise << inc.dv_b_mps, inc.dtheta_b_rad;
    covariance += noise * noise.transpose() / count;
  }
  // Five standard deviations: 21 numbers are checked.
  CHECK(near(covariance, Eigen::Matrix<double, 6, 6>::Identity(), 5.0 * std::sqrt(2.0 / count)));
}

TEST_CASE("in-run bias is a stationary Gauss-Markov process, and increments carry its integral") {
  ImuErrorModel model;
  const double sigma = 0.3;
  const double tau_s = 10.0;
  model.accelerometer.in_run = {sigma, tau_s};
  const int trials = 3000;
  const double span_s = 40.0;
  double start = 0.0, end = 0.0, product = 0.0, integral = 0.0, integral_start = 0.0;
  const double n = 3.0 * trials;
  for (std::uint32_t trial = 1; trial <= trials; ++trial) {
    ImuErrorSimulator simulator(model, Random(1, trial));
    const Eigen::Vector3d b0 = simulator.accelerometer_bias_mps2() / sigma;
    // Steps of two lengths: the discretization must follow dt. In the long one the part of the
    // integral that the end value does not explain is large enough to be missed.
    Eigen::Vector3d sum = summed_dv(simulator, 0.5, 40);
    sum += summed_dv(simulator, 20.0, 1);
    const Eigen::Vector3d b1 = simulator.accelerometer_bias_mps2() / sigma;
    start += b0.squaredNorm() / n;
    end += b1.squaredNorm() / n;
    product += b0.dot(b1) / n;
    integral += (sum / (sigma * tau_s)).squaredNorm() / n;
    integral_start += b0.dot(sum) / (sigma * tau_s) / n;
  }
  const double a = span_s / tau_s;
  CHECK(is_chi_square_mean(start, 3 * trials));
  CHECK(is_chi_square_mean(end, 3 * trials));
  // Autocorrelation exp(-a); the product of two unit normals has variance 1 + rho^2.
  CHECK(near(product, std::exp(-a), 4.0 * std::sqrt((1.0 + std::exp(-2.0 * a)) / n)));
  // Variance of the integral of the stationary process: 2 (a - 1 + exp(-a)) (sigma tau)^2.
  const double integral_variance = 2.0 * (a - 1.0 + std::exp(-a));
  CHECK(is_chi_square_mean(integral / integral_variance, 3 * trials));
  // Covariance of the start with the integral: (1 - exp(-a)) sigma^2 tau.
  const double cross = 1.0 - std::exp(-a);
  CHECK(near(integral_start, cross, 4.0 * std::sqrt((integral_variance + cross * cross) / n)));
}

TEST_CASE("an in-run bias of infinite correlation time is a random constant") {
  ImuErrorModel model;
  model.gyro.in_run.sigma = 1e-3;
  ImuErrorSimulator simulator(model, Random(1));
  const Eigen::Vector3d bias = simulator.gyro_bias_radps();
  CHECK(bias.norm() > 0.0);
  const ImuIncrement truth = some_increment();
  for (int k = 0; k < 10; ++k) {
    CHECK(near(simulator.measure(truth).dtheta_b_rad, truth.dtheta_b_rad + kDtS * bias, 1e-18));
  }
  CHECK(simulator.gyro_bias_radps() == bias);
}

TEST_CASE("quantization reports whole quanta and loses nothing over time") {
  ImuErrorModel model;
  model.accelerometer.quantum = 0x1p-6;  // a power of two: whole multiples are exact
  model.accelerometer.noise_density = 0.1;
  ImuErrorModel unquantized = model;
  unquantized.accelerometer.quantum = 0.0;
  ImuErrorSimulator coarse(model, Random(1));
  ImuErrorSimulator fine(unquantized, Random(1));
  Eigen::Vector3d lost = Eigen::Vector3d::Zero();
  double largest_lost = 0.0;
  for (int k = 0; k < 10'000; ++k) {
    const Eigen::Vector3d reported = coarse.measure(some_increment()).dv_b_mps;
    const Eigen::Vector3d quanta = reported / 0x1p-6;
    REQUIRE(quanta == quanta.array().round().matrix());
    lost += fine.measure(some_increment()).dv_b_mps - reported;
    largest_lost = std::max(largest_lost, lost.cwiseAbs().maxCoeff());
  }
  CHECK(largest_lost < 0.5 * 0x1p-6 + 1e-11);  // half a quantum, and 1e4 roundings of 1e-15
  CHECK(largest_lost > 0.45 * 0x1p-6);
}

TEST_CASE("saturation clips the mean rate on either side, biases included, and leaves the rest") {
  ImuErrorModel model;
  model.accelerometer.range = 5.0;
  model.accelerometer.bias = {4.5, 0.0, 0.0};
  model.gyro.range = 0.25;
  ImuErrorSimulator simulator(model, Random(1));
  const ImuIncrement reported = simulator.measure(some_increment());
  CHECK(near(reported.dv_b_mps, kDtS * Eigen::Vector3d(5.0, 2.0, -5.0), 1e-17));
  CHECK(near(reported.dtheta_b_rad, kDtS * Eigen::Vector3d(0.25, -0.2, 0.1), 1e-18));
}

TEST_CASE("a trial is the same numbers whenever it runs, and another trial is not") {
  const ImuErrorModel model = imu_class_model(ImuClass::kTactical, RangeEnd::kMid);
  ImuErrorSimulator a(model, Random(1, 5, kImuStream));
  ImuErrorSimulator b(model, Random(1, 6, kImuStream));
  ImuErrorSimulator again(model, Random(1, 5, kImuStream));
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector3d dv = a.measure(some_increment()).dv_b_mps;
    CHECK(dv != b.measure(some_increment()).dv_b_mps);
    CHECK(dv == again.measure(some_increment()).dv_b_mps);
  }
}

TEST_CASE("an invalid error model is refused") {
  ImuErrorModel model;
  model.gyro.noise_density = -1.0;
  CHECK_THROWS_AS(ImuErrorSimulator(model, Random(1)), Error);
}

}  // namespace leeway::sim
