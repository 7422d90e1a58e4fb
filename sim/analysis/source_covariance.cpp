#include "sim/analysis/source_covariance.hpp"

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

/// What a fix without an error of its own leaves.
template <class Errors, class Gains>
void fuse(const FixRows& fix, const Gains& gains, Errors& X) {
  for_each_filter(X, [&](auto rows, int first) {
    rows -= gains.template middleRows<kErrorStates>(first) * (fix.H * rows).eval();
  });
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
/// filter's idea of it. Filters one after the other, and what they share in w last.
template <int kFilters>
void SourceCovariance<kFilters>::step_process(MarkovSource<kFilters>& source, double dt_s) {
  const double phi = bias_decay(dt_s, source.process.tau_s);
  if (source.enters_at == MarkovSource<kFilters>::kFixes) {
    source.S *= phi;
    return;
  }
  const double variance = source.process.sigma * source.process.sigma;
  const Eigen::Matrix3d Q = variance * (1.0 - phi * phi) * Eigen::Matrix3d::Identity();
  for (int filter = 0; filter < kFilters; ++filter) {
    const int at = filter * kErrorStates + source.enters_at;
    const double delta = phi - own_decay(filter, source.enters_at, dt_s);
    P.template middleCols<3>(at) += delta * source.S;
    P.template middleRows<3>(at) += delta * source.S.transpose();
    P.template block<3, 3>(at, at) += delta * delta * source.G;
    source.S.template middleRows<3>(at) += delta * source.G;
  }
  add_shared(source.enters_at, Q);
  source.S *= phi;
  for_each_filter(source.S,
                  [&](auto rows, int) { rows.template middleRows<3>(source.enters_at) += Q; });
  source.G = phi * phi * source.G + Q;
}

/// error' = error - K innovation, in second moments.
template <int kFilters>
void SourceCovariance<kFilters>::update(const FixRows& fix, const FixGains<kFilters>& gains) {
  fuse(fix, gains, P);
  P.transposeInPlace();
  fuse(fix, gains, P);
  const auto white = (fix_variance.array() * fix.per_sigma.array().square()).matrix();
  P += gains * white.asDiagonal() * gains.transpose();
  for (MarkovSource<kFilters>& source : processes_) {
    fuse(fix, gains, source.S);
    if (source.enters_at != MarkovSource<kFilters>::kFixes) continue;
    const typename MarkovSource<kFilters>::Cross taken =
        gains.template leftCols<3>() * fix.per_sigma.head<3>().asDiagonal();
    const auto crossed = (source.S - 0.5 * taken * source.G).eval();
    P -= crossed * taken.transpose() + taken * crossed.transpose();
    source.S -= taken * source.G;
  }
}

template <int kFilters>
void ParameterSources<kFilters>::propagate(const Leg& leg) {
  for_each_filter(S_, [&leg](auto rows, int) { rows = times(leg.Phi, rows) + leg.B; });
}

template <int kFilters>
void ParameterSources<kFilters>::update(const FixRows& fix, const FixGains<kFilters>& gains) {
  fuse(fix, gains, S_);
}

template class SourceCovariance<1>;
template class SourceCovariance<2>;
template class ParameterSources<1>;
template class ParameterSources<2>;

}  // namespace leeway::sim
