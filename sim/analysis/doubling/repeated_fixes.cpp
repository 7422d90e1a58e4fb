#include "sim/analysis/doubling/repeated_fixes.hpp"

#include <cmath>

#include "sim/analysis/doubling/riccati_map.hpp"

namespace leeway::sim {
namespace {

using Eigen::MatrixXd;

constexpr double kDenseFixes = 16.0;  // a period
constexpr double kOnPattern = 1e-6;   // of the interval
constexpr int kMostPeriods = 16;

/// The states that are carried: 15 errors, those with a memory of their own, the parameters.
struct States {
  explicit States(SceneCovariance<0>& pair) : truth(pair.truth_model().has_value()) {
    if (!truth) return;
    TruthModel<1>& model = *pair.truth_model();
    processes = &model.whole().processes();
    if (model.parameters() != nullptr) parameters = kSensorParameters;
  }

  Eigen::Index slow() const {
    return processes == nullptr ? 0 : 3 * static_cast<Eigen::Index>(processes->size());
  }
  Eigen::Index first_parameter() const { return kErrorStates + slow(); }
  Eigen::Index all() const { return first_parameter() + parameters; }

  template <class F>
  void for_each_process(F&& f) const {
    for (Eigen::Index i = 0; i < slow() / 3; ++i) {
      f((*processes)[static_cast<std::size_t>(i)], kErrorStates + 3 * i);
    }
  }

  bool truth;
  std::vector<MarkovSource<1>>* processes{nullptr};
  Eigen::Index parameters{0};
};

/// One run over the pattern as a map.
class PatternMap {
 public:
  PatternMap(SceneCovariance<0>& pair, const Scene& scene, Stretches& stretches,
             const FixSpan& span, const FixPattern& pattern)
      : pair_(pair),
        scene_(scene),
        states_(pair),
        span_(span),
        pattern_(pattern),
        map_(states_.all(), states_.truth) {
    for (int k = 0; k < pattern.fixes; ++k) {
      const double from_s = span.from_s + k * pattern.interval_s;
      const double to_s = span.from_s + (k + 1) * pattern.interval_s;
      propagate(stretches.between(from_s, to_s));
      measure(to_s);
    }
  }

  void act(std::int64_t times) {
    const RiccatiMap all = repeated(map_, times);
    const MomentPair start = moments();
    const MomentPair end = all.of(start);
    pair_.claim().set_errors(end.claimed.topLeftCorner<kErrorStates, kErrorStates>());
    if (!states_.truth) return;
    TruthModel<1>& truth = *pair_.truth_model();
    truth.whole().P = end.truth.topLeftCorner<kErrorStates, kErrorStates>();
    states_.for_each_process([&](MarkovSource<1>& process, Eigen::Index at) {
      process.S = end.truth.block<kErrorStates, 3>(0, at);
      process.G = end.truth.block<3, 3>(at, at);
    });
    if (states_.parameters == 0) return;
    const MatrixXd way = all.closed_loop(start.claimed).topRows<kErrorStates>();
    truth.parameters()->set_sensitivity(way.leftCols<kErrorStates>() *
                                            truth.parameters()->sensitivity() +
                                        way.rightCols<kSensorParameters>());
  }

 private:
  MatrixXd none() const { return MatrixXd::Zero(states_.all(), states_.all()); }

  void propagate(const Stretch& stretch) {
    MatrixXd Phi = MatrixXd::Identity(states_.all(), states_.all());
    MatrixXd claimed = none();
    MatrixXd truth = none();
    Phi.topLeftCorner<kErrorStates, kErrorStates>() = dense(stretch.Phi);
    claimed.topLeftCorner<kErrorStates, kErrorStates>() = stretch.claimed_noise;
    truth.topLeftCorner<kErrorStates, kErrorStates>() = stretch.true_noise;
    states_.for_each_process([&](const MarkovSource<1>& process, Eigen::Index at) {
      const double phi = bias_decay(stretch.Phi.dt_s, process.process.tau_s);
      Phi.block<3, 3>(at, at) *= phi;
      truth.block<3, 3>(at, at) = (1.0 - phi * phi) * process.G;
    });
    if (states_.parameters > 0) {
      Phi.block(0, states_.first_parameter(), kErrorStates, kSensorParameters) = stretch.B;
    }
    map_.propagate(Phi, claimed, truth);
  }

