#include "leeway/covariance/covariance_kernel.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "leeway/alternatives/dense_kernel.hpp"
#include "leeway/alternatives/ud_kernel.hpp"
#include "leeway/covariance/symmetric_kernel.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/model/process_noise.hpp"
#include "tests/filters/covariance/kernel_cases.hpp"

namespace leeway {
namespace {

using test::antenna_rows;
using test::positive_definite;
using test::prior;
using test::random_covariance;
using test::random_dynamics;
using test::scaled_distance;

static_assert(CovarianceKernel<DenseKernel<double>>);
static_assert(CovarianceKernel<SymmetricKernel<double>>);
static_assert(CovarianceKernel<UdKernel<double>>);

constexpr ProcessNoise kNoise{1e-6, 1e-4, 1e-5, 1e-9, 50.0, 100.0};

/// Ten different steps in a row.
Transition random_transition(std::uint64_t seed) {
  Transition Phi;
  for (std::uint64_t k = 0; k < 10; ++k) advance(Phi, random_dynamics(seed + k, 0.01, 50.0));
  return Phi;
}

/// Largest errors of a kernel against the dense one in long double, in units of sqrt(P_ii P_jj).
struct Worst {
  double predict{0.0};
  double fix{0.0};
};

template <class Kernel, auto... form>
Worst worst_over_random_states() {
  Worst worst;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const ErrorMatrix P = random_covariance(seed);
    Kernel kernel(P, form...);
    DenseKernel<long double> reference(P);
    const Transition Phi = random_transition(seed);
    kernel.propagate(Phi, kNoise);
    reference.propagate(Phi, kNoise);
    worst.predict = std::max(worst.predict, scaled_distance(kernel.matrix(), reference.matrix()));
    const MeasurementRows H = antenna_rows(random_dynamics(seed, 0.01, 50.0).C_eb_mean, 1.0, 0.1);
    const MeasurementValues z = MeasurementValues::LinSpaced(kMaxRows, -1.0, 2.0);
    ErrorVector x = ErrorVector::Zero();
    ErrorVector x_reference = ErrorVector::Zero();
    kernel.update(x, H, z);
    reference.update(x_reference, H, z);
    worst.fix = std::max(worst.fix, scaled_distance(kernel.matrix(), reference.matrix()));
    const ErrorVector sigma = reference.matrix().diagonal().cwiseSqrt();
    // What was measured is several sigma off: x is that much larger than sigma.
    worst.fix = std::max(worst.fix, 0.1 * (x - x_reference).cwiseQuotient(sigma).norm());
  }
  return worst;
}

/// The same over five minutes: a predict every 0.1 s along a slow turn, a fix every second.
template <class Kernel, auto... form>
double worst_over_minutes() {
  const ErrorMatrix P = prior(0.02, 1.0, 10.0, 0.05, 1e-3);
  Kernel kernel(P, form...);
  DenseKernel<long double> reference(P);
  ErrorDynamics step = random_dynamics(1, 0.1, 50.0);
  const Eigen::Matrix3d turn = exp_rotation({0.0, 0.0, 0.02});
  const MeasurementValues z = MeasurementValues::Zero(kMaxRows);
  double worst = 0.0;
  for (int k = 1; k <= 3000; ++k) {
    step.C_eb_mean = step.C_eb_mean * turn;
    step.dv_f_e_mps = step.C_eb_mean * Eigen::Vector3d(0.1, 0.4, -0.98);
    Transition Phi;
    advance(Phi, step);
    kernel.propagate(Phi, kNoise);
    reference.propagate(Phi, kNoise);
    if (k % 10 > 0) continue;
    const MeasurementRows H = antenna_rows(step.C_eb_mean, 1.0, 0.05);
    ErrorVector x = ErrorVector::Zero();
    kernel.update(x, H, z);
    reference.update(x, H, z);
    worst = std::max(worst, scaled_distance(kernel.matrix(), reference.matrix()));
  }
  return worst;
}

enum class Rows { kOneByOne, kAtOnce };

/// Twenty cycles of one predict and a fix of six rows, from a prior of 1000 m or more.
struct VaguePrior {
  double worst{0.0};            // of sqrt(P_ii P_jj), after each cycle
  int first_indefinite_row{0};  // counted from 1 over all cycles; 0: never
};

template <class Kernel, auto... form>
VaguePrior from_vague_prior(double prior_m, double fix_m, Rows rows = Rows::kOneByOne) {
  const ErrorMatrix P = prior(0.1, 10.0, prior_m, 0.3, 0.01);
  Kernel kernel(P, form...);
  UdKernel<long double> reference(P);  // the dense one would itself lose digits here
  const ErrorDynamics step = random_dynamics(1, 0.1, 50.0);
  Transition Phi;
  advance(Phi, step);
  const MeasurementRows H = antenna_rows(step.C_eb_mean, fix_m, 0.05);
  VaguePrior result;
  for (int cycle = 0; cycle < 20; ++cycle) {
    kernel.propagate(Phi, kNoise);
    reference.propagate(Phi, kNoise);
    ErrorVector x = ErrorVector::Zero();
    const auto note = [&](int row) {
      if (result.first_indefinite_row == 0 && !positive_definite(kernel.matrix())) {
        result.first_indefinite_row = kMaxRows * cycle + row;
      }
    };
    for (int i = 0; i < kMaxRows; ++i) {
      const ErrorVector h = H.row(i).transpose();
      reference.update(x, h, 0.0);
      if (rows == Rows::kAtOnce) continue;
      kernel.update(x, h, 0.0);
      note(i + 1);
    }
    if (rows == Rows::kAtOnce) {
      kernel.update(x, H, MeasurementValues::Zero(kMaxRows));
      note(kMaxRows);
    }
    result.worst = std::max(result.worst, scaled_distance(kernel.matrix(), reference.matrix()));
  }
  return result;
}

}  // namespace

