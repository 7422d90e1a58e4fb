/// @file
/// The default covariance kernel: P in full storage, symmetric to the bit, the blocks of Phi that
/// exist, half of every symmetric product. Its double instance is what covariance.hpp runs on.
/// Instantiated for float and double.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/covariance/covariance.hpp"
#include "leeway/covariance/covariance_kernel.hpp"
#include "leeway/covariance/transition.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {

/// P in 16 rows and columns, the last of zeros: columns that vectors of 4 or 8 numbers divide.
inline constexpr int kPaddedStates = kErrorStates + 1;
template <class Scalar>
using PaddedMatrix = Eigen::Matrix<Scalar, kPaddedStates, kPaddedStates>;
template <class Scalar>
using PaddedVector = Eigen::Matrix<Scalar, kPaddedStates, 1>;

/// P <- Phi (P + Q/2) Phi^T + Q/2. N is 15 or 16.
template <class Scalar, int N>
void propagate_symmetric(Eigen::Matrix<Scalar, N, N>& P, const Transition& Phi,
                         const ProcessNoise& noise);

/// The same for the Phi of one increment, which is not formed: its rows act on P as advance() has
/// them act on Phi.
template <class Scalar, int N>
void propagate_symmetric(Eigen::Matrix<Scalar, N, N>& P, const ErrorDynamics& step,
                         const ProcessNoise& noise);

template <class Scalar>
class SymmetricKernel {
 public:
  using Number = Scalar;

  explicit SymmetricKernel(const ErrorMatrix& P, UpdateForm form = UpdateForm::kJoseph)
      : form_(form) {
    P_.setZero();
    set(P);
  }

  void set(const ErrorMatrix& P) {
    P_.template topLeftCorner<kErrorStates, kErrorStates>() = P.cast<Scalar>();
  }

  ErrorMatrix matrix() const {
    return P_.template topLeftCorner<kErrorStates, kErrorStates>().template cast<double>();
  }

  void propagate(const Transition& Phi, const ProcessNoise& noise);
  void propagate(const ErrorDynamics& step, const ProcessNoise& noise);

  double update(ErrorVector& x_hat, const ErrorVector& h, double z);
  double update(ErrorVector& x_hat, const MeasurementRows& H, const MeasurementValues& z);

  /// What becomes of P when the attitude error becomes J times what it is.
  void turn_attitude(const Eigen::Matrix3d& J);

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(P_);
  }

 private:
  std::optional<Scalar> take_at_once(ErrorVector& x_hat, const MeasurementRows& H,
                                     const MeasurementValues& z);

  PaddedMatrix<Scalar> P_;
  UpdateForm form_;
};

}  // namespace leeway
