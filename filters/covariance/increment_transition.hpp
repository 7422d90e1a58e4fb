/// @file
/// What one increment of IMU data does to errors: the rows of its Phi, acting on lanes of columns.
#pragma once

#include <Eigen/Core>

#include "filters/covariance/lanes.hpp"
#include "leeway/covariance/transition.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/model/error_state.hpp"

namespace leeway::lanes {

/// The same few columns of all 15 rows, or what they become.
template <class Scalar>
using Column = Array<VectorOf<Scalar>, kErrorStates + 1>;

/// sum += row of a 3 x 3 block * lanes from `first` on.
template <int first, class Scalar, class Block>
[[gnu::always_inline]] inline void add_product(const Block& block, int row,
                                               const Column<Scalar>& in, VectorOf<Scalar>& sum) {
  unrolled<3>([&](auto k) __attribute__((always_inline)) {
    sum += static_cast<Scalar>(block(row, int{k})) * in[first + k];
  });
}

/// Rows of the Phi of one increment, by the midpoint rule: Groves (2013) (14.18)-(14.21). They act
/// on columns of P, and on those of a Phi that they extend.
template <class Scalar>
class StepRows {
 public:
  using Column = lanes::Column<Scalar>;

  explicit StepRows(const ErrorDynamics& step)
      : turn_(static_cast<Scalar>(step.dt_s * wgs84::kRotationRateRadps)),
        half_dt_(static_cast<Scalar>(0.5 * step.dt_s)),
        half_push_((-0.5 * step.dv_f_e_mps).cast<Scalar>()),
        by_a_((-0.5 * (1.0 + step.a_a) * step.dt_s * step.C_eb_mean).cast<Scalar>()),
        by_g_((-0.5 * (1.0 + step.g_g) * step.dt_s * step.C_eb_mean).cast<Scalar>()),
        by_r_((step.dt_s * step.gravity_gradient_e).cast<Scalar>()) {}

  [[gnu::always_inline]] void attitude(const Column& in, Column& out) const {
    unrolled<3>([&](auto i) __attribute__((always_inline)) {
      out[kPsi + i] = in[kPsi + i];
      add_product<kBg, Scalar>(by_g_, i, in, out[kPsi + i]);
    });
    out[kPsi] += turn_ * in[kPsi + 1];
    out[kPsi + 1] -= turn_ * in[kPsi];
  }

  [[gnu::always_inline]] void velocity(const Column& in, Column& out) const {
    Column both;  // the sum of before and after: twice the mean
    Column middle;
    unrolled<3>([&](auto i) __attribute__((always_inline)) {
      both[kPsi + i] = in[kPsi + i] + out[kPsi + i];
      middle[kDr + i] = in[kDr + i] + half_dt_ * in[kDv + i];
    });
    unrolled<3>([&](auto i) __attribute__((always_inline)) {
      constexpr int kNext = (i + 1) % 3;
      constexpr int kLast = (i + 2) % 3;
      VectorOf<Scalar>& v = out[kDv + i];
      v = in[kDv + i];
      add_product<kBa, Scalar>(by_a_, i, in, v);
      v += half_push_(kNext) * both[kPsi + kLast];
      v -= half_push_(kLast) * both[kPsi + kNext];
      both[kDv + i] = in[kDv + i] + v;
      add_product<kDr, Scalar>(by_r_, i, middle, v);
    });
    // Coriolis by the mean of v before and after the push.
    out[kDv] += turn_ * both[kDv + 1];
    out[kDv + 1] -= turn_ * both[kDv];
  }

  [[gnu::always_inline]] void position(const Column& in, Column& out) const {
    unrolled<3>([&](auto i) __attribute__((always_inline)) {
      out[kDr + i] = in[kDr + i] + half_dt_ * in[kDv + i] + half_dt_ * out[kDv + i];
    });
  }

 private:
  using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;

  Scalar turn_;
  Scalar half_dt_;
  Eigen::Matrix<Scalar, 3, 1> half_push_;
  Matrix3 by_a_;
  Matrix3 by_g_;
  Matrix3 by_r_;
};

}  // namespace leeway::lanes
