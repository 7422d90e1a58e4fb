#include "leeway/sensors/imu_error_model.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>

#include "leeway/earth/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/numbers.hpp"

namespace leeway {
namespace {

using test::near;

using test::kInf;
using test::kNan;

/// Transition and noise covariance of (b, integral of b) over a step.
struct Moments {
  Eigen::Matrix2d Phi{Eigen::Matrix2d::Identity()};
  Eigen::Matrix2d Q{Eigen::Matrix2d::Zero()};
};

Moments moments(const GaussMarkovStep& step) {
  Moments m;
  m.Phi << step.phi, 0.0, step.integral_gain_s, 1.0;
  const double end = step.sigma_end * step.sigma_end;
  const double cross = step.integral_slope_s * end;
  m.Q << end, cross, cross,
      step.integral_slope_s * cross + step.sigma_integral * step.sigma_integral;
  return m;
}

/// db/dt = -b / tau + white noise, dI/dt = b: moments over dt by the midpoint rule, with the
/// response exp(-s / tau) written out and no closed form of an integral.
Moments integrated(const GaussMarkov& process, double dt_s) {
  constexpr int kPanels = 200'000;
  const long double h = static_cast<long double>(dt_s) / kPanels;
  const long double tau = process.tau_s;
  const long double density = 2.0L * static_cast<long double>(process.sigma) * process.sigma / tau;
  long double gain = 0.0L;  // integral of the response up to s
  long double Q[3] = {0.0L, 0.0L, 0.0L};
  for (int k = 0; k < kPanels; ++k) {
    const long double response = std::exp(-(k + 0.5L) * h / tau);
    const long double mid_gain = gain + 0.5L * h * response;
    Q[0] += h * density * response * response;
    Q[1] += h * density * response * mid_gain;
    Q[2] += h * density * mid_gain * mid_gain;
    gain += h * response;
  }
  Moments m;
  m.Phi << std::exp(-dt_s / process.tau_s), 0.0, static_cast<double>(gain), 1.0;
  m.Q << static_cast<double>(Q[0]), static_cast<double>(Q[1]), static_cast<double>(Q[1]),
      static_cast<double>(Q[2]);
  return m;
}

bool relatively_near(const Eigen::Matrix2d& a, const Eigen::Matrix2d& b, double tolerance) {
  return ((a - b).array().abs() <= tolerance * b.array().abs()).all();
}

std::string message_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("discretize is the integrated covariance of the process and of its integral") {
  for (const double ratio : {1e-3, 0.1, 0.499, 0.501, 1.0, 5.0}) {
    CAPTURE(ratio);
    const GaussMarkov process{3e-4, 40.0};
    const double dt_s = ratio * process.tau_s;
    const Moments closed = moments(discretize(process, dt_s));
    const Moments numeric = integrated(process, dt_s);
    CHECK(relatively_near(closed.Phi, numeric.Phi, 1e-9));
    // The midpoint rule errs by (h / tau)^2 and 1 / panels^2: 1e-9 at most.
    CHECK(relatively_near(closed.Q, numeric.Q, 2e-9));
  }
}

TEST_CASE("many small steps compose to the one big step") {
  const GaussMarkov process{2e-3, 100.0};
  const Moments small = moments(discretize(process, 0.01));
  Moments sum;
  for (int k = 0; k < 10'000; ++k) {
    sum.Q = small.Phi * sum.Q * small.Phi.transpose() + small.Q;
    sum.Phi = small.Phi * sum.Phi;
  }
  const Moments big = moments(discretize(process, 100.0));
  // 1e4 roundings of 1e-16, and of the square roots in between.
  CHECK(relatively_near(sum.Phi, big.Phi, 2e-12));
  CHECK(relatively_near(sum.Q, big.Q, 2e-12));
}

TEST_CASE("limits of the discretization") {
  SUBCASE("an infinite time makes a random constant") {
    const GaussMarkovStep step = discretize({0.5, kInf}, 0.01);
    CHECK(step.phi == 1.0);
    CHECK(step.integral_gain_s == 0.01);
    CHECK(step.sigma_end == 0.0);
    CHECK(step.sigma_integral == 0.0);
    CHECK(step.integral_slope_s == 0.0);
  }
  SUBCASE("a step far below the time: a random walk, Q = q [1 dt/2; dt/2 dt^2/3]") {
    const double dt_s = 1e-3;
    const GaussMarkov process{0.7, 1e7};
    const Moments m = moments(discretize(process, dt_s));
    const double q = 2.0 * process.sigma * process.sigma / process.tau_s * dt_s;
    Eigen::Matrix2d walk;
    walk << q, q * dt_s / 2.0, q * dt_s / 2.0, q * dt_s * dt_s / 3.0;
    CHECK(relatively_near(m.Q, walk, 1e-9));  // dt / tau = 1e-10
    CHECK(near(m.Phi(1, 0), dt_s, 1e-12));
  }
  SUBCASE("a step far above the time: white, integral with density 2 sigma^2 tau") {
    const GaussMarkov process{0.7, 1e-4};
    const Moments m = moments(discretize(process, 10.0));
    CHECK(m.Phi(0, 0) == 0.0);
    CHECK(near(m.Q(0, 0), 0.49, 1e-15));
    CHECK(near(m.Q(1, 1) / (2.0 * 0.49 * 1e-4 * 10.0), 1.0, 2e-5));  // 1.5 tau / dt
    CHECK(near(m.Q(0, 1), 0.49 * 1e-4, 1e-18));
  }
  SUBCASE("no sigma, no noise") {
    const GaussMarkovStep step = discretize({0.0, 100.0}, 0.01);
    CHECK(step.sigma_end == 0.0);
    CHECK(step.sigma_integral == 0.0);
  }
}

TEST_CASE("discretize refuses what has no meaning") {
  for (const double dt_s : {0.0, -1.0, kInf, kNan}) {
    CHECK_THROWS_AS(discretize({1.0, 1.0}, dt_s), Error);
  }
  CHECK_THROWS_AS(discretize({-1.0, 1.0}, 1.0), Error);
  CHECK_THROWS_AS(discretize({kNan, 1.0}, 1.0), Error);
  CHECK_THROWS_AS(discretize({1.0, 0.0}, 1.0), Error);
  CHECK_THROWS_AS(discretize({1.0, kNan}, 1.0), Error);
}

TEST_CASE("validate accepts the defaults and names the field, the value and the range otherwise") {
  CHECK_NOTHROW(validate(ImuErrorModel{}));
  struct Case {
    const char* field;
    const char* range;
    double bad;
    std::function<void(TriadErrorModel&, double)> set;
  };
  const char* const sigma = "finite and >= 0";
  const Case cases[] = {
      {"bias", "finite", kNan, [](auto& t, double x) { t.bias.y() = x; }},
      {"bias", "finite", kInf, [](auto& t, double x) { t.bias.z() = x; }},
      {"bias_sigma", sigma, -0.25, [](auto& t, double x) { t.bias_sigma = x; }},
      {"bias_sigma", sigma, kInf, [](auto& t, double x) { t.bias_sigma = x; }},
      {"M", "finite", kNan, [](auto& t, double x) { t.M(2, 1) = x; }},
      {"noise_density", sigma, -0.25, [](auto& t, double x) { t.noise_density = x; }},
      {"noise_density", sigma, kNan, [](auto& t, double x) { t.noise_density = x; }},
      {"in_run.sigma", sigma, -0.25, [](auto& t, double x) { t.in_run.sigma = x; }},
      {"in_run.tau_s", "> 0", 0.0, [](auto& t, double x) { t.in_run.tau_s = x; }},
      {"in_run.tau_s", "> 0", kNan, [](auto& t, double x) { t.in_run.tau_s = x; }},
      {"quantum", sigma, -0.25, [](auto& t, double x) { t.quantum = x; }},
      {"range", "> 0", -0.25, [](auto& t, double x) { t.range = x; }},
      {"range", "> 0", kNan, [](auto& t, double x) { t.range = x; }}};
  for (const Case& c : cases) {
    for (const bool gyro : {false, true}) {
      ImuErrorModel model;
      c.set(gyro ? model.gyro : model.accelerometer, c.bad);
      const std::string message = message_of([&] { validate(model); });
      const std::string value = std::isnan(c.bad)   ? "nan"
                                : std::isinf(c.bad) ? "inf"
                                : c.bad == 0.0      ? "0"
                                                    : "-0.25";
      CHECK(message == "IMU error model: " + std::string(gyro ? "gyro." : "accelerometer.") +
                           c.field + " is " + value + ", must be " + c.range);
    }
  }
  ImuErrorModel model;
  model.G_g_radps_per_mps2(0, 2) = kNan;
  CHECK(message_of([&] { validate(model); }) ==
        "IMU error model: G_g_radps_per_mps2 is nan, must be finite");
}

}  // namespace leeway
