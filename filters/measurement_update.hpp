/// @file
/// A whole measurement taken into a symmetric covariance in one pass over it.
#pragma once

#include <Eigen/Core>

#include "leeway/filters/covariance_kernel.hpp"

namespace leeway {

/// The rows of a measurement as columns, of N states; those it does not have are zero.
template <class Scalar, int N>
using RowColumns = Eigen::Matrix<Scalar, N, kMaxRows>;
template <class Scalar>
using RowValues = Eigen::Matrix<Scalar, kMaxRows, 1>;

/// The largest `shrinkage` at which update_at_once() stands for Joseph's form: P loses two digits
/// of its sixteen at most.
inline constexpr double kJosephShrinkage = 100.0;

/// Takes rows of unit variance into P, all at once, in the simple form: P <- P - U D^-1 U^T with
/// H P H^T + 1 = L D L^T and U = P H^T L^-T. P is exactly symmetric before and after.
///
/// The simple form loses as many digits as variances shrink by, and no variance, in any direction,
/// shrinks by more than 1 + trace(H P H^T). Where that is above `shrinkage` nothing is done.
/// @param innovation  what was measured less what the estimate says, row by row; zero beyond them
/// @param x  the correction of the estimate
/// @returns whether it was done
template <class Scalar, int N>
bool update_at_once(Eigen::Matrix<Scalar, N, N>& P, Eigen::Matrix<Scalar, N, 1>& x, int rows,
                    const RowColumns<Scalar, N>& H, const RowValues<Scalar>& innovation,
                    Scalar shrinkage);

}  // namespace leeway
