#include "source_covariance.hpp"

#include <cmath>

namespace leeway::sim {
namespace {

double decay(double dt_s, double tau_s) {
  return std::isinf(tau_s) ? 1.0 : std::exp(-dt_s / tau_s);
}

/// (I - K h) P (I - K h)^T, plus what is given for the innovation's variance beyond h P h^T.
void apply_gain(ErrorMatrix& P, const ErrorVector& K, const ErrorVector& cross,
                double innovation_variance) {
  P.noalias() -= K * cross.transpose();
  P.noalias() -= cross * K.transpose();
  P.noalias() += innovation_variance * K * K.transpose();
}

}  // namespace

void WhiteSource::propagate(const Leg& leg) { leeway::propagate(P, leg.Phi, noise); }

void WhiteSource::update(const ScalarGain& gain) {
  const ErrorVector cross = P * gain.h;
  const double noise_variance = fix_variance(gain.axis) * gain.per_sigma * gain.per_sigma;
  apply_gain(P, gain.K, cross, gain.h.dot(cross) + noise_variance);
}

MarkovSource::MarkovSource(int enters_at, const Start& start, const GaussMarkov& process,
                           double filter_tau_s)
    : enters_at_(enters_at), process_(process), filter_tau_s_(filter_tau_s) {
  const Eigen::Matrix3d variance = start.variance.asDiagonal();
  G_ = variance + start.mean * start.mean.transpose();
  if (enters_at_ == kFixes) return;
  const Eigen::Vector3d error = start.mean - start.known;
  P_.block<3, 3>(enters_at_, enters_at_) = variance + error * error.transpose();
  S_.middleRows<3>(enters_at_) = variance + error * start.mean.transpose();
}

void MarkovSource::propagate(const Leg& leg) {
  // Half before and half after, as propagate() does with noise: second order in the step.
  step_process(0.5 * leg.Phi.dt_s);
  leeway::propagate(P_, leg.Phi, {});
  S_ = times<3>(leg.Phi, S_);
  step_process(0.5 * leg.Phi.dt_s);
}

/// g' = phi g + w; a bias state that the filter lets decay by its own phi gains delta g + w on the
/// filter's idea of it.
void MarkovSource::step_process(double dt_s) {
  const double phi = decay(dt_s, process_.tau_s);
  if (enters_at_ == kFixes) {
    S_ *= phi;
    return;
  }
  const double delta = phi - decay(dt_s, filter_tau_s_);
  const Eigen::Matrix3d Q =
      process_.sigma * process_.sigma * (1.0 - phi * phi) * Eigen::Matrix3d::Identity();
  P_.middleCols<3>(enters_at_) += delta * S_;
  P_.middleRows<3>(enters_at_) += delta * S_.transpose();
  P_.block<3, 3>(enters_at_, enters_at_) += delta * delta * G_ + Q;
  S_ *= phi;
  S_.middleRows<3>(enters_at_) += delta * phi * G_ + Q;
  G_ = phi * phi * G_ + Q;
}

void MarkovSource::update(const ScalarGain& gain) {
  ErrorVector cross = P_ * gain.h;
  Eigen::RowVector3d innovation_g = gain.h.transpose() * S_;  // E[innovation g^T]
  double variance = gain.h.dot(cross);
  if (enters_at_ == kFixes && gain.axis < 3) {
    variance += 2.0 * gain.per_sigma * innovation_g(gain.axis) +
                gain.per_sigma * gain.per_sigma * G_(gain.axis, gain.axis);
    cross += gain.per_sigma * S_.col(gain.axis);
    innovation_g += gain.per_sigma * G_.row(gain.axis);
  }
  apply_gain(P_, gain.K, cross, variance);
  S_ -= gain.K * innovation_g;
}

void ParameterSources::propagate(const Leg& leg) {
  S_ = times<kSensorParameters>(leg.Phi, S_) + leg.B;
}

void ParameterSources::update(const ScalarGain& gain) {
  S_ -= gain.K * (gain.h.transpose() * S_).eval();
}

ErrorMatrix ParameterSources::covariance(
    const Eigen::Matrix<double, kSensorParameters, kSensorParameters>& second_moment) const {
  return S_ * second_moment * S_.transpose();
}

}  // namespace leeway::sim
