#include "sim/motion/smoothing_spline.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace leeway::sim {
namespace {

constexpr int kDegree = 5;
constexpr int kWidth =
    kDegree + 1;  // basis functions at a time, and the half band of the equations

// Weight of the squared third differences of the coefficients against the samples of one knot: it
// decides where there are none, and costs a motion of a period in four knots 1e-4.
constexpr double kRoughness = 1e-4;

/// Where in the knots a time is: the index of its span and the fraction of it.
struct Place {
  Eigen::Index span;
  double fraction;
};

Place place_of(double t_s, double knot_s, Eigen::Index coefficients) {
  const double knots = t_s / knot_s;
  const auto last = static_cast<double>(coefficients - kWidth);
  const double span = std::clamp(std::floor(knots), 0.0, last);
  return {static_cast<Eigen::Index>(span), knots - span};
}

/// The basis functions that are not zero at a fraction of a span, by the recursion of de Boor.
template <class T>
std::array<T, kWidth> basis(const T& fraction) {
  std::array<T, kWidth> b{};
  b[0] = 1.0;
  for (int degree = 1; degree <= kDegree; ++degree) {
    T carried = 0.0;
    for (int i = 0; i < degree; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const T share = b[at] / static_cast<double>(degree);
      b[at] = carried + share * (1.0 + i - fraction);
      carried = share * (fraction + (degree - 1.0 - i));
    }
    b[static_cast<std::size_t>(degree)] = carried;
  }
  return b;
}

/// Symmetric equations of half band kWidth: row i holds the elements (i, i) to (i, i + kDegree).
using Band = Eigen::Matrix<double, Eigen::Dynamic, kWidth, Eigen::RowMajor>;

void add_roughness(Band& A, double weight) {
  constexpr std::array<double, 4> kThird{-1.0, 3.0, -3.0, 1.0};
  for (Eigen::Index first = 0; first + 3 < A.rows(); ++first) {
    for (int i = 0; i < 4; ++i) {
      for (int j = i; j < 4; ++j) {
        A(first + i, j - i) +=
            weight * kThird[static_cast<std::size_t>(i)] * kThird[static_cast<std::size_t>(j)];
      }
    }
  }
}

/// A x = b in place of b, by the Cholesky decomposition of the band. @pre A is positive definite.
void solve(Band& A, SmoothingSpline::Samples& b) {
  const Eigen::Index n = A.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    A.row(k) /= std::sqrt(A(k, 0));
    const Eigen::Index below = std::min<Eigen::Index>(kDegree, n - 1 - k);
    for (Eigen::Index i = 1; i <= below; ++i) {
      for (Eigen::Index j = i; j <= below; ++j) A(k + i, j - i) -= A(k, i) * A(k, j);
    }
    b.row(k) /= A(k, 0);
    for (Eigen::Index i = 1; i <= below; ++i) b.row(k + i) -= A(k, i) * b.row(k);
  }
  for (Eigen::Index k = n - 1; k >= 0; --k) {
    const Eigen::Index below = std::min<Eigen::Index>(kDegree, n - 1 - k);
    for (Eigen::Index i = 1; i <= below; ++i) b.row(k) -= A(k, i) * b.row(k + i);
    b.row(k) /= A(k, 0);
  }
}

}  // namespace

SmoothingSpline::SmoothingSpline(const std::vector<double>& t_s, const Samples& samples,
                                 double knot_s)
    : knot_s_(knot_s), end_s_(t_s.back()) {
  const auto spans = static_cast<Eigen::Index>(std::max(1.0, std::ceil(end_s_ / knot_s_)));
  const Eigen::Index count = spans + kDegree;
  Band A = Band::Zero(count, kWidth);
  coefficients_ = Samples::Zero(count, samples.cols());
  for (std::size_t k = 0; k < t_s.size(); ++k) {
    const Place place = place_of(t_s[k], knot_s_, count);
    const std::array<double, kWidth> b = basis(place.fraction);
    for (int i = 0; i < kWidth; ++i) {
      const double b_i = b[static_cast<std::size_t>(i)];
      coefficients_.row(place.span + i) += b_i * samples.row(static_cast<Eigen::Index>(k));
      for (int j = i; j < kWidth; ++j) {
        A(place.span + i, j - i) += b_i * b[static_cast<std::size_t>(j)];
      }
    }
  }
  add_roughness(A, kRoughness * static_cast<double>(t_s.size()) / static_cast<double>(spans));
  solve(A, coefficients_);
}

Jet SmoothingSpline::at(double t_s, Eigen::Index channel) const {
  const Place place = place_of(t_s, knot_s_, coefficients_.rows());
  const std::array<Jet, kWidth> b = basis(Jet(place.fraction, 1.0 / knot_s_, 0.0));
  Jet sum = 0.0;
  for (int i = 0; i < kWidth; ++i) {
    sum = sum + coefficients_(place.span + i, channel) * b[static_cast<std::size_t>(i)];
  }
  return sum;
}

std::vector<double> SmoothingSpline::knots_s() const {
  std::vector<double> knots_s;
  for (double k = 1.0; k * knot_s_ < end_s_; ++k) knots_s.push_back(k * knot_s_);
  return knots_s;
}

}  // namespace leeway::sim
