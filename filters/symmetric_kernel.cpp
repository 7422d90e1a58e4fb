#include "leeway/filters/symmetric_kernel.hpp"

#include <Eigen/Core>

#include "batch_gain.hpp"
#include "lanes.hpp"
#include "leeway/earth.hpp"
#include "symmetric_propagation.hpp"
#include "symmetric_update.hpp"

namespace leeway {
namespace {

using lanes::VectorOf;

using lanes::unrolled;

/// sum += row of a block * lanes from `first` on.
template <int first, class Scalar, class Block>
[[gnu::always_inline]] inline void add_product(const Block& block, int row,
                                               const lanes::Column<Scalar>& in,
                                               VectorOf<Scalar>& sum) {
  unrolled<3>([&](auto k) __attribute__((always_inline)) {
    sum += static_cast<Scalar>(block(row, int{k})) * in[first + k];
  });
}

/// Rows of a Phi known by its blocks.
template <class Scalar>
class BlockRows {
 public:
  using Column = lanes::Column<Scalar>;
  explicit BlockRows(const Transition& Phi) : Phi_(Phi) {}

  void attitude(const Column& in, Column& out) const {
    unrolled<3>([&](auto i) __attribute__((always_inline)) {
      VectorOf<Scalar> sum{};
      add_product<kPsi, Scalar>(Phi_.psi_psi, i, in, sum);
      add_product<kBg, Scalar>(Phi_.psi_g, i, in, sum);
      out[kPsi + i] = sum;
    });
  }

  void velocity(const Column& in, Column& out) const {
    motion<kDv>(Phi_.v_psi, Phi_.v_v, Phi_.v_r, Phi_.v_a, Phi_.v_g, in, out);
  }

  void position(const Column& in, Column& out) const {
    motion<kDr>(Phi_.r_psi, Phi_.r_v, Phi_.r_r, Phi_.r_a, Phi_.r_g, in, out);
  }

 private:
  using Block = Eigen::Matrix3d;

  template <int row>
  static void motion(const Block& psi, const Block& v, const Block& r, const Block& a,
                     const Block& g, const Column& in, Column& out) {
    unrolled<3>([&](auto i) __attribute__((always_inline)) {
      VectorOf<Scalar> sum{};
      add_product<kPsi, Scalar>(psi, i, in, sum);
      add_product<kDv, Scalar>(v, i, in, sum);
      add_product<kDr, Scalar>(r, i, in, sum);
      add_product<kBa, Scalar>(a, i, in, sum);
      add_product<kBg, Scalar>(g, i, in, sum);
      out[row + i] = sum;
    });
  }

  const Transition& Phi_;
};

/// Rows of the Phi of one increment, as advance() has them act: Groves (2013) (14.18)-(14.21).
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

  void attitude(const Column& in, Column& out) const {
    unrolled<3>([&](auto i) __attribute__((always_inline)) {
      out[kPsi + i] = in[kPsi + i];
      add_product<kBg, Scalar>(by_g_, i, in, out[kPsi + i]);
    });
    out[kPsi] += turn_ * in[kPsi + 1];
    out[kPsi + 1] -= turn_ * in[kPsi];
  }

  void velocity(const Column& in, Column& out) const {
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

  void position(const Column& in, Column& out) const {
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

template <class Scalar>
lanes::Diagonal<Scalar> diagonal_of(const ProcessNoise& noise, double dt_s, double a_a,
                                    double g_g) {
  lanes::Diagonal<Scalar> diagonal;
  const ErrorVector half_q = noise_variance(noise, 0.5 * dt_s);
  for (int i = 0; i < kErrorStates; ++i) {
    diagonal.noise[i] = static_cast<Scalar>(half_q(i));
    diagonal.decay[i] = static_cast<Scalar>(i < kBa ? 1.0 : i < kBg ? a_a : g_g);
  }
  diagonal.noise[kErrorStates] = 0;
  diagonal.decay[kErrorStates] = 0;
  return diagonal;
}

}  // namespace

template <class Scalar, int N>
void propagate_symmetric(Eigen::Matrix<Scalar, N, N>& P, const Transition& Phi,
                         const ProcessNoise& noise) {
  lanes::propagate_symmetric<Scalar, N>(P, BlockRows<Scalar>(Phi),
                                        diagonal_of<Scalar>(noise, Phi.dt_s, Phi.a_a, Phi.g_g));
}

template <class Scalar, int N>
void propagate_symmetric(Eigen::Matrix<Scalar, N, N>& P, const ErrorDynamics& step,
                         const ProcessNoise& noise) {
  lanes::propagate_symmetric<Scalar, N>(P, StepRows<Scalar>(step),
                                        diagonal_of<Scalar>(noise, step.dt_s, step.a_a, step.g_g));
}

template <class Scalar>
void SymmetricKernel<Scalar>::propagate(const Transition& Phi, const ProcessNoise& noise) {
  propagate_symmetric<Scalar, kPaddedStates>(P_, Phi, noise);
}

template <class Scalar>
void SymmetricKernel<Scalar>::propagate(const ErrorDynamics& step, const ProcessNoise& noise) {
  propagate_symmetric<Scalar, kPaddedStates>(P_, step, noise);
}

template <class Scalar>
double SymmetricKernel<Scalar>::update(ErrorVector& x_hat, const ErrorVector& h, double z) {
  PaddedVector<Scalar> row;
  row.template head<kErrorStates>() = h.cast<Scalar>();
  row(kErrorStates) = 0;
  const ScalarGain<Scalar, kPaddedStates> gain =
      update_symmetric<Scalar, kPaddedStates>(P_, row, form_);
  x_hat += (z - h.dot(x_hat)) * gain.K.template head<kErrorStates>().template cast<double>();
  return static_cast<double>(gain.variance);
}

template <class Scalar>
void SymmetricKernel<Scalar>::update(ErrorVector& x_hat, const MeasurementRows& H,
                                     const MeasurementValues& z) {
  if (form_ == UpdateForm::kBatch) {
    update_batch(x_hat, H, z);
  } else {
    update_in_sequence(*this, x_hat, H, z);
  }
}

template <class Scalar>
void SymmetricKernel<Scalar>::update_batch(ErrorVector& x_hat, const MeasurementRows& H,
                                           const MeasurementValues& z) {
  const BatchFactor<Scalar, kPaddedStates> V = batch_gain<Scalar, kPaddedStates>(P_, x_hat, H, z);
  const int rows = static_cast<int>(H.rows());
  lanes::change_symmetric<Scalar, kPaddedStates>(
      P_, [&](int j, int b, const VectorOf<Scalar>& old) {
        VectorOf<Scalar> fresh = old;
        for (int i = 0; i < rows; ++i) {
          const Scalar* column = V.data() + kPaddedStates * i;
          fresh -= column[j] * lanes::load(column + lanes::start_of<Scalar, kPaddedStates>(b));
        }
        return fresh;
      });
}

template class SymmetricKernel<float>;
template class SymmetricKernel<double>;
template class SymmetricKernel<long double>;
template void propagate_symmetric<double, kErrorStates>(ErrorMatrix&, const Transition&,
                                                        const ProcessNoise&);
template void propagate_symmetric<double, kErrorStates>(ErrorMatrix&, const ErrorDynamics&,
                                                        const ProcessNoise&);

}  // namespace leeway
