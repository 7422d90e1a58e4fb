#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "leeway/alternatives/dense_kernel.hpp"
#include "leeway/alternatives/noise_rounding.hpp"
#include "leeway/alternatives/ud_kernel.hpp"
#include "leeway/covariance/symmetric_kernel.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/ekf/ekf.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/model/process_noise.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "tests/filters/model/random_state.hpp"
#include "tests/filters/navigator/recording.hpp"

namespace leeway {
namespace {

using test::scaled_distance;

constexpr double kDriveS = 60.0;

EkfConfig plain_config(double covariance_interval_s) {
  EkfConfig config;
  config.gnss_correlation_s = 0.0;
  config.gate_probability = 0.0;
  config.covariance_interval_s = covariance_interval_s;
  config.lever_arm_b_m = {0.5, -0.3, -1.2};
  return config;
}

/// Largest differences of a filter from Ekf on the same drive, looked at before and after every
/// fix and on the way.
struct Difference {
  double sigmas{0.0};      // of the estimate, in claimed sigmas
  double covariance{0.0};  // of sqrt(P_ii P_jj)
};

/// In sigmas. The reset is within Phi, where it takes half of Q of the first interval with it: in
/// proportion to that interval, 8e-5 at 1 s; at 0 s it is that of one increment, 0.02 s.
double tolerance(double interval_s) { return 2e-4 * std::max(interval_s, 0.02); }

template <class Kernel>
Difference difference_from_ekf(const EkfConfig& config, std::uint64_t seed) {
  static const sim::Trajectory trajectory = sim::car_drive({.duration_s = kDriveS});
  static const auto truth = sim::true_increments(trajectory, 50.0, kDriveS);
  sim::GnssErrorModel gnss;
  gnss.lever_arm_b_m = config.lever_arm_b_m;
  const auto log = test::record(trajectory, truth, config.imu, gnss, 1.0, 1.0, seed);
  const Estimate at_start = test::truth_estimate(trajectory, 0.0);
  const ErrorMatrix P = initial_covariance(at_start, {0.01, 0.02, 0.1, 2.5}, config.imu);
  const Estimate start = test::drawn_start(at_start, P, seed);
  Ekf reference(config, start, P);
  BasicEkf filter(config, start, Kernel(P));
  Difference worst;
  const auto look = [&] {
    const ErrorMatrix expected = reference.covariance();
    const ErrorVector x = difference(reference.estimate(), filter.estimate());
    const ErrorVector sigma = expected.diagonal().cwiseSqrt();
    worst.sigmas = std::max(worst.sigmas, x.cwiseQuotient(sigma).cwiseAbs().maxCoeff());
    worst.covariance = std::max(worst.covariance, scaled_distance(filter.covariance(), expected));
  };
  auto fix = log.fixes.begin();
  for (std::size_t k = 0; k < log.imu.size(); ++k) {
    reference.predict(log.imu[k]);
    filter.predict(log.imu[k]);
    if (k % 10 == 3) look();
    if (fix == log.fixes.end() || fix->time > log.imu[k].time) continue;
    look();
    reference.update(*fix);
    filter.update(*fix);
    ++fix;
    look();
  }
  return worst;
}

}  // namespace

TEST_CASE("on the dense kernel it is Ekf, seeds 1 to 3") {
  for (const double interval_s : {0.0, 0.1, 1.0}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      CAPTURE(interval_s);
      CAPTURE(seed);
      const auto worst = difference_from_ekf<DenseKernel<double>>(plain_config(interval_s), seed);
      MESSAGE("estimate " << worst.sigmas << " sigma, covariance " << worst.covariance);
      CHECK(worst.sigmas < tolerance(interval_s));
      CHECK(worst.covariance < tolerance(interval_s));
    }
  }
}

TEST_CASE("and weighs correlated fixes as Ekf does") {
  EkfConfig config = plain_config(0.1);
  config.gnss_correlation_s = 30.0;
  CHECK(difference_from_ekf<DenseKernel<double>>(config, 1).covariance < tolerance(0.1));
}

