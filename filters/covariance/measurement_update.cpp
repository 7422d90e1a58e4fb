#include "filters/covariance/measurement_update.hpp"

#include <algorithm>
#include <cmath>

#include "filters/covariance/lanes.hpp"
#include "leeway/covariance/symmetric_kernel.hpp"
#include "leeway/model/vehicle_state.hpp"

namespace leeway {
namespace {

using lanes::Blocks;
using lanes::each_block;
using lanes::load;
using lanes::start_of;
using lanes::store;
using lanes::unrolled;
using lanes::VectorOf;

/// Replaces the lower half of P by what `changed` makes of it, and the upper half by its mirror,
/// block by block in registers.
/// @param changed  from a column, a block of rows and their present lanes, the lanes to be
template <class Scalar, int N, class F>
[[gnu::always_inline]] inline void change_symmetric(Eigen::Matrix<Scalar, N, N>& P,
                                                    const F& changed) {
  using lanes::first_of;
  using lanes::kCount;
  using lanes::Square;
  constexpr int kLast = lanes::kBlocks<Scalar, N> - 1;
  // How many lanes of the last block the one before it has dealt with.
  constexpr int kDone = (kLast + 1) * kCount<Scalar> - N;
  unrolled<(kLast + 1) * (kLast + 1)>([&](auto n) __attribute__((always_inline)) {
    constexpr int kRows = n % (kLast + 1);
    constexpr int kColumns = n / (kLast + 1);
    if constexpr (kRows >= kColumns) {
      constexpr int kRow = start_of<Scalar, N>(kRows);
      constexpr int kColumn = start_of<Scalar, N>(kColumns);
      constexpr int kRowsDone = kRows == kLast ? kDone : 0;
      Scalar* const lower = P.data() + N * kColumn + kRow;
      Square<Scalar> old;
      Square<Scalar> fresh;
      unrolled<kCount<Scalar>>([&](auto j) __attribute__((always_inline)) {
        old[j] = load(lower + N * j);
        fresh[j] = changed(kColumn + j, kRows, old[j]);
      });
      Square<Scalar> mirror = fresh;
      lanes::transpose<Scalar>(mirror);
      unrolled<kCount<Scalar>>([&](auto j) __attribute__((always_inline)) {
        if constexpr (kRows == kColumns) fresh[j] = first_of<Scalar>(j, mirror[j], fresh[j]);
        if constexpr (kRowsDone > 0) fresh[j] = first_of<Scalar>(kRowsDone, old[j], fresh[j]);
        if constexpr (kColumns < kLast || j >= kDone) store<Scalar>(lower + N * j, fresh[j]);
      });
      if constexpr (kRows > kColumns) {
        Scalar* const upper = P.data() + N * kRow + kColumn;
        unrolled<kCount<Scalar>>([&](auto j) __attribute__((always_inline)) {
          if constexpr (j >= kRowsDone) store<Scalar>(upper + N * j, mirror[j]);
        });
      }
    }
  });
}

/// P h. Columns are taken by threes, as most of H comes; threes of zeros are skipped.
template <class Scalar, int N>
[[gnu::always_inline]] inline Blocks<Scalar, N> product(const Eigen::Matrix<Scalar, N, N>& P,
                                                        const Scalar* h) {
  Blocks<Scalar, N> u;
  each_block<Scalar, N>([&](int b, int) { u[b] = VectorOf<Scalar>{}; });
  unrolled<(N + 2) / 3>([&](auto triad) __attribute__((always_inline)) {
    constexpr int kFirst = 3 * triad;
    constexpr int kCount = std::min(3, N - kFirst);
    Scalar size = 0;
    unrolled<kCount>([&](auto k)
                         __attribute__((always_inline)) { size += std::abs(h[kFirst + k]); });
    if (size == 0) return;
    unrolled<kCount>([&](auto k) __attribute__((always_inline)) {
      const Scalar* column = P.data() + N * (kFirst + k);
      each_block<Scalar, N>([&](int b, int row) { u[b] += h[kFirst + k] * load(column + row); });
    });
  });
  return u;
}

/// h . u. The last block repeats lanes of the one before it where blocks do not divide N.
template <class Scalar, int N>
[[gnu::always_inline]] inline Scalar dot(const Scalar* h, const Scalar* u) {
  constexpr int kLast = lanes::kBlocks<Scalar, N> - 1;
  constexpr int kRepeated = (kLast + 1) * lanes::kCount<Scalar> - N;
  VectorOf<Scalar> sum = load(h) * load(u);
  unrolled<kLast>([&](auto block) __attribute__((always_inline)) {
    constexpr int kStart = start_of<Scalar, N>(block + 1);
    VectorOf<Scalar> h_b = load(h + kStart);
    if constexpr (block + 1 == kLast && kRepeated > 0) {
      h_b = lanes::first_of<Scalar>(kRepeated, VectorOf<Scalar>{}, h_b);
    }
    sum += h_b * load(u + kStart);
  });
  return lanes::total<Scalar>(sum);
}

/// A measurement of at most `rows` rows.
template <class Scalar, int N, int rows>
class WholeMeasurement {
 public:
  using Matrix = Eigen::Matrix<Scalar, N, N>;

