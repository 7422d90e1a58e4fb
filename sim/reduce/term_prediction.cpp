#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "leeway/earth/earth.hpp"
#include "leeway/model/error_metric.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/model/process_noise.hpp"
#include "sim/analysis/truth_model.hpp"
#include "sim/reduce/linear_filter.hpp"
#include "sim/reduce/reduction_parts.hpp"
#include "sim/trials/recorded_trial.hpp"
#include "sim/trials/trial_score.hpp"

namespace leeway::sim {
namespace {

/// The full model's errors, then another's, in one covariance: what they differ by is a part of it.
/// Both integrate the motion alike, and differ in their gains and in what they make of the biases.
/// What makes a mean difference is not here.
using Pair = TruthModel<2>;

/// Shared by filters that let their biases decay each in its own way.
ErrorTrack undecayed_track(Scene scene) {
  scene.filter.biases = {BiasState::kRandomWalk, BiasState::kRandomWalk};
  return error_track(scene);
}

ProcessNoise noise_of(const FilterModel& model) {
  return process_noise(model.config.imu, model.config.biases);
}

/// Gains on the rows of a fix one after the other that do what these do on all at once.
FixGains<1> row_by_row(const FixRows& fix, FixGains<1> gains) {
  // All at once, row i has the gain (I - K_5 h_5) .. (I - K_(i+1) h_(i+1)) K_i.
  for (int i = 4; i >= 0; --i) {
    for (int j = 5; j > i; --j) {
      const auto h = fix.H.row(j);
      gains.col(i) += gains.col(j) * (h.dot(gains.col(i)) / (1.0 - h.dot(gains.col(j))));
    }
  }
  return gains;
}

ErrorMatrix block(const ErrorMoment<2>& Z, int row, int column) {
  return Z.block<kErrorStates, kErrorStates>(row * kErrorStates, column * kErrorStates);
}

/// Sums over scored fixes.
class PredictionSums {
 public:
  void add(const Pair& pair, const LinearFilterRun::Epoch& epoch, const NavState& at) {
    const auto position = [&at](const ErrorMatrix& P) {
      return ned_covariance(at.r_e_m, P.block<3, 3>(kDr, kDr));
    };
    const Eigen::Matrix3d C_tn =
        Eigen::AngleAxisd(-course_over_ground_rad(at), Eigen::Vector3d::UnitZ())
            .toRotationMatrix();
    const ErrorMatrix mean_sq = epoch.mean * epoch.mean.transpose();
    const ErrorMoment<2> Z = pair.covariance();
    const ErrorMatrix moment = block(Z, 1, 1) + mean_sq;
    const ErrorMatrix difference =
        block(Z, 0, 0) - block(Z, 0, 1) - block(Z, 1, 0) + block(Z, 1, 1) + mean_sq;
    ++epochs_;
    moment_n_m2_ += position(moment);
    moment_t_m2_ += C_tn * position(moment) * C_tn.transpose();
    claimed_m2_ += horizontal_m2(position(epoch.claimed));
    difference_m2_ += horizontal_m2(position(difference));
    nees_ += expected_nees(moment, epoch.claimed);
  }

  PredictedAccuracy result(ErrorMetric metric) const {
    const double per_epoch = 1.0 / epochs_;
    PredictedAccuracy r;
    const Eigen::Matrix3d& moment_m2 = asks_for_course(metric) ? moment_t_m2_ : moment_n_m2_;
    r.error_m = error_size_m(metric, per_epoch * moment_m2, 0.0);
    r.rms_m = std::sqrt(per_epoch * horizontal_m2(moment_n_m2_));
    r.rms_over_sigma = std::sqrt(horizontal_m2(moment_n_m2_) / claimed_m2_);
    r.nees = per_epoch * nees_;
    r.difference_m = std::sqrt(per_epoch * std::max(0.0, difference_m2_));
    return r;
  }

 private:
  static double horizontal_m2(const Eigen::Matrix3d& P_n_m2) {
    return P_n_m2.topLeftCorner<2, 2>().trace();
  }

  int epochs_{0};
  Eigen::Matrix3d moment_n_m2_{Eigen::Matrix3d::Zero()};  // north, east, down
  Eigen::Matrix3d moment_t_m2_{Eigen::Matrix3d::Zero()};  // along and across the track, down
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

  void advance(Pair& pair, std::size_t from, std::size_t to) const {
    const auto time_s = [this](std::size_t state) { return to_seconds(path.states[state].time); };
    errors.follow(time_s(from), time_s(to), [&pair](const Leg& leg) { pair.propagate(leg); });
  }

  /// Runs the full model beside another, and shows the pair at every scored fix before it is used.
  template <class Show>
  void run(const FilterModel& model, const LinearFilterRun& pass, const Show& show) const {
    const Scene& scene = path.plan.scene();
    ErrorMatrix P =
        initial_covariance({path.states.front(), {}}, path.plan.initial(), scene.filter.imu);
    P.bottomRightCorner<6, 6>().setZero();
    Pair pair(scene, P, {noise_of(full), noise_of(model)}, false);
    PositionWeight weight(scene.filter.gnss_correlation_s);
    std::size_t now = 0;  // of the states of the path
    auto epoch = pass.epochs.begin();
    auto gain = pass.gains.begin();
    auto full_gain = full_pass.gains.begin();
    for (const TrialPlan::Fix& fix : arriving_fixes(path.plan)) {
      advance(pair, now, fix.at + 1);
      now = fix.at + 1;
      if (fix.scored) {
        Pair without_fix = pair;
        advance(without_fix, now, fix.arrives + 1);
        show(without_fix, *epoch++, path.at_end_of(fix.arrives));
      }
      const Time t = path.states[now].time;
      const FixRows rows = path.fix_rows(fix.at, scene.gnss.errors.lever_arm_b_m, weight.of(t));
      FixGains<2> gains;
      gains << row_by_row(rows, *full_gain++), row_by_row(rows, *gain++);
      pair.update(rows, gains);
      weight.fused(t);
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
              [&sums](const Pair& pair, const LinearFilterRun::Epoch& epoch,
                      const NavState& at) { sums.add(pair, epoch, at); });
  return sums.result(track_->path.plan.scene().limit.metric);
}

double TermPrediction::contribution_m(const std::vector<ErrorSource>& sources) const {
  double sum_m2 = 0.0;
  int epochs = 0;
  track_->run(track_->full, track_->full_pass,
              [&](const Pair& pair, const LinearFilterRun::Epoch&, const NavState& at) {
                ++epochs;
                for (const auto& [source, mean_sq_n_m2] :
                     pair.error_budget(ned_to_ecef(geodetic_from_ecef(at.r_e_m)))) {
                  if (std::find(sources.begin(), sources.end(), source) == sources.end()) continue;
                  sum_m2 += mean_sq_n_m2.topLeftCorner<2, 2>().trace();
                }
              });
  return std::sqrt(sum_m2 / epochs);
}

}  // namespace leeway::sim
