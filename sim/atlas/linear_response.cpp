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

ErrorMatrix LinearResponse::true_moment() const {
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

std::vector<AtlasCell> LinearResponse::compared(
    const std::vector<AtlasColumn>& columns, const std::string& condition,
    const std::function<double(const ErrorMatrix&)>& size, const std::string& not_offered,
    const ErrorMatrix& Phi) const {
  const double truth = size(true_moment());
  const ErrorMatrix start = start_moment();
  const ErrorMatrix half_way = Phi.lazyProduct(start);
  const ErrorMatrix end = half_way.lazyProduct(Phi.transpose());
  std::vector<AtlasCell> cells;
  for (const AtlasColumn& column : claiming(columns)) {
    const auto filter = column.make(EkfConfig{.imu = {}}, {start_, start});
    for (const ImuIncrement& inc : imu_) filter->predict(inc);
    cells.push_back(
        {column.group, column.name, condition, factor_between(size(*filter->covariance()), truth)});
  }
  cells.push_back(
      {AtlasGroup::kNotOffered, not_offered, condition, factor_between(size(end), truth)});
  return cells;
}

double factor_between(double claimed, double truth) {
  if (!(claimed > 0.0 && truth > 0.0)) return std::numeric_limits<double>::infinity();
  return std::max(claimed / truth, truth / claimed);
}

}  // namespace leeway::sim