TEST_CASE_TEMPLATE("every other kernel in double, too", Kernel, DenseKernel<double>,
                   UdKernel<double>) {
  for (const double interval_s : {0.0, 0.1}) {
    CAPTURE(interval_s);
    const auto worst = difference_from_ekf<Kernel>(plain_config(interval_s), 1);
    CHECK(worst.sigmas < tolerance(interval_s));
    CHECK(worst.covariance < tolerance(interval_s));
  }
}

TEST_CASE("in float the factors stay within a thousandth of a sigma, full storage does not") {
  const EkfConfig config = plain_config(0.1);
  const auto factors = difference_from_ekf<UdKernel<float>>(config, 1);
  MESSAGE("estimate " << factors.sigmas << " sigma, covariance " << factors.covariance);
  CHECK(factors.sigmas < 1e-3);
  CHECK(factors.covariance < 1e-3);
  // What float loses in P - K h P, relative to variances that have shrunk by 1e5.
  const auto full = difference_from_ekf<SymmetricKernel<float>>(config, 1);
  MESSAGE("estimate " << full.sigmas << " sigma, covariance " << full.covariance);
  CHECK(full.sigmas < 0.05);
  CHECK(full.covariance < 0.05);
}

TEST_CASE("a fix without numbers changes nothing") {
  const Estimate at = test::at_equator();
  const EkfConfig config = plain_config(0.1);
  const ErrorMatrix P = initial_covariance(at, {0.01, 0.02, 0.1, 2.5}, config.imu);
  BasicEkf filter(config, at, SymmetricKernel<double>(P));
  filter.update(GnssFix{});
  CHECK(filter.covariance() == P);
  CHECK(filter.estimate().nav.r_e_m == at.nav.r_e_m);
}

TEST_CASE_TEMPLATE("the NIS of a fix is that of Ekf", Kernel, DenseKernel<double>,
                   SymmetricKernel<double>, UdKernel<double>) {
  const Estimate at = test::at_equator();
  const EkfConfig config = plain_config(0.1);
  const ErrorMatrix P = initial_covariance(at, {0.01, 0.02, 0.1, 2.5}, config.imu);
  GnssFix fix;
  fix.time = at.nav.time;
  fix.position = {at.nav.r_e_m + Eigen::Vector3d(3.0, -2.0, 5.0),
                  4.0 * Eigen::Matrix3d::Identity()};
  fix.velocity = {at.nav.v_e_mps + Eigen::Vector3d(0.1, 0.2, -0.1),
                  0.01 * Eigen::Matrix3d::Identity()};
  const UpdateOutcome expected = Ekf(config, at, P).update(fix);
  BasicEkf filter(config, at, Kernel(P));
  const UpdateOutcome fused = filter.update(fix);
  CHECK(fused.dof == expected.dof);
  CHECK(std::abs(fused.nis - expected.nis) < 1e-9 * expected.nis);  // rounding
}

TEST_CASE("process noise below half a unit in the last place is lost, and said to be") {
  const EkfConfig config = plain_config(0.0);
  const ErrorMatrix P = initial_covariance(test::at_equator(), {1.0, 1.0, 0.1, 2.5}, config.imu);
  const ErrorVector added = noise_variance(process_noise(config.imu), 0.5e-3);
  // (0.3 deg/sqrt(h))^2 * 0.5 ms = 4e-12 on a variance of 1: float has no digit for it.
  CHECK(noise_rounding<float>(P.diagonal(), added) == 1.0);
  CHECK(noise_rounding<double>(P.diagonal(), added) < 1e-3);
}

TEST_CASE("an invalid configuration is refused by the field's name") {
  EkfConfig config = plain_config(-1.0);
  const auto make = [&config] {
    BasicEkf(config, test::at_equator(), SymmetricKernel<double>(ErrorMatrix::Identity()));
  };
  CHECK_THROWS_WITH_AS(make(), doctest::Contains("covariance_interval_s"), Error);
}

}  // namespace leeway