  /// P H^T, and the lower half of S = H P H^T + 1.
  WholeMeasurement(const Matrix& P, const RowColumns<Scalar, N>& H) {
    for (int i = 0; i < rows; ++i) {
      const Blocks<Scalar, N> u = product<Scalar, N>(P, H.data() + N * i);
      each_block<Scalar, N>([&](int b, int row) { store<Scalar>(u_of(i) + row, u[b]); });
    }
    unrolled<rows>([&](auto j) __attribute__((always_inline)) {
      unrolled<rows - j>([&](auto n) __attribute__((always_inline)) {
        S_[j + n][j] = dot<Scalar, N>(H.data() + N * (j + n), u_of(j));
      });
      S_[j][j] += 1;
    });
  }

  Scalar shrinkage() const {
    Scalar sum = 1 - rows;
    unrolled<rows>([&](auto i) __attribute__((always_inline)) { sum += S_[i][i]; });
    return sum;
  }

  /// Makes each row independent of those before it, in S, in U and in what was measured.
  void decorrelate(RowValues<Scalar> y) {
    lanes::Array<lanes::Array<Scalar, rows>, rows> L;
    unrolled<rows>([&](auto j) __attribute__((always_inline)) {
      inverse_[j] = 1 / S_[j][j];
      unrolled<rows - 1 - j>([&](auto n) __attribute__((always_inline)) {
        constexpr int i = j + 1 + n;
        L[i][j] = S_[i][j] * inverse_[j];
        y(int{i}) -= L[i][j] * y(int{j});
        unrolled<n + 1>([&](auto k) __attribute__((always_inline)) {
          S_[i][j + 1 + k] -= L[i][j] * S_[j + 1 + k][j];
        });
      });
      nis_ += y(int{j}) * y(int{j}) * inverse_[j];
    });
    each_block<Scalar, N>([&](int, int row) __attribute__((always_inline)) {
      lanes::Array<VectorOf<Scalar>, rows> u;
      VectorOf<Scalar> x{};
      unrolled<rows>([&](auto i) __attribute__((always_inline)) {
        u[i] = load(u_of(i) + row);
        unrolled<i>([&](auto j) __attribute__((always_inline)) { u[i] -= L[i][j] * u[j]; });
        store<Scalar>(independent_.data() + N * i + row, u[i]);
        const VectorOf<Scalar> gain = inverse_[i] * u[i];
        store<Scalar>(gain_.data() + N * i + row, gain);
        x += y(int{i}) * gain;
      });
      store<Scalar>(x_.data() + row, x);
    });
  }

  const Eigen::Matrix<Scalar, N, 1>& correction() const { return x_; }
  Scalar nis() const { return nis_; }

  void subtract_from(Matrix& P) const {
    change_symmetric<Scalar, N>(
        P, [&](int j, int b, VectorOf<Scalar> lanes_of_P) __attribute__((always_inline)) {
          unrolled<rows>([&](auto i) __attribute__((always_inline)) {
            lanes_of_P -=
                gain_(j, int{i}) * load(independent_.data() + N * i + start_of<Scalar, N>(b));
          });
          return lanes_of_P;
        });
  }

