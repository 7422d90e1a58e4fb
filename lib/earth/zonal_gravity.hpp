/// @file
/// The normal gravity field as a zonal series: its coefficients, found at compile time, and gravity
/// in line, for the strapdown. Heiskanen and Moritz (1967), chapter 2.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>

#include "leeway/earth/earth.hpp"
#include "lib/earth/triple.hpp"

namespace leeway::zonal {

inline constexpr double kE2 = wgs84::kEccentricitySq;
inline constexpr double kOmega = wgs84::kRotationRateRadps;

/// J2 of the normal field from the defining parameters, without the cancellation of the closed
/// form. Heiskanen and Moritz (2-58), (2-90) with q0 as its series in the second eccentricity.
constexpr double normal_j2() {
  const double ep2 = kE2 / (1.0 - kE2);
  const double a = wgs84::kSemiMajorAxisM;
  const double m = kOmega * kOmega * a * a * wgs84::kSemiMinorAxisM / wgs84::kGmM3PerS2;
  double q0_over_ep3 = 0.0;
  double power = 1.0;
  for (int n = 1; n <= 12; ++n) {
    q0_over_ep3 += 2.0 * n / ((2.0 * n + 1.0) * (2.0 * n + 3.0)) * power;
    power *= -ep2;
  }
  return kE2 / 3.0 * (1.0 - 2.0 / 15.0 * m / (ep2 * q0_over_ep3));
}

/// J_{2n} of the normal field. Heiskanen and Moritz (2-92).
constexpr double normal_j(int n) {
  const double j2 = normal_j2();
  double e_power = 1.0;
  for (int i = 0; i < n; ++i) e_power *= kE2;
  const double sign = n % 2 == 1 ? 1.0 : -1.0;
  return sign * 3.0 * e_power / ((2.0 * n + 1.0) * (2.0 * n + 3.0)) *
         (1.0 - n + 5.0 * n * j2 / kE2);
}

inline constexpr std::size_t kMaxPower = 16;
using Polynomial = std::array<double, kMaxPower>;  // coefficient of s^i

constexpr Polynomial legendre(int degree) {
  Polynomial previous{1.0};
  Polynomial current{0.0, 1.0};
  if (degree == 0) return previous;
  for (int n = 1; n < degree; ++n) {
    Polynomial next{};
    for (std::size_t i = 0; i < kMaxPower; ++i) {
      next[i] = -n * previous[i] / (n + 1.0);
      if (i > 0) next[i] += (2.0 * n + 1.0) * current[i - 1] / (n + 1.0);
    }
    previous = current;
    current = next;
  }
  return current;
}

constexpr Polynomial derivative(const Polynomial& p) {
  Polynomial d{};
  for (std::size_t i = 1; i < kMaxPower; ++i) d[i - 1] = static_cast<double>(i) * p[i];
  return d;
}

/// Sum over even degrees of c_n (a/r)^n p_n(s), all p_n even in s (or odd, after division by s), as
/// coefficients of (a/r)^2 and s^2.
template <int degree>
struct ZonalSum {
  static constexpr std::size_t kTerms = degree / 2 + 1;
  std::array<std::array<double, kTerms + 1>, kTerms> c{};

  constexpr void set(std::size_t term, double factor, const Polynomial& p, std::size_t parity) {
    for (std::size_t i = 0; i <= kTerms && 2 * i + parity < kMaxPower; ++i) {
      c[term][i] = factor * p[2 * i + parity];
    }
  }

