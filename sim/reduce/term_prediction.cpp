#include <algorithm>
#include <cmath>
#include <limits>

#include "leeway/earth/earth.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/model/process_noise.hpp"
#include "sim/analysis/truth_model.hpp"
#include "sim/reduce/linear_filter.hpp"
#include "sim/reduce/reduction_parts.hpp"
#include "sim/trials/trial_score.hpp"

namespace leeway::sim {
namespace {

/// A track whose biases do not decay: PairedCovariance has them decay itself.
ErrorTrack undecayed_track(Scene scene) {
  scene.filter.biases = {BiasState::kRandomWalk, BiasState::kRandomWalk};
  return error_track(scene);
}

PairedCovariance::BiasTimes bias_times(const FilterModel& model) {
  const ProcessNoise noise = process_noise(model.config.imu, model.config.biases);
  return {noise.tau_a_s, noise.tau_g_s};
}

/// Sums over scored fixes.
class PredictionSums {
 public:
  void add(const PairedCovariance& pair, const LinearFilterRun::Epoch& epoch,
           const Eigen::Matrix3d& C_en) {
    const auto horizontal = [&C_en](const ErrorMatrix& P) -> Eigen::Matrix2d {
      return C_en.leftCols<2>().transpose() * P.block<3, 3>(kDr, kDr) * C_en.leftCols<2>();
    };
    const ErrorMatrix mean_sq = epoch.mean * epoch.mean.transpose();
    const ErrorMatrix moment = pair.of(1) + mean_sq;
    ++epochs_;
    moment_m2_ += horizontal(moment);
    claimed_m2_ += horizontal(epoch.claimed).trace();
    difference_m2_ += horizontal(pair.difference() + mean_sq).trace();
    nees_ += expected_nees(moment, epoch.claimed);
  }

  PredictedAccuracy result(HorizontalMetric metric) const {
    const double per_epoch = 1.0 / epochs_;
    PredictedAccuracy r;
    r.error_m = horizontal_error_m(metric, per_epoch * moment_m2_);
    r.rms_m = std::sqrt(per_epoch * moment_m2_.trace());
    r.rms_over_sigma = std::sqrt(moment_m2_.trace() / claimed_m2_);
    r.nees = per_epoch * nees_;
    r.difference_m = std::sqrt(per_epoch * std::max(0.0, difference_m2_));
    return r;
  }

 private:
  int epochs_{0};
  Eigen::Matrix2d moment_m2_{Eigen::Matrix2d::Zero()};
  double claimed_m2_{0.0};
  double difference_m2_{0.0};
  double nees_{0.0};
};

PredictedAccuracy no_numbers() {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  return {kNan, kNan, kNan, kNan, kNan, false};
}

}  // namespace

struct TermPrediction::Track {
  Track(const TrialPlan& plan, const FilterModel& full_model)
      : path(plan, full_model.config.strapdown),
        errors(undecayed_track(plan.scene())),
        full(full_model),
        full_pass(run_linear_filter(path, full_model)) {}

  double time_s(std::size_t increment) const { return to_seconds(path.states[increment + 1].time); }

  void advance(PairedCovariance& pair, double from_s, double to_s) const {
    while (from_s < to_s) {
      const Leg leg = errors.leg(from_s, to_s);
      pair.propagate(leg);
      from_s = leg.end_s;
    }
  }

  /// Runs the full model beside another, and shows the pair at every scored fix before it is used.
  template <class Show>
  void run(const FilterModel& model, const LinearFilterRun& pass, const Show& show) const {
    const Scene& scene = path.plan.scene();
    Estimate start;
    start.nav = path.states.front();
    ErrorMatrix P = initial_covariance(start, path.plan.initial(), scene.filter.imu);
    P.bottomRightCorner<6, 6>().setZero();
    PairedCovariance pair(scene, P, {bias_times(full), bias_times(model)});
    const auto fixes = arriving_fixes(path.plan);
    const auto weights = fix_weights(path.plan, scene.filter.gnss_correlation_s);
    double now_s = 0.0;
    auto epoch = pass.epochs.begin();
    for (std::size_t i = 0; i < fixes.size(); ++i) {
      const double fix_s = time_s(fixes[i].at);
      advance(pair, now_s, fix_s);
      now_s = fix_s;
      if (fixes[i].scored) {
        PairedCovariance without_fix = pair;
        advance(without_fix, fix_s, time_s(fixes[i].arrives));
        const Geodetic place = geodetic_from_ecef(path.states[fixes[i].arrives + 1].r_e_m);
        show(without_fix, *epoch++, ned_to_ecef(place));
      }
      pair.update(fix_rows(path, fixes[i].at, scene.gnss.errors.lever_arm_b_m, weights[i]),
                  {full_pass.gains[i], pass.gains[i]});
    }
  }

  TruePath path;
  ErrorTrack errors;
  FilterModel full;
  LinearFilterRun full_pass;
};

TermPrediction::TermPrediction(const TrialPlan& plan, const FilterModel& full)
    : track_(std::make_unique<const Track>(plan, full)) {}

TermPrediction::~TermPrediction() = default;

PredictedAccuracy TermPrediction::of(const FilterModel& model) const {
  const LinearFilterRun pass = run_linear_filter(track_->path, model);
  if (!pass.is_positive) return no_numbers();
  PredictionSums sums;
  track_->run(model, pass,
              [&sums](const PairedCovariance& pair, const LinearFilterRun::Epoch& epoch,
                      const Eigen::Matrix3d& C_en) { sums.add(pair, epoch, C_en); });
  return sums.result(track_->path.plan.scene().limit.metric);
}

double TermPrediction::contribution_m(const std::vector<ErrorSource>& sources) const {
  PairedCovariance::ParameterMoment wanted = PairedCovariance::ParameterMoment::Zero();
  for (const auto& [source, moment] :
       TruthModel::parameter_moments(track_->path.plan.scene().imu)) {
    if (std::find(sources.begin(), sources.end(), source) != sources.end()) wanted += moment;
  }
  double sum_m2 = 0.0;
  int epochs = 0;
  track_->run(
      track_->full, track_->full_pass,
      [&](const PairedCovariance& pair, const LinearFilterRun::Epoch&,
          const Eigen::Matrix3d& C_en) {
        const ErrorMatrix P = pair.of_parameters(0, wanted);
        ++epochs;
        sum_m2 +=
            (C_en.leftCols<2>().transpose() * P.block<3, 3>(kDr, kDr) * C_en.leftCols<2>()).trace();
      });
  return std::sqrt(sum_m2 / epochs);
}

}  // namespace leeway::sim
