#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "leeway/strapdown/strapdown.hpp"
#include "tests/support/reference_vectors.hpp"

namespace leeway {
namespace {

using test::StrapdownError;

/// What the issue allows over the error a simple consumer of the same vector reaches.
constexpr double kAllowed = 1.2;

StrapdownError error_of(const NavState& state, const NavState& truth) {
  return {(state.r_e_m - truth.r_e_m).norm(), (state.v_e_mps - truth.v_e_mps).norm(),
          log_quaternion(state.q_eb * truth.q_eb.conjugate()).norm()};
}

StrapdownError larger(const StrapdownError& a, const StrapdownError& b) {
  return {std::max(a.position_m, b.position_m), std::max(a.velocity_mps, b.velocity_mps),
          std::max(a.attitude_rad, b.attitude_rad)};
}

/// Truth has `stride` rows for each increment. Errors are read at every `every`-th increment.
struct Run {
  StrapdownError largest{};
  StrapdownError last{};
};

Run run(Scheme scheme, const std::vector<ImuIncrement>& imu, const std::vector<NavState>& truth,
        std::size_t stride, std::size_t every) {
  const StrapdownFunction step = strapdown_function({scheme});
  NavState state = truth.front();
  ImuHistory history;
  Run errors;
  for (std::size_t k = 1; k <= imu.size(); ++k) {
    step(state, imu[k - 1], history);
    if (k % every != 0) continue;
    errors.last = error_of(state, truth[k * stride]);
    errors.largest = larger(errors.largest, errors.last);
  }
  return errors;
}

/// What rounding alone adds in n steps of T seconds altogether: three sigma of n random roundings.
/// Attitude: two additions a step to quaternion components in [0.5, 1), ulp 1.1e-16, sigma
/// ulp / sqrt(12), twice that as an angle, three axes: 1.6e-16 rad a step. Velocity: the specific
/// force turned by that angle for T, and ulp(250 m/s) = 2.8e-14
/// in three axes, 1.4e-14 m/s a step. Position: ulp(6.4e6 m) = 9.3e-10 m
/// in three axes, 4.7e-10 m a step, the velocity for T, and the rounding of the truth as it is
/// read.
StrapdownError rounding_floor(double steps, double duration_s) {
  StrapdownError floor;
  floor.attitude_rad = 3.0 * 1.6e-16 * std::sqrt(steps);
  floor.velocity_mps = 9.8 * duration_s * floor.attitude_rad + 3.0 * 1.4e-14 * std::sqrt(steps);
  floor.position_m = 3.0 * 4.7e-10 * std::sqrt(steps) + duration_s * floor.velocity_mps + 1.6e-9;
  return floor;
}

bool within(const StrapdownError& error, const StrapdownError& stated,
            const StrapdownError& floor) {
  return error.position_m <= kAllowed * stated.position_m + floor.position_m &&
         error.velocity_mps <= kAllowed * stated.velocity_mps + floor.velocity_mps &&
         error.attitude_rad <= kAllowed * stated.attitude_rad + floor.attitude_rad;
}

std::string printed(const StrapdownError& e) {
  char text[64];
  std::snprintf(text, sizeof text, "%.2e m  %.2e m/s  %.2e rad", e.position_m, e.velocity_mps,
                e.attitude_rad);
  return text;
}

/// Two-sample errors are read where a pair ends: within a pair the scheme has only the past to go
/// by, and at the very first increment nothing at all. So are those of the tables compared with.
std::size_t read_every(Scheme scheme) { return scheme == Scheme::kTwoSample ? 2 : 1; }

/// The increments of `count` neighbours, added: what the sensor gives at a lower rate.
std::vector<ImuIncrement> added(const std::vector<ImuIncrement>& imu, std::size_t count) {
  std::vector<ImuIncrement> sums;
  for (std::size_t k = 0; k + count <= imu.size(); k += count) {
    ImuIncrement sum = imu[k];
    for (std::size_t i = 1; i < count; ++i) {
      sum.time = imu[k + i].time;
      sum.dt_s += imu[k + i].dt_s;
      sum.dtheta_b_rad += imu[k + i].dtheta_b_rad;
      sum.dv_b_mps += imu[k + i].dv_b_mps;
    }
    sums.push_back(sum);
  }
  return sums;
}

std::vector<ImuIncrement> from_samples(const std::vector<ImuSample>& samples, std::size_t stride,
                                       RateMeaning meaning) {
  std::vector<ImuIncrement> imu;
  for (std::size_t k = stride; k < samples.size(); k += stride) {
    imu.push_back(increment_between(samples[k - stride], samples[k], meaning));
  }
  return imu;
}

/// Rows of the README tables that are schemes of ours. Its remaining one, a two-sample with half a
/// cross product, is a warning and not a scheme.
struct NamedScheme {
  const char* reference_name;
  Scheme scheme;
};
constexpr NamedScheme kNamedSchemes[] = {{"euler_paper", Scheme::kExplicitEuler},
                                         {"one_sample_exactrot", Scheme::kOneSample},
                                         {"two_sample_exactrot", Scheme::kTwoSample}};

void check_vector(const test::ReferenceVector& vector) {
  std::string table;
  for (const test::ReachableError& row : vector.reachable) {
    for (const NamedScheme& named : kNamedSchemes) {
      if (row.scheme != named.reference_name) continue;
      const bool slow = row.rate_hz == 100;
      const auto& imu = slow ? vector.imu_100hz : vector.imu_400hz;
      const Run errors =
          run(named.scheme, imu, vector.truth, slow ? 4 : 1, read_every(named.scheme));
      const StrapdownError floor =
          rounding_floor(static_cast<double>(imu.size()), to_seconds(imu.back().time));
      table += "\n  " + std::to_string(row.rate_hz) + " Hz " + row.scheme + ": " +
               printed(errors.largest) + "  (stated " + printed(row.error) + ")";
      CAPTURE(row.rate_hz);
      CAPTURE(row.scheme);
      CHECK_MESSAGE(within(errors.largest, row.error, floor),
                    printed(errors.largest) << " against " << printed(row.error));
    }
  }
  MESSAGE(vector.name << ", largest errors:" << table);
}

/// At least six increments in a period of whatever dominates the changes of the increments: their
/// fourth differences are then the smaller ones, by 2 (1 - cos(60 deg)) = 1 at most.
bool resolved(const std::vector<ImuIncrement>& imu) {
  const auto both = [&](std::size_t k) {
    Eigen::Matrix<double, 6, 1> sum;
    sum << imu[k].dtheta_b_rad, imu[k].dv_b_mps;
    return sum;
  };
  const auto second = [&](std::size_t k) {
    return (both(k - 1) - 2.0 * both(k) + both(k + 1)).eval();
  };
  Eigen::Matrix<double, 6, 1> second_sq = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 1> fourth_sq = Eigen::Matrix<double, 6, 1>::Zero();
  for (std::size_t k = 2; k + 2 < imu.size(); ++k) {
    second_sq += second(k).cwiseAbs2();
    fourth_sq += (second(k - 1) - 2.0 * second(k) + second(k + 1)).cwiseAbs2();
  }
  return fourth_sq.head<3>().sum() < second_sq.head<3>().sum() &&
         fourth_sq.tail<3>().sum() < second_sq.tail<3>().sum();
}

/// RK4 beats the two-sample scheme where that errs by more than rounding and the increments resolve
/// the motion: through fewer, no cubic fits. Read from the fourth increment on, which is the first
/// one with the four that it fits.
void check_runge_kutta(const test::ReferenceVector& vector) {
  std::string table;
  for (const std::size_t stride : {std::size_t{4}, std::size_t{1}}) {
    const auto& imu = stride == 4 ? vector.imu_100hz : vector.imu_400hz;
    const StrapdownError floor =
        rounding_floor(static_cast<double>(imu.size()), to_seconds(imu.back().time));
    const StrapdownError two = run(Scheme::kTwoSample, imu, vector.truth, stride, 4).largest;
    const StrapdownError rk4 = run(Scheme::kRungeKutta4, imu, vector.truth, stride, 4).largest;
    table += "\n  " + std::to_string(400 / stride) + " Hz RK4: " + printed(rk4) + "  (two-sample " +
             printed(two) + ")";
    if (!resolved(imu)) continue;
    CAPTURE(stride);
    CHECK((two.position_m <= floor.position_m || rk4.position_m < two.position_m));
    CHECK((two.velocity_mps <= floor.velocity_mps || rk4.velocity_mps < two.velocity_mps));
    CHECK((two.attitude_rad <= floor.attitude_rad || rk4.attitude_rad < two.attitude_rad));
  }
  MESSAGE(vector.name << ", fourth-order reference:" << table);
}

}  // namespace

TEST_CASE("every scheme stays within 1.2 of the error that each reference vector states") {
  const auto names = test::reference_vector_names();
  if (names.empty()) MESSAGE("skipped: no reference vectors under " LEEWAY_SHARED_DIR);
  for (const std::string& name : names) {
    CAPTURE(name);
    const test::ReferenceVector vector = test::read_reference_vector(name);
    REQUIRE(!vector.truth.empty());
    REQUIRE(!vector.reachable.empty());
    check_vector(vector);
    check_runge_kutta(vector);
  }
}

TEST_CASE("discretisation error of every scheme on manoeuvre_car after 100 s") {
  const auto names = test::reference_vector_names();
  if (std::find(names.begin(), names.end(), "manoeuvre_car") == names.end()) {
    MESSAGE("skipped: no manoeuvre_car under " LEEWAY_SHARED_DIR);
    return;
  }
  const test::ReferenceVector car = test::read_reference_vector("manoeuvre_car");
  enum class Input { kHeldPoints, kPoints, kIncrements };
  struct Row {
    const char* name;
    Scheme scheme;
    Input input;
    double stated_m[3];  ///< at 10, 5 and 2.5 ms: ../shared/reference/README.md
  };
  const Row rows[] = {
      {"explicit Euler", Scheme::kExplicitEuler, Input::kHeldPoints, {134.6, 67.2, 33.6}},
      {"semi-implicit Euler", Scheme::kSemiImplicitEuler, Input::kHeldPoints, {134.7, 67.3, 33.6}},
      {"trapezoid", Scheme::kTrapezoid, Input::kPoints, {0.646, 0.162, 0.0404}},
      {"one-sample", Scheme::kOneSample, Input::kIncrements, {0.0694, 0.0173, 4.3e-3}},
      {"two-sample", Scheme::kTwoSample, Input::kIncrements, {3.7e-4, 2.9e-5, 4.6e-6}},
      {"RK4", Scheme::kRungeKutta4, Input::kIncrements, {5.3e-4, 3.3e-5, 2.2e-6}}};
  std::string table;
  for (const Row& row : rows) {
    table += std::string("\n  ") + row.name + ":";
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t stride = std::size_t{4} >> i;
      const std::vector<ImuIncrement> imu =
          row.input == Input::kIncrements
              ? added(car.imu_400hz, stride)
              : from_samples(
                    car.samples, stride,
                    row.input == Input::kPoints ? RateMeaning::kPoint : RateMeaning::kPointHeld);
      const Run errors = run(row.scheme, imu, car.truth, stride, 2);
      const StrapdownError floor = rounding_floor(static_cast<double>(imu.size()), 100.0);
      char text[64];
      std::snprintf(text, sizeof text, "  %.3g m (stated %.3g)", errors.last.position_m,
                    row.stated_m[i]);
      table += text;
      CAPTURE(row.name);
      CAPTURE(stride);
      CHECK(errors.last.position_m <= kAllowed * row.stated_m[i] + floor.position_m);
      // The first-order rows are what they are: far below the table would be another scheme.
      if (row.input == Input::kHeldPoints) CHECK(errors.last.position_m >= row.stated_m[i] / 1.2);
    }
  }
  MESSAGE("manoeuvre_car after 100 s at 10, 5, 2.5 ms:" << table);
}

}  // namespace leeway
