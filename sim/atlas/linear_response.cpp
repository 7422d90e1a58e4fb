#include "sim/atlas/linear_response.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "leeway/ekf/inertial_estimate.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"

namespace leeway::sim {

LinearResponse::LinearResponse(const Trajectory& trajectory, double rate_hz, double duration_s,
                               std::vector<ErrorVector> start_errors)
    : start_errors_(std::move(start_errors)),
      imu_(true_increments(trajectory, rate_hz, duration_s)) {
  start_.nav = truth_at(trajectory, 0.0).nav;
}

Estimate LinearResponse::strapdown_from(const Estimate& start) const {
  InertialEstimate inertial(EkfConfig{.imu = {}}, start);
  for (const ImuIncrement& inc : imu_) inertial.advance(inc);
  return inertial.estimate();
}

ErrorMatrix LinearResponse::truth() const {
  const Estimate right = strapdown_from(start_);
  ErrorMatrix moment = ErrorMatrix::Zero();
  for (const ErrorVector& x : start_errors_) {
    Estimate wrong = start_;
    inject(wrong, -x);
    const ErrorVector error = difference(right, strapdown_from(wrong));
    moment += error * error.transpose();
  }
  return moment;
}

ErrorMatrix LinearResponse::start_moment() const {
  ErrorMatrix moment = ErrorMatrix::Zero();
  for (const ErrorVector& x : start_errors_) moment += x * x.transpose();
  return moment;
}

ErrorMatrix LinearResponse::claim(const AtlasColumn& column) const {
  const auto filter = column.make(EkfConfig{.imu = {}}, {start_, start_moment()});
  for (const ImuIncrement& inc : imu_) filter->predict(inc);
  const auto P = filter->covariance();
  return P ? *P : ErrorMatrix::Constant(std::numeric_limits<double>::quiet_NaN());
}

ErrorMatrix LinearResponse::carried(const ErrorMatrix& Phi) const {
  return Phi * start_moment() * Phi.transpose();
}

double factor_between(double claimed, double truth) {
  if (!(claimed > 0.0 && truth > 0.0)) return std::numeric_limits<double>::infinity();
  return std::max(claimed / truth, truth / claimed);
}

}  // namespace leeway::sim
