#include "leeway/model/horizontal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "leeway/earth/earth.hpp"

namespace leeway {
namespace {

/// P(radius > r) and minus its derivative, for principal variances a >= b: with the error written
/// as (sqrt(a) rho cos(u), sqrt(b) rho sin(u)), the mean over u of exp(-r^2 / (2 (a cos^2 u + b
/// sin^2 u))). The midpoint rule converges faster than any power on a smooth periodic function.
struct Tail {
  double probability{0.0};
  double density{0.0};
};

constexpr std::size_t kNodes = 64;  // on a quarter of the period

const std::array<double, kNodes> kCosSq = [] {
  std::array<double, kNodes> cos_sq{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double c = std::cos((static_cast<double>(i) + 0.5) * 0.5 * std::numbers::pi / kNodes);
    cos_sq[i] = c * c;
  }
  return cos_sq;
}();

Tail tail(const Eigen::Vector2d& variances, double r) {
  Tail sum;
  for (const double cos_sq : kCosSq) {
    const double variance = variances(0) * cos_sq + variances(1) * (1.0 - cos_sq);
    const double survival = std::exp(-0.5 * r * r / variance);
    sum.probability += survival / kNodes;
    sum.density += survival * r / variance / kNodes;
  }
  return sum;
}

}  // namespace

Eigen::Matrix2d horizontal_covariance(const Eigen::Vector3d& r_e_m,
                                      const Eigen::Matrix3d& P_rr_e_m2) {
  const Eigen::Matrix<double, 3, 2> C_e_ne = ned_to_ecef(geodetic_from_ecef(r_e_m)).leftCols<2>();
  return C_e_ne.transpose() * P_rr_e_m2 * C_e_ne;
}

Eigen::Vector2d principal_variances(const Eigen::Matrix2d& P) {
  const double mean = 0.5 * P.trace();
  const double spread = std::hypot(0.5 * (P(0, 0) - P(1, 1)), P(0, 1));
  return {mean + spread, std::max(mean - spread, 0.0)};
}

double horizontal_radius_m(const Eigen::Matrix2d& P_ne_m2, double probability) {
  const Eigen::Vector2d variances = principal_variances(P_ne_m2);
  if (!(variances(0) > 0.0)) return 0.0;
  // Newton's method on the logarithm of the tail, which is concave, from the circle's radius, which
  // is too large: it descends to the root without overshooting.
  const double log_tail = std::log1p(-probability);
  double r = std::sqrt(-2.0 * variances(0) * log_tail);
  for (int i = 0; i < 50; ++i) {
    const Tail t = tail(variances, r);
    const double step = (std::log(t.probability) - log_tail) * t.probability / t.density;
    r += step;
    if (std::abs(step) < 1e-12 * r) break;
  }
  return r;
}

double probability_beyond(const Eigen::Matrix2d& P_ne_m2, double radius_m) {
  const Eigen::Vector2d variances = principal_variances(P_ne_m2);
  if (variances(0) == 0.0) return 0.0;
  return tail(variances, radius_m).probability;
}

}  // namespace leeway