TEST_CASE_TEMPLATE("double kernels agree with the dense one in long double", Kernel,
                   DenseKernel<double>, SymmetricKernel<double>, UdKernel<double>) {
  const Worst worst = worst_over_random_states<Kernel>();
  MESSAGE("predict " << worst.predict << ", fix " << worst.fix);
  CHECK(worst.predict < 5e-15);  // a dozen roundings
  CHECK(worst.fix < 1e-13);      // the innovation variance is up to 400 times the noise
  const double minutes = worst_over_minutes<Kernel>();
  MESSAGE("five minutes " << minutes);
  CHECK(minutes < 1e-12);  // 18000 roundings, forgotten as fixes come in
}

TEST_CASE_TEMPLATE("float kernels agree with the dense one in long double", Kernel,
                   DenseKernel<float>, SymmetricKernel<float>, UdKernel<float>) {
  // As above, a rounding being 5e8 times larger.
  const Worst worst = worst_over_random_states<Kernel>();
  MESSAGE("predict " << worst.predict << ", fix " << worst.fix);
  CHECK(worst.predict < 3e-6);
  CHECK(worst.fix < 5e-5);
  const double minutes = worst_over_minutes<Kernel>();
  MESSAGE("five minutes " << minutes);
  CHECK(minutes < 5e-4);
}

TEST_CASE("simple and batch forms agree with Joseph's where the prior is near the measurement") {
  const auto check = [](const Worst& worst) {
    CHECK(worst.predict < 5e-15);
    CHECK(worst.fix < 5e-13);  // they lose the ratio of prior to measurement, 400, once more
  };
  check(worst_over_random_states<SymmetricKernel<double>, UpdateForm::kSimple>());
  check(worst_over_random_states<SymmetricKernel<double>, UpdateForm::kBatch>());
  check(worst_over_random_states<DenseKernel<double>, UpdateForm::kSimple>());
  check(worst_over_random_states<DenseKernel<double>, UpdateForm::kBatch>());
}

