#include "tests/support/dense_algebra.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <unsupported/Eigen/MatrixFunctions>

namespace leeway::test {

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& A) { return A.inverse(); }

Eigen::MatrixXd exp_of(const Eigen::MatrixXd& A) { return A.exp(); }

Spectrum spectrum_of(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

DenseUpdate dense_update(const Wide& P, const Wide& H, const Wide& R, const Wide& z) {
  const Wide PHt = P * H.transpose();
  const Wide S = H * PHt + R;
  const Eigen::PartialPivLU<Wide> lu(S);
  const Wide K = lu.solve(PHt.transpose()).transpose();  // S is symmetric
  const Wide x = K * z;
  const Wide P_after = P - K * PHt.transpose();
  const Wide nis = z.transpose() * lu.solve(z);
  return {x.cast<double>(), P_after.cast<double>(), static_cast<double>(nis(0)),
          static_cast<double>(lu.determinant())};
}

}  // namespace leeway::test
