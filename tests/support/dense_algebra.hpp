/// @file
/// What references are computed with: dense, in long double where that matters. Compiled once, in
/// dense_algebra.cpp: for every size anew, Eigen's inverse and its large products take long.
#pragma once

#include <Eigen/Core>

namespace leeway::test {

using Wide = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// The inverse of a square matrix.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& A);

/// The exponential of a square matrix.
Eigen::MatrixXd exp_of(const Eigen::MatrixXd& A);

/// The eigenvectors of a symmetric matrix as columns, and its eigenvalues, the smallest first.
struct Spectrum {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
Spectrum spectrum_of(const Eigen::MatrixXd& A);

/// The Kalman update of the textbook.
struct DenseUpdate {
  Eigen::VectorXd x;  ///< K z
  Eigen::MatrixXd P;  ///< P - K H P
  double nis{};       ///< z^T S^-1 z
  double det_S{};
};

/// Takes the measurement z = H x + noise of covariance R into P.
DenseUpdate dense_update(const Wide& P, const Wide& H, const Wide& R, const Wide& z);

}  // namespace leeway::test
