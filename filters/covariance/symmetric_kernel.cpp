#include "leeway/covariance/symmetric_kernel.hpp"

#include <Eigen/Core>
#include <limits>

#include "filters/covariance/increment_transition.hpp"
#include "filters/covariance/lanes.hpp"
#include "filters/covariance/measurement_update.hpp"
#include "filters/covariance/symmetric_propagation.hpp"
#include "leeway/covariance/covariance.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {
namespace {

using lanes::VectorOf;

using lanes::unrolled;

/// Rows of a Phi that was formed.
template <class Scalar>
class TransitionRows {
 public:
  using Column = lanes::Column<Scalar>;
  explicit TransitionRows(const Transition& Phi) : Phi_(Phi) {}

  [[gnu::always_inline]] void attitude(const Column& in, Column& out) const {
    unrolled<3>([&](auto i) __attribute__((always_inline)) {
      VectorOf<Scalar> sum{};
      unrolled<3>([&](auto k) __attribute__((always_inline)) {
        sum += static_cast<Scalar>(Phi_.psi(int{i}, kPsi + k)) * in[kPsi + k];
        sum += static_cast<Scalar>(Phi_.psi(int{i}, kBg + k)) * in[kBg + k];
      });
      out[kPsi + i] = sum;
    });
  }

  [[gnu::always_inline]] void velocity(const Column& in, Column& out) const {
    motion<kDv>(Phi_.v, in, out);
  }

  [[gnu::always_inline]] void position(const Column& in, Column& out) const {
    motion<kDr>(Phi_.r, in, out);
  }

 private:
  template <int row>
  [[gnu::always_inline]] static void motion(const Transition::Rows& rows, const Column& in,
                                            Column& out) {
    unrolled<3>([&](auto i) __attribute__((always_inline)) {
      VectorOf<Scalar> sum{};
      unrolled<kErrorStates>([&](auto k) __attribute__((always_inline)) {
        sum += static_cast<Scalar>(rows(int{i}, int{k})) * in[k];
      });
      out[row + i] = sum;
    });
  }

  const Transition& Phi_;
};

}  // namespace

template <class Scalar, int N>
void propagate_symmetric(Eigen::Matrix<Scalar, N, N>& P, const Transition& Phi,
                         const ProcessNoise& noise) {
  lanes::propagate_symmetric<Scalar, N>(
      P, TransitionRows<Scalar>(Phi),
      {noise_variance(noise, 0.5 * Phi.dt_s), static_cast<Scalar>(Phi.a_a),
       static_cast<Scalar>(Phi.g_g)});
}

template <class Scalar, int N>
void propagate_symmetric(Eigen::Matrix<Scalar, N, N>& P, const ErrorDynamics& step,
                         const ProcessNoise& noise) {
  lanes::propagate_symmetric<Scalar, N>(
      P, lanes::StepRows<Scalar>(step),
      {noise_variance(noise, 0.5 * step.dt_s), static_cast<Scalar>(step.a_a),
       static_cast<Scalar>(step.g_g)});
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
void SymmetricKernel<Scalar>::turn_attitude(const Eigen::Matrix3d& J) {
  const Eigen::Matrix<Scalar, 3, 3>& T = J.cast<Scalar>();
  Eigen::Matrix<Scalar, 3, kPaddedStates> rows = T * P_.template middleRows<3>(kPsi);
  const Eigen::Matrix<Scalar, 3, 3> block = rows.template middleCols<3>(kPsi) * T.transpose();
  rows.template middleCols<3>(kPsi) = block.template selfadjointView<Eigen::Lower>();
  P_.template middleRows<3>(kPsi) = rows;
  P_.template middleCols<3>(kPsi) = rows.transpose();
}

template <class Scalar>
double SymmetricKernel<Scalar>::update(ErrorVector& x_hat, const ErrorVector& h, double z) {
  PaddedVector<Scalar> row;
  row.template head<kErrorStates>() = h.cast<Scalar>();
  row(kErrorStates) = 0;
  PaddedVector<Scalar> K;
  const Scalar variance = update_by_row<Scalar, kPaddedStates>(P_, K, row, form_);
  x_hat += (z - h.dot(x_hat)) * K.template head<kErrorStates>().template cast<double>();
  return static_cast<double>(variance);
}

template <class Scalar>
double SymmetricKernel<Scalar>::update(ErrorVector& x_hat, const MeasurementRows& H,
                                       const MeasurementValues& z) {
  if (form_ != UpdateForm::kSimple) {
    if (const auto nis = take_at_once(x_hat, H, z)) return static_cast<double>(*nis);
  }
  return update_in_sequence(*this, x_hat, H, z);
}

template <class Scalar>
std::optional<Scalar> SymmetricKernel<Scalar>::take_at_once(ErrorVector& x_hat,
                                                            const MeasurementRows& H,
                                                            const MeasurementValues& z) {
  const int rows = static_cast<int>(H.rows());
  RowColumns<Scalar, kPaddedStates> columns = RowColumns<Scalar, kPaddedStates>::Zero();
  RowValues<Scalar> innovation = RowValues<Scalar>::Zero();
  for (int i = 0; i < rows; ++i) {
    columns.col(i).template head<kErrorStates>() = H.row(i).transpose().template cast<Scalar>();
    innovation(i) = static_cast<Scalar>(z(i) - H.row(i).dot(x_hat));
  }
  PaddedVector<Scalar> x;
  const double shrinkage =
      form_ == UpdateForm::kBatch ? std::numeric_limits<double>::infinity() : kJosephShrinkage;
  const auto nis = update_at_once<Scalar, kPaddedStates>(P_, x, rows, columns, innovation,
                                                         static_cast<Scalar>(shrinkage));
  if (nis) x_hat += x.template head<kErrorStates>().template cast<double>();
  return nis;
}

template class SymmetricKernel<float>;
template class SymmetricKernel<double>;
template void propagate_symmetric<double, kErrorStates>(ErrorMatrix&, const Transition&,
                                                        const ProcessNoise&);
template void propagate_symmetric<double, kErrorStates>(ErrorMatrix&, const ErrorDynamics&,
                                                        const ProcessNoise&);

}  // namespace leeway