TEST_CASE("propagate over one increment without Phi is advance and propagate") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    const ErrorDynamics step = random_dynamics(seed, 0.1, 5.0);
    Transition Phi;
    advance(Phi, step);
    ErrorMatrix expected = random_covariance(seed);
    ErrorMatrix P = expected;
    SymmetricKernel<double> kernel(P);
    propagate(expected, Phi, kNoise);
    propagate(P, step, kNoise);
    kernel.propagate(step, kNoise);
    CHECK(scaled_distance(P, expected) < 5e-15);  // a dozen roundings
    CHECK(scaled_distance(kernel.matrix(), expected) < 5e-15);
    CHECK(P == P.transpose());
  }
}

TEST_CASE("a variance of almost nothing is propagated as such by the factors") {
  // Two biases alone: the other elements of D are what rounding leaves, some of them so small that
  // their inverse is no number.
  ErrorMatrix P = ErrorMatrix::Zero();
  P(kBa, kBa) = P(kBa + 1, kBa + 1) = 1e-8;
  UdKernel<float> kernel(P);
  for (int k = 0; k < 100; ++k) {
    Transition Phi;
    advance(Phi, test::random_dynamics(1, 0.1, std::numeric_limits<double>::infinity()));
    kernel.propagate(Phi, ProcessNoise{});
  }
  CHECK(kernel.matrix().allFinite());
  CHECK(std::abs(kernel.matrix()(kBa, kBa) - 1e-8) < 1e-12);  // a thousand roundings of 6e-8
}

TEST_CASE("precise fixes on a vague prior, in float") {
  const VaguePrior simple = from_vague_prior<DenseKernel<float>, UpdateForm::kSimple>(1e3, 0.1);
  CHECK(simple.first_indefinite_row > 0);
  CHECK(simple.first_indefinite_row <= 2);
  CHECK((
      from_vague_prior<SymmetricKernel<float>, UpdateForm::kSimple>(1e3, 0.1).first_indefinite_row >
      0));
  const auto check = [](const VaguePrior& result, double bound) {
    CHECK(result.first_indefinite_row == 0);
    CHECK(result.worst < bound);
  };
  check(from_vague_prior<DenseKernel<float>>(1e3, 0.1), 2e-5);
  check(from_vague_prior<SymmetricKernel<float>>(1e3, 0.1), 2e-5);
  check(from_vague_prior<SymmetricKernel<float>>(1e3, 0.1, Rows::kAtOnce), 2e-5);
  check(from_vague_prior<UdKernel<float>>(1e3, 0.1), 5e-6);
}

TEST_CASE("precise fixes on a vague prior, in double") {
  // The simple form loses the squared ratio of the sigmas in digits: 1e10 leaves 1e-6 and worse,
  // 1e18 leaves nothing.
  const auto simple = [](double prior_m, double fix_m) {
    return from_vague_prior<SymmetricKernel<double>, UpdateForm::kSimple>(prior_m, fix_m);
  };
  CHECK(simple(1e4, 0.1).first_indefinite_row == 0);
  CHECK(simple(1e4, 0.1).worst < 1e-4);
  CHECK(simple(1e5, 1e-4).first_indefinite_row > 0);
  const auto check = [](const VaguePrior& result, double bound) {
    CHECK(result.first_indefinite_row == 0);
    CHECK(result.worst < bound);
  };
  check(from_vague_prior<SymmetricKernel<double>>(1e4, 0.1), 1e-12);
  check(from_vague_prior<SymmetricKernel<double>>(1e5, 1e-4), 1e-10);
  check(from_vague_prior<SymmetricKernel<double>>(1e4, 0.1, Rows::kAtOnce), 1e-12);
  check(from_vague_prior<SymmetricKernel<double>>(1e5, 1e-4, Rows::kAtOnce), 1e-10);
  check(from_vague_prior<UdKernel<double>>(1e5, 1e-4), 1e-12);
}

