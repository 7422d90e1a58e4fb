#include "sim/analysis/source_covariance.hpp"

#include <cmath>

namespace leeway::sim {
namespace {

double decay(double dt_s, double tau_s) {
  return std::isinf(tau_s) ? 1.0 : std::exp(-dt_s / tau_s);
}

}  // namespace

void SourceCovariance::add_process(MarkovSource source, const MarkovStart& start) {
  const Eigen::Matrix3d variance = start.variance.asDiagonal();
  source.G = variance + start.mean * start.mean.transpose();
  if (source.enters_at != MarkovSource::kFixes) {
    const Eigen::Vector3d error = start.mean - start.known;
    P.block<3, 3>(source.enters_at, source.enters_at) += variance + error * error.transpose();
    source.S.middleRows<3>(source.enters_at) = variance + error * start.mean.transpose();
  }
  processes_.push_back(source);
}

void SourceCovariance::propagate(const Leg& leg) {
  // Half before and half after, as propagate() does with noise: second order in the step.
  for (MarkovSource& source : processes_) step_process(source, 0.5 * leg.Phi.dt_s);
  leeway::propagate(P, leg.Phi, noise);
  for (MarkovSource& source : processes_) {
    source.S = times(leg.Phi, source.S);
    step_process(source, 0.5 * leg.Phi.dt_s);
  }
}

/// g' = phi g + w; a bias state that the filter lets decay by its own phi gains delta g + w on the
/// filter's idea of it.
void SourceCovariance::step_process(MarkovSource& source, double dt_s) {
  const double phi = decay(dt_s, source.process.tau_s);
  const int at = source.enters_at;
  if (at == MarkovSource::kFixes) {
    source.S *= phi;
    return;
  }
  const double delta = phi - decay(dt_s, source.filter_tau_s);
  const double variance = source.process.sigma * source.process.sigma;
  const Eigen::Matrix3d Q = variance * (1.0 - phi * phi) * Eigen::Matrix3d::Identity();
  P.middleCols<3>(at) += delta * source.S;
  P.middleRows<3>(at) += delta * source.S.transpose();
  P.block<3, 3>(at, at) += delta * delta * source.G + Q;
  source.S *= phi;
  source.S.middleRows<3>(at) += delta * phi * source.G + Q;
  source.G = phi * phi * source.G + Q;
}

/// error' = error - K innovation, in second moments.
void SourceCovariance::update(const ScalarGain& gain) {
  const double per_sigma = gain.per_sigma;
  ErrorVector cross = P * gain.h;  // E[error innovation]
  double variance = gain.h.dot(cross) + fix_variance(gain.axis) * per_sigma * per_sigma;
  for (MarkovSource& source : processes_) {
    Eigen::RowVector3d innovation_g = gain.h.transpose() * source.S;  // E[innovation g^T]
    if (source.enters_at == MarkovSource::kFixes && gain.axis < 3) {
      variance += 2.0 * per_sigma * innovation_g(gain.axis) +
                  per_sigma * per_sigma * source.G(gain.axis, gain.axis);
      cross += per_sigma * source.S.col(gain.axis);
      innovation_g += per_sigma * source.G.row(gain.axis);
    }
    source.S -= gain.K * innovation_g;
  }
  const ErrorVector half = cross - 0.5 * variance * gain.K;
  P.noalias() -= gain.K * half.transpose() + half * gain.K.transpose();
}

void ParameterSources::propagate(const Leg& leg) { S_ = times(leg.Phi, S_) + leg.B; }

void ParameterSources::update(const ScalarGain& gain) {
  S_ -= gain.K * (gain.h.transpose() * S_).eval();
}

ErrorMatrix ParameterSources::covariance(
    const Eigen::Matrix<double, kSensorParameters, kSensorParameters>& second_moment) const {
  return S_ * second_moment * S_.transpose();
}

}  // namespace leeway::sim