 private:
  Scalar* u_of(int i) { return U_.data() + N * i; }

  Eigen::Matrix<Scalar, N, rows> U_;            // P H^T
  Eigen::Matrix<Scalar, N, rows> independent_;  // P H^T L^-T: not in place, as blocks overlap
  Eigen::Matrix<Scalar, N, rows> gain_;         // of the independent rows
  Eigen::Matrix<Scalar, N, 1> x_;
  lanes::Array<lanes::Array<Scalar, rows>, rows> S_;
  lanes::Array<Scalar, rows> inverse_;
  Scalar nis_{0};
};

template <int rows, class Scalar, int N>
std::optional<Scalar> update_rows(Eigen::Matrix<Scalar, N, N>& P, Eigen::Matrix<Scalar, N, 1>& x,
                                  const RowColumns<Scalar, N>& H,
                                  const RowValues<Scalar>& innovation, Scalar shrinkage) {
  WholeMeasurement<Scalar, N, rows> measurement(P, H);
  if (!(measurement.shrinkage() <= shrinkage)) return std::nullopt;
  measurement.decorrelate(innovation);
  measurement.subtract_from(P);
  x = measurement.correction();
  return measurement.nis();
}

}  // namespace

template <class Scalar, int N>
std::optional<Scalar> update_at_once(Eigen::Matrix<Scalar, N, N>& P, Eigen::Matrix<Scalar, N, 1>& x,
                                     int rows, const RowColumns<Scalar, N>& H,
                                     const RowValues<Scalar>& innovation, Scalar shrinkage) {
  return rows <= 3 ? update_rows<3>(P, x, H, innovation, shrinkage)
                   : update_rows<kMaxRows>(P, x, H, innovation, shrinkage);
}

template <class Scalar, int N>
Scalar update_by_row(Eigen::Matrix<Scalar, N, N>& P, Eigen::Matrix<Scalar, N, 1>& K,
                     const Eigen::Matrix<Scalar, N, 1>& h, UpdateForm form) {
  const Eigen::Matrix<Scalar, N, 1> Ph = P.lazyProduct(h);
  const Scalar variance = h.dot(Ph) + 1;
  // P h / s = K = c d with d = c P h: d d^T is symmetric to the bit, K (P h)^T is not.
  const Scalar c = 1 / std::sqrt(variance);
  const Eigen::Matrix<Scalar, N, 1> d = c * Ph;
  K = c * d;
  for (int j = 0; j < N; ++j) P.col(j) -= d(j) * d;
  if (form != UpdateForm::kJoseph) return variance;

  // What rounding made of A = P - d d^T shows in A h, which should be K. Taken out along K on both
  // sides, as Joseph's form does with every error of P:
  // A - r K^T - K r^T + (h r) K K^T, r = A h - K.
  const Eigen::Matrix<Scalar, N, 1> r = P.lazyProduct(h) - K;
  const Eigen::Matrix<Scalar, N, 1> q = r - h.dot(r) / 2 * K;
  for (int j = 0; j < N; ++j) {
    for (int i = j; i < N; ++i) P(i, j) -= q(i) * K(j) + K(i) * q(j);
    for (int i = j + 1; i < N; ++i) P(j, i) = P(i, j);
  }
  return variance;
}

#define LEEWAY_INSTANTIATE(Scalar, N)                                    \
  template std::optional<Scalar> update_at_once<Scalar, N>(              \
      Eigen::Matrix<Scalar, N, N>&, Eigen::Matrix<Scalar, N, 1>&, int,   \
      const RowColumns<Scalar, N>&, const RowValues<Scalar>&, Scalar);   \
  template Scalar update_by_row<Scalar, N>(Eigen::Matrix<Scalar, N, N>&, \
                                           Eigen::Matrix<Scalar, N, 1>&, \
                                           const Eigen::Matrix<Scalar, N, 1>&, UpdateForm)
LEEWAY_INSTANTIATE(float, kPaddedStates);
LEEWAY_INSTANTIATE(double, kPaddedStates);
LEEWAY_INSTANTIATE(double, kErrorStates);
LEEWAY_INSTANTIATE(double, kJointStates);
#undef LEEWAY_INSTANTIATE

}  // namespace leeway
