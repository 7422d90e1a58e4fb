#include "sim/analysis/source_covariance.hpp"

#include "leeway/covariance/covariance.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway::sim {
namespace {

/// Calls f(rows, first) with the rows of every filter's errors.
template <class Errors, class F>
void for_each_filter(Errors& X, F&& f) {
  for (int first = 0; first < X.rows(); first += kErrorStates) {
    f(X.template middleRows<kErrorStates>(first), first);
  }
}

template <class Errors>
void carry(const Transition& Phi, Errors& X) {
  for_each_filter(X, [&Phi](auto rows, int) { rows = times(Phi, rows); });
}

/// What a row measures of every filter's errors.
template <class Errors>
auto measured(const ErrorVector& h, const Errors& X) {
  Eigen::Matrix<double, Errors::RowsAtCompileTime / kErrorStates, Errors::ColsAtCompileTime> all;
  for_each_filter(
      X, [&](auto rows, int first) { all.row(first / kErrorStates) = h.transpose() * rows; });
  return all;
}

}  // namespace

Eigen::Matrix3d MarkovStart::error_moment() const {
  const Eigen::Vector3d error = mean - known;
  return Eigen::Matrix3d(variance.asDiagonal()) + error * error.transpose();
}

template <int kFilters>
void SourceCovariance<kFilters>::add_process(MarkovSource<kFilters> source,
                                             const MarkovStart& start) {
  const Eigen::Matrix3d variance = start.variance.asDiagonal();
  source.G = variance + start.mean * start.mean.transpose();
  if (source.enters_at != MarkovSource<kFilters>::kFixes) {
    add_shared(source.enters_at, start.error_moment());
    for_each_filter(source.S, [&](auto rows, int) {
      rows.template middleRows<3>(source.enters_at) =
          variance + (start.mean - start.known) * start.mean.transpose();
    });
  }
  processes_.push_back(source);
}

template <int kFilters>
void SourceCovariance<kFilters>::propagate(const Leg& leg) {
  // Half before and half after, as propagate() does with noise: second order in the step.
  step_processes(0.5 * leg.Phi.dt_s);
  step_errors(leg);
  for (MarkovSource<kFilters>& source : processes_) carry(leg.Phi, source.S);
  step_processes(0.5 * leg.Phi.dt_s);
}

template <int kFilters>
void SourceCovariance<kFilters>::step_errors(const Leg& leg) {
  if constexpr (kFilters == 1) {
    leeway::propagate(P, leg.Phi, noise);
  } else {
    const ErrorMatrix half = noise_variance(noise, 0.5 * leg.Phi.dt_s).asDiagonal();
    add_shared(0, half);
    carry(leg.Phi, P);
    P.transposeInPlace();
    carry(leg.Phi, P);
    add_shared(0, half);
    P = (0.5 * (P + P.transpose())).eval();  // as for one: update() does not damp the asymmetry
  }
}

template <int kFilters>
void SourceCovariance<kFilters>::step_processes(double dt_s) {
  if constexpr (kFilters > 1) let_biases_decay(dt_s);
  for (MarkovSource<kFilters>& source : processes_) step_process(source, dt_s);
}

/// What a filter leaves of its bias state.
template <int kFilters>
double SourceCovariance<kFilters>::own_decay(int filter, int bias, double dt_s) const {
  const ProcessNoise& own = filters_[static_cast<std::size_t>(filter)];
  return bias_decay(dt_s, bias == kBa ? own.tau_a_s : own.tau_g_s);
}

template <int kFilters>
void SourceCovariance<kFilters>::let_biases_decay(double dt_s) {
  for (int filter = 0; filter < kFilters; ++filter) {
    for (const int bias : {kBa, kBg}) {
      const double own = own_decay(filter, bias, dt_s);
      const int row = filter * kErrorStates + bias;
      P.template middleRows<3>(row) *= own;
      P.template middleCols<3>(row) *= own;
      for (MarkovSource<kFilters>& source : processes_) {
        source.S.template middleRows<3>(row) *= own;
      }
    }
  }
}

/// g' = phi g + w; a bias state that a filter lets decay by its own phi gains delta g + w on the
/// filter's idea of it.
template <int kFilters>
void SourceCovariance<kFilters>::step_process(MarkovSource<kFilters>& source, double dt_s) {
  const double phi = bias_decay(dt_s, source.process.tau_s);
  if (source.enters_at == MarkovSource<kFilters>::kFixes) {
    source.S *= phi;
    return;
  }
  const double variance = source.process.sigma * source.process.sigma;
  const Eigen::Matrix3d Q = variance * (1.0 - phi * phi) * Eigen::Matrix3d::Identity();
  const auto at = [&](int filter) { return filter * kErrorStates + source.enters_at; };
  Eigen::Matrix<double, kFilters, 1> delta;
  for (int i = 0; i < kFilters; ++i) {
    delta(i) = phi - own_decay(i, source.enters_at, dt_s);
    P.template middleCols<3>(at(i)) += delta(i) * source.S;
    P.template middleRows<3>(at(i)) += delta(i) * source.S.transpose();
  }
  source.S *= phi;
  for (int i = 0; i < kFilters; ++i) {
    for (int j = 0; j < kFilters; ++j) {
      P.template block<3, 3>(at(i), at(j)) += delta(i) * delta(j) * source.G + Q;
    }
    source.S.template middleRows<3>(at(i)) += delta(i) * phi * source.G + Q;
  }
  source.G = phi * phi * source.G + Q;
}

/// error' = error - K innovation, in second moments.
template <int kFilters>
void SourceCovariance<kFilters>::update(const RowGain<kFilters>& gain) {
  const double per_sigma = gain.per_sigma;
  ErrorGains<kFilters> cross;  // E[error innovation^T]
  for (int i = 0; i < kFilters; ++i) {
    cross.col(i) = P.template middleCols<kErrorStates>(i * kErrorStates) * gain.h;
  }
  Eigen::Matrix<double, kFilters, kFilters> variance = measured(gain.h, cross);
  variance.array() += fix_variance(gain.row) * per_sigma * per_sigma;
  for (MarkovSource<kFilters>& source : processes_) {
    auto innovation_g = measured(gain.h, source.S);  // E[innovation g^T]
    if (source.enters_at == MarkovSource<kFilters>::kFixes && gain.row < 3) {
      // Of the variance only the symmetric part counts.
      variance.array().colwise() += 2.0 * per_sigma * innovation_g.col(gain.row).array() +
                                    per_sigma * per_sigma * source.G(gain.row, gain.row);
      cross.colwise() += per_sigma * source.S.col(gain.row);
      innovation_g.rowwise() += per_sigma * source.G.row(gain.row);
    }
    source.S -= gain.K * innovation_g;
  }
  const ErrorGains<kFilters> half = cross - gain.K * (0.5 * variance);
  P.noalias() -= gain.K * half.transpose() + half * gain.K.transpose();
}

template <int kFilters>
void ParameterSources<kFilters>::propagate(const Leg& leg) {
  for_each_filter(S_, [&leg](auto rows, int) { rows = times(leg.Phi, rows) + leg.B; });
}

template <int kFilters>
void ParameterSources<kFilters>::update(const RowGain<kFilters>& gain) {
  S_ -= gain.K * measured(gain.h, S_);
}

template class SourceCovariance<1>;
template class SourceCovariance<2>;
template class ParameterSources<1>;
template class ParameterSources<2>;

}  // namespace leeway::sim
