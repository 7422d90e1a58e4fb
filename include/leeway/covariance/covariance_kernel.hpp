/// @file
/// What every covariance kernel can do: a way of storing the covariance of the error state, of
/// propagating it and of taking a measurement into it.
#pragma once

#include <Eigen/Core>
#include <concepts>

#include "leeway/covariance/covariance.hpp"
#include "leeway/covariance/transition.hpp"
#include "leeway/earth/names.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {

/// The kernels by name, for programs that choose at run time.
enum class KernelForm {
  kDense,      ///< full products: the reference of tests and benchmarks
  kSymmetric,  ///< blocks of Phi, symmetric P (default)
  kUd,         ///< P = U D U^T
};
constexpr auto names(KernelForm) { return std::array{"dense", "symmetric", "ud"}; }

/// How the dense and the symmetric kernel take a measurement.
enum class UpdateForm {
  kSimple,  ///< (I - K h) P, row by row
  kJoseph,  ///< (I - K h) P (I - K h)^T + K K^T, row by row (default)
  kBatch,   ///< all rows at once, by the Cholesky factor of the innovation's covariance
};
constexpr auto names(UpdateForm) { return std::array{"simple", "joseph", "batch"}; }

/// What a kernel computes in, for programs that choose: long double is for references.
enum class Precision { kFloat, kDouble };
constexpr auto names(Precision) { return std::array{"float", "double"}; }

template <class Scalar>
using CovarianceMatrix = Eigen::Matrix<Scalar, kErrorStates, kErrorStates>;
template <class Scalar>
using CovarianceVector = Eigen::Matrix<Scalar, kErrorStates, 1>;

/// Rows of unit variance and what was measured by each: z = H x + noise. At most 6.
inline constexpr int kMaxRows = 6;
using MeasurementRows = decltype(Measurement::H);
using MeasurementValues = decltype(Measurement::innovation);

/// P <- Phi (P + Q/2) Phi^T + Q/2 by propagate(). Scalar update() returns the innovation variance
/// h P h^T + 1; the update of a whole measurement runs the scalars in sequence unless a kernel says
/// otherwise, and returns its NIS. The estimate x_hat is double in every kernel. Nothing allocates
/// or throws.
template <class K>
concept CovarianceKernel = std::constructible_from<K, const ErrorMatrix&> &&
    requires(K kernel, const K& same, const Transition& Phi, const ProcessNoise& noise,
             ErrorVector& x_hat, const ErrorVector& h, double z, const MeasurementRows& H,
             const MeasurementValues& values) {
  typename K::Number;  // what it computes in
  { same.matrix() } -> std::same_as<ErrorMatrix>;
  kernel.propagate(Phi, noise);
  { kernel.update(x_hat, h, z) } -> std::same_as<double>;
  { kernel.update(x_hat, H, values) } -> std::same_as<double>;
};

/// A kernel that stores P such that another can be put in its place. Only over such a kernel can a
/// filter be corrected by hand, hold directions, or estimate the vehicle's parameters.
template <class K>
concept SettableKernel = CovarianceKernel<K> &&
    requires(K kernel, const ErrorMatrix& P, const Eigen::Matrix3d& J) {
  kernel.set(P);
  kernel.turn_attitude(J);  // what becomes of P when the attitude error becomes J times what it is
};

/// The update of a whole measurement by scalars in sequence. @returns the NIS
template <class K>
double update_in_sequence(K& kernel, ErrorVector& x_hat, const MeasurementRows& H,
                          const MeasurementValues& z) {
  double nis = 0.0;
  for (int i = 0; i < H.rows(); ++i) {
    const ErrorVector h = H.row(i).transpose();
    const double innovation = z(i) - h.dot(x_hat);
    nis += innovation * innovation / kernel.update(x_hat, h, z(i));
  }
  return nis;
}

}  // namespace leeway