  double operator()(double a_over_r_sq, double s_sq) const {
    double sum = 0.0;
    for (std::size_t term = kTerms; term-- > 0;) {
      double p = 0.0;
      for (std::size_t i = term + 2; i-- > 0;) p = p * s_sq + c[term][i];
      sum = sum * a_over_r_sq + p;
    }
    return sum;
  }
};

constexpr double zonal_factor(int n) { return n == 0 ? 1.0 : -normal_j(n); }

// With V_n = P_n(s) / r^(n+1), s = z / r: dV_n/dz = -(n+1) P_{n+1} / r^(n+2) and
// dV_n/dx = -x P'_{n+1} / r^(n+3). Differentiating once more gives the gradient.
template <int degree>
constexpr ZonalSum<degree> equatorial_sum() {
  ZonalSum<degree> sum;
  for (int n = 0; 2 * n <= degree; ++n) {
    sum.set(static_cast<std::size_t>(n), zonal_factor(n), derivative(legendre(2 * n + 1)), 0);
  }
  return sum;
}

template <int degree>
constexpr ZonalSum<degree> axial_sum() {
  ZonalSum<degree> sum;
  for (int n = 0; 2 * n <= degree; ++n) {
    sum.set(static_cast<std::size_t>(n), zonal_factor(n) * (2 * n + 1), legendre(2 * n + 1), 1);
  }
  return sum;
}

template <int degree>
constexpr ZonalSum<degree> axial_axial_sum() {
  ZonalSum<degree> sum;
  for (int n = 0; 2 * n <= degree; ++n) {
    sum.set(static_cast<std::size_t>(n), zonal_factor(n) * (2 * n + 1) * (2 * n + 2),
            legendre(2 * n + 2), 0);
  }
  return sum;
}

template <int degree>
constexpr ZonalSum<degree> axial_equatorial_sum() {
  ZonalSum<degree> sum;
  for (int n = 0; 2 * n <= degree; ++n) {
    sum.set(static_cast<std::size_t>(n), zonal_factor(n) * (2 * n + 1),
            derivative(legendre(2 * n + 2)), 1);
  }
  return sum;
}

template <int degree>
constexpr ZonalSum<degree> equatorial_equatorial_sum() {
  ZonalSum<degree> sum;
  for (int n = 0; 2 * n <= degree; ++n) {
    sum.set(static_cast<std::size_t>(n), zonal_factor(n),
            derivative(derivative(legendre(2 * n + 2))), 0);
  }
  return sum;
}

/// The two sums of gravity at once, their coefficients side by side for instructions that work on
/// pairs. Every power of s^2 is its own chain of operations, and the short chains are added first:
/// the time is that of the longest one. The first term, by far the largest, is added last.
template <int degree>
struct GravitySums {
  static constexpr std::size_t kTerms = ZonalSum<degree>::kTerms;
  std::array<std::array<std::array<double, 2>, kTerms>, kTerms> c{};

  constexpr GravitySums() {
    const ZonalSum<degree> equatorial = equatorial_sum<degree>();
    const ZonalSum<degree> axial = axial_sum<degree>();
    for (std::size_t term = 0; term < kTerms; ++term) {
      for (std::size_t i = 0; i <= term; ++i)
        c[term][i] = {equatorial.c[term][i], axial.c[term][i]};
    }
  }

  /// Equatorial, axial.
  Eigen::Array2d operator()(double a_over_r_sq, double s_sq) const {
    const auto coefficients = [this](std::size_t term, std::size_t i) {
      return Eigen::Map<const Eigen::Array2d>(c[term][i].data());
    };
    Eigen::Array2d sum = Eigen::Array2d::Zero();
    double power = a_over_r_sq;
    for (std::size_t term = 1; term < kTerms; ++term) {
      Eigen::Array2d p = coefficients(term, term);
      for (std::size_t i = term; i-- > 0;) p = p * s_sq + coefficients(term, i);
      sum += power * p;
      power *= a_over_r_sq;
    }
    return coefficients(0, 0) + sum;
  }
};

/// Gravity of the field up to a degree, the centrifugal force included.
template <int degree>
[[gnu::always_inline]] inline Triple gravity_e(const Triple& r_e_m) {
  static constexpr GravitySums<degree> kSums;
  const double inv_r_sq = 1.0 / squared_norm(r_e_m);
  const double q = wgs84::kSemiMajorAxisM * wgs84::kSemiMajorAxisM * inv_r_sq;
  const double s_sq = r_e_m.z * r_e_m.z * inv_r_sq;
  const double gm_over_r3 = wgs84::kGmM3PerS2 * inv_r_sq * std::sqrt(inv_r_sq);
  const Eigen::Array2d factors = -gm_over_r3 * kSums(q, s_sq);
  const double across = factors[0] + kOmega * kOmega;
  return {across * r_e_m.x, across * r_e_m.y, factors[1] * r_e_m.z};
}

inline constexpr int kJ2Degree = 2;
inline constexpr int kNormalDegree = 12;

}  // namespace leeway::zonal
