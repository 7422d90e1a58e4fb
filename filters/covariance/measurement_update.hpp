/// @file
/// A measurement taken into a symmetric covariance: all of its rows in one pass over P, or row by
/// row. P is exactly symmetric before and after.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/covariance/covariance_kernel.hpp"

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
/// H P H^T + 1 = L D L^T and U = P H^T L^-T.
///
/// The simple form loses as many digits as variances shrink by, and no variance, in any direction,
/// shrinks by more than 1 + trace(H P H^T). Where that is above `shrinkage`, or not a number,
/// nothing is done.
/// @param innovation  what was measured less what the estimate says, row by row; zero beyond them
/// @param x  the correction of the estimate
/// @returns the NIS of the rows if it was done
template <class Scalar, int N>
std::optional<Scalar> update_at_once(Eigen::Matrix<Scalar, N, N>& P, Eigen::Matrix<Scalar, N, 1>& x,
                                     int rows, const RowColumns<Scalar, N>& H,
                                     const RowValues<Scalar>& innovation, Scalar shrinkage);

/// Takes one row of unit variance into P.
/// @param form  Joseph's, or the simple one for any other
/// @param K  the gain
/// @returns the innovation's variance h P h^T + 1
template <class Scalar, int N>
Scalar update_by_row(Eigen::Matrix<Scalar, N, N>& P, Eigen::Matrix<Scalar, N, 1>& K,
                     const Eigen::Matrix<Scalar, N, 1>& h, UpdateForm form);

}  // namespace leeway