  void measure(double t_s) {
    const TruthPoint at = truth_at(scene_.trajectory, t_s);
    const FixRows fix = fix_rows(at.nav, at.omega_ib_b_radps, scene_.filter.lever_arm_b_m,
                                 scene_.gnss.errors, span_.weight);
    for (int row = 0; row < fix.H.rows(); ++row) {
      Eigen::VectorXd h = Eigen::VectorXd::Zero(states_.all());
      h.head<kErrorStates>() = fix.H.row(row).transpose();
      double true_variance = 0.0;
      if (states_.truth) {
        const double per_sigma = fix.per_sigma(row);
        true_variance = pair_.truth_model()->whole().row_variance(row) * per_sigma * per_sigma;
        states_.for_each_process([&](const MarkovSource<1>&, Eigen::Index first) {
          if (row < 3) h(first + row) = per_sigma;
        });
      }
      map_.measure(pattern_.row_weight * h, true_variance);
    }
  }

  MomentPair moments() const {
    MomentPair start{none(), none()};
    start.claimed.topLeftCorner<kErrorStates, kErrorStates>() = pair_.claimed();
    if (!states_.truth) return start;
    start.truth.topLeftCorner<kErrorStates, kErrorStates>() = pair_.truth_model()->whole().P;
    states_.for_each_process([&](const MarkovSource<1>& process, Eigen::Index at) {
      start.truth.block<kErrorStates, 3>(0, at) = process.S;
      start.truth.block<3, kErrorStates>(at, 0) = process.S.transpose();
      start.truth.block<3, 3>(at, at) = process.G;
    });
    return start;
  }

  SceneCovariance<0>& pair_;
  const Scene& scene_;
  States states_;
  FixSpan span_;
  FixPattern pattern_;
  RiccatiMap map_;
};

std::int64_t times_in(const FixSpan& span, double length_s) {
  return static_cast<std::int64_t>(std::floor((span.until_s - span.from_s) / length_s));
}

}  // namespace

std::optional<FixPattern> fix_pattern(const Scene& scene, const ErrorTrack& track,
                                      const FixSpan& span) {
  const double T_s = span.interval_s;
  const auto worth = [&](const FixPattern& p) { return times_in(span, p.length_s) >= 4; };
  std::optional<FixPattern> pattern;
  if (track.is_stationary()) {
    pattern = {1, T_s, T_s};
  } else if (const std::optional<double> period_s = scene.trajectory.period_s) {
    for (int periods = 1; periods <= kMostPeriods && !pattern; ++periods) {
      const double length_s = periods * *period_s;
      const double fixes = std::round(length_s / T_s);
      if (std::abs(length_s - fixes * T_s) > kOnPattern * T_s) continue;
      pattern = {static_cast<int>(fixes), length_s / fixes, length_s};
    }
    const double fixes = std::round(*period_s / T_s);
    if (fixes >= kDenseFixes && !(pattern && worth(*pattern))) {
      const double moved_s = *period_s / fixes;
      pattern = {static_cast<int>(fixes), moved_s, *period_s, std::sqrt(moved_s / T_s)};
    }
  }
  if (pattern && !worth(*pattern)) pattern.reset();
  return pattern;
}

double repeat_fixes(SceneCovariance<0>& pair, const Scene& scene, Stretches& stretches,
                    const FixSpan& span, const FixPattern& pattern) {
  const std::int64_t times = times_in(span, pattern.length_s);
  PatternMap(pair, scene, stretches, span, pattern).act(times);
  return span.from_s + static_cast<double>(times) * pattern.length_s;
}

}  // namespace leeway::sim
