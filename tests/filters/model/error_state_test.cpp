#include "leeway/model/error_state.hpp"

#include <doctest/doctest.h>

#include <numbers>

#include "leeway/earth/rotation.hpp"
#include "tests/filters/model/random_state.hpp"
#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::near;
using test::random_estimate;

ErrorVector random_error(std::uint64_t seed, double angle_rad) {
  sim::Random random(seed, 1);
  ErrorVector x;
  x << angle_rad * random.normal3().normalized(), 10.0 * random.normal3(),
      1000.0 * random.normal3(), random.normal3(), random.normal3();
  return x;
}

/// Roundings at the size of the state: ECEF 6.4e6 m and 300 m/s.
void check_near(const ErrorVector& a, const ErrorVector& b) {
  CHECK(near(a.segment<3>(kPsi), b.segment<3>(kPsi), 4e-15));
  CHECK(near(a.segment<3>(kDv), b.segment<3>(kDv), 1e-13));
  CHECK(near(a.segment<3>(kDr), b.segment<3>(kDr), 2e-9));
  CHECK(near(a.tail<6>(), b.tail<6>(), 1e-15));
}

}  // namespace

TEST_CASE("difference undoes inject, from zero to pi") {
  for (const double angle_rad :
       {0.0, 1e-12, 1e-8, 1e-4, 0.1, 1.0, 3.0, std::numbers::pi - 1e-4, std::numbers::pi - 1e-8}) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
      CAPTURE(angle_rad);
      CAPTURE(seed);
      const Estimate before = random_estimate(seed);
      const ErrorVector x = random_error(seed, angle_rad);
      Estimate after = before;
      inject(after, x);
      check_near(difference(after, before), x);
      CHECK(near(after.nav.q_eb.norm(), 1.0, 1e-15));
      inject(after, -x);
      check_near(difference(after, before), ErrorVector::Zero());
    }
  }
}

TEST_CASE("signs: x = truth - estimate, C_eb(true) = exp([psi_e x]) C_eb(estimate)") {
  const Estimate estimate = random_estimate(1);
  const Eigen::Matrix3d C_eb = estimate.nav.q_eb.toRotationMatrix();
  // A right-handed quarter turn about the Earth's axis takes x_e to y_e.
  ErrorVector x = ErrorVector::Zero();
  x(kPsi + 2) = 0.5 * std::numbers::pi;
  x(kDv) = 1.0;
  x(kDr + 1) = 2.0;
  x(kBa + 2) = 3.0;
  x(kBg) = 4.0;
  Estimate truth = estimate;
  inject(truth, x);
  const Eigen::Matrix3d C_true = truth.nav.q_eb.toRotationMatrix();
  CHECK(near(C_true.row(1), C_eb.row(0), 1e-15));
  CHECK(near(C_true.row(0), -C_eb.row(1), 1e-15));
  CHECK(near(C_true.row(2), C_eb.row(2), 1e-15));
  CHECK(truth.nav.v_e_mps.x() == estimate.nav.v_e_mps.x() + 1.0);
  CHECK(truth.nav.r_e_m.y() == estimate.nav.r_e_m.y() + 2.0);
  CHECK(truth.bias.b_a_mps2.z() == estimate.bias.b_a_mps2.z() + 3.0);
  CHECK(truth.bias.b_g_radps.x() == estimate.bias.b_g_radps.x() + 4.0);
}

TEST_CASE("the attitude error does not see the sign of the quaternion") {
  const Estimate estimate = random_estimate(2);
  Estimate negated = estimate;
  negated.nav.q_eb.coeffs() *= -1.0;
  check_near(difference(negated, estimate), ErrorVector::Zero());
}

TEST_CASE("reset Jacobian against central differences through inject and difference") {
  const ErrorVector steps = test::jacobian_steps(3e-3, 1.0, 1000.0, 1.0, 1.0);
  for (const double angle_rad :
       {0.0, 1e-10, 1e-5, 0.01, 0.3, 1.0, 2.0, 3.0, std::numbers::pi - 1e-6}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      CAPTURE(angle_rad);
      CAPTURE(seed);
      const Estimate before = random_estimate(seed);
      const ErrorVector x_hat = random_error(seed, angle_rad);
      Estimate injected = before;
      inject(injected, x_hat);
      const auto error_after = [&](const ErrorVector& d) {
        Estimate truth = before;
        inject(truth, x_hat + d);
        return difference(truth, injected);
      };
      ErrorMatrix J = ErrorMatrix::Identity();
      J.topLeftCorner<3, 3>() = reset_jacobian(x_hat);
      // Rounding 1e-15 rad over a step of 3e-3 rad, and 1e-9 m over 1000 m.
      CHECK(near(test::central_jacobian(error_after, steps), J, 1e-10));
    }
  }
}

}  // namespace leeway