TEST_CASE("static and unaided: the vertical channel grows, float overflows, double does not") {
  // 24 h at 200 Hz is 17 million steps; with 1 s steps the same exponential growth takes 86400.
  // P_rr grows as exp(2 t sqrt(2 g / R)): 10^38, the end of float, after some hours.
  ErrorDynamics step = random_dynamics(1, 1.0, std::numeric_limits<double>::infinity());
  step.dv_f_e_mps = -9.8 * down_e_at(test::random_estimate(1).nav.r_e_m);
  Transition second;
  advance(second, step);
  Transition Phi;  // a minute
  for (int k = 0; k < 60; ++k) Phi = compose(second, Phi);
  constexpr ProcessNoise kMarine{1e-14, 1e-10, 0.0, 0.0};
  const ErrorMatrix P = prior(1e-4, 0.01, 1.0, 1e-4, 1e-8);
  SymmetricKernel<double> symmetric(P);
  UdKernel<double> ud(P);
  SymmetricKernel<float> single(P);
  UdKernel<long double> reference(P);
  int overflow_min = 0;
  for (int minute = 1; minute <= 24 * 60; ++minute) {
    symmetric.propagate(Phi, kMarine);
    ud.propagate(Phi, kMarine);
    single.propagate(Phi, kMarine);
    reference.propagate(Phi, kMarine);
    if (overflow_min == 0 && !single.matrix().allFinite()) overflow_min = minute;
  }
  MESSAGE("float overflows after " << overflow_min / 60.0 << " h; double "
                                   << scaled_distance(symmetric.matrix(), reference.matrix())
                                   << ", UD " << scaled_distance(ud.matrix(), reference.matrix()));
  CHECK(overflow_min > 4 * 60);
  CHECK(overflow_min < 9 * 60);
  CHECK(scaled_distance(symmetric.matrix(), reference.matrix()) < 1e-7);
  CHECK(scaled_distance(ud.matrix(), reference.matrix()) < 1e-10);
}

TEST_CASE("float loses the noise of single increments; ten a second keep it") {
  // Half of 5 ms of gyro noise is 2.5e-12 rad^2, below half a unit in the last place, 3.6e-12, of
  // the attitude's variance in float; half of 0.1 s is 7 units.
  const ErrorDynamics step = [] {
    ErrorDynamics d = random_dynamics(1, 0.005, std::numeric_limits<double>::infinity());
    d.dv_f_e_mps.setZero();
    return d;
  }();
  constexpr ProcessNoise kWeak{1e-9, 0.0, 0.0, 0.0};
  const ErrorMatrix P = prior(1e-2, 0.1, 1.0, 1e-3, 0.0);
  Transition Phi;
  for (int k = 0; k < 20; ++k) advance(Phi, step);
  SymmetricKernel<float> every(P);
  SymmetricKernel<float> decimated(P);
  SymmetricKernel<double> every_double(P);
  SymmetricKernel<double> decimated_double(P);
  constexpr int kSeconds = 600;
  for (int k = 0; k < 200 * kSeconds; ++k) {
    every.propagate(step, kWeak);
    every_double.propagate(step, kWeak);
    if (k % 20 > 0) continue;
    decimated.propagate(Phi, kWeak);
    decimated_double.propagate(Phi, kWeak);
  }
  const double grown = kWeak.attitude_rad2_per_s * kSeconds;
  const auto growth = [&](const auto& kernel) { return (kernel.matrix() - P)(0, 0) / grown; };
  MESSAGE("growth of the attitude's variance, of what is right: " << growth(every) << ", at 10 Hz "
                                                                  << growth(decimated));
  CHECK(growth(every_double) > 0.99);
  CHECK(std::abs(growth(every)) < 0.1);
  CHECK(std::abs(growth(decimated) - 1.0) < 0.1);  // 7 units, rounded
  CHECK(scaled_distance(decimated_double.matrix(), every_double.matrix()) < 4e-9);
}

}  // namespace leeway
