#include "leeway/ekf/fix_gate.hpp"

#include <cstddef>
#include <limits>

#include "filters/covariance/cholesky.hpp"
#include "leeway/ekf/update_outcome.hpp"
#include "leeway/model/chi_square.hpp"

namespace leeway {
namespace {

double nis_of(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& S) {
  return Cholesky<3>(S).normalized_square(innovation);
}

}  // namespace

FixGate::FixGate(double probability) {
  for (std::size_t dof = 1; dof < threshold_.size(); ++dof) {
    threshold_[dof] = probability > 0.0 ? chi_square_threshold(probability, static_cast<int>(dof))
                                        : std::numeric_limits<double>::infinity();
  }
}

UpdateOutcome FixGate::judge(const Measurement& m, const MeasurementMatrix& S, Time now) const {
  UpdateOutcome outcome;
  outcome.time = now;
  outcome.dof = m.rows();
  outcome.gate = threshold_[static_cast<std::size_t>(outcome.dof)];
  if (m.rows() == 6) {
    outcome.position_nis = nis_of(m.innovation.head<3>(), S.topLeftCorner<3, 3>());
    outcome.velocity_nis = nis_of(m.innovation.tail<3>(), S.bottomRightCorner<3, 3>());
  }
  const Cholesky<6> S_factor(S);
  outcome.covariance_positive = S_factor.positive();
  if (!outcome.covariance_positive) return outcome;
  outcome.nis = S_factor.normalized_square(m.innovation);
  outcome.log_det_S = S_factor.log_det();
  outcome.outcome =
      outcome.nis <= outcome.gate ? UpdateOutcome::Outcome::kFused : UpdateOutcome::Outcome::kGated;
  return outcome;
}

}  // namespace leeway
