#include "leeway/sim/analysis/covariance_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "leeway/covariance/covariance.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/model/process_noise.hpp"
#include "sim/analysis/truth_model.hpp"

namespace leeway::sim {
namespace {

using Moment = CovariancePoint::Moment;
using Variances = Eigen::Array<double, 2 * kErrorStates, 1>;  // claimed, then true

constexpr double kSettledRelative = 1e-3;

/// A step must resolve the sensors' in-run drift.
double step_limit_s(const ImuErrorModel& imu) {
  double shortest_s = std::numeric_limits<double>::infinity();
  for (const TriadErrorModel* triad : {&imu.accelerometer, &imu.gyro}) {
    if (triad->in_run.sigma > 0.0) shortest_s = std::min(shortest_s, triad->in_run.tau_s);
  }
  return std::max(0.1 * shortest_s, 0.01);
}

ErrorMatrix initial_claim(const Scene& scene) {
  return initial_covariance({truth_at(scene.trajectory, 0.0).nav, {}}, initial_sigma(scene),
                            scene.filter.imu, scene.filter.biases);
}

ErrorMatrix without_biases(ErrorMatrix P) {
  P.bottomRightCorner<6, 6>().setZero();
  return P;
}

/// The covariance that a scene's filter claims and the true one, side by side.
class SceneCovariance {
 public:
  /// At the scene's start. @param by_source  keeps the sources apart, for error_budget()
  SceneCovariance(const Scene& scene, bool by_source)
      : imu_(scene.filter.imu),
        noise_(process_noise(scene.filter.imu, scene.filter.biases)),
        P_(initial_claim(scene)),
        truth_(std::in_place, scene, without_biases(P_), std::array{noise_}, by_source) {
    const bool fixes_as_white = scene.filter.gnss_correlation_s == 0.0;
    if (fixes_as_white && truth_->is_known_to(P_, fix_variance(scene.gnss.errors))) {
      truth_.reset();
    }
  }

  void propagate(const Leg& leg) {
    leeway::propagate(P_, leg.Phi, with_motion(noise_, imu_, leg.motion));
    if (truth_) truth_->propagate(leg);
  }

  /// Takes the fix into both with the filter's gains.
  void update(const FixRows& fix) {
    FixGains<1> gains;
    for (int row = 0; row < fix.H.rows(); ++row) {
      const ErrorVector h = fix.H.row(row).transpose();
      const ErrorVector cross = P_ * h;
      gains.col(row) = cross / (h.dot(cross) + 1.0);
      ErrorVector none = ErrorVector::Zero();
      scalar_update(P_, none, h, 0.0);
    }
    if (truth_) truth_->update(fix, gains);
  }

  const ErrorMatrix& claimed() const { return P_; }
  ErrorMatrix truth() const { return truth_ ? truth_->covariance() : P_; }

  /// @pre made by source.
  ErrorBudget error_budget(const Eigen::Matrix3d& C_en) const { return truth_->error_budget(C_en); }

 private:
  ImuErrorModel imu_;
  ProcessNoise noise_;
  ErrorMatrix P_;
  std::optional<TruthModel<1>> truth_;  // none: the filter knows all there is, P is the truth
};

/// The extremes of a stretch of the scene.
struct Window {
  long index{-1};  // counted back from the end
  int fixes{0};
  double claimed_sum_m2{0.0};
  double true_sum_m2{0.0};
  Variances largest{Variances::Zero()};
  CovarianceAnalysis result{};
};

class Analysis {
 public:
  Analysis(const Scene& scene, const ErrorTrack& track, const CovarianceConfig& config)
      : scene_(scene),
        track_(track),
        config_(config),
        pair_(scene, config.by_source),
        window_s_(scored_part_s(scene)) {}

  CovarianceAnalysis run() {
    for (const double t_s : fix_times_s(scene_.gnss, scene_.duration_s)) {
      const double arrival_s = t_s + scene_.gnss.latency_s;
      if (arrival_s > scene_.duration_s) break;
      now_s_ = advance(pair_, now_s_, t_s);
      enter_window(arrival_s);
      score(arrival_s);
      update();
    }
    if (config_.observer) advance(pair_, now_s_, scene_.duration_s);
    return finished();
  }

 private:
  double advance(SceneCovariance& pair, double from_s, double to_s) const {
    const bool is_watched = &pair == &pair_ && config_.observer;
    track_.follow(from_s, to_s, [&](const Leg& leg) {
      pair.propagate(leg);
      if (!is_watched || leg.end_s >= to_s) return;
      config_.observer(point(pair, leg.end_s, Moment::kBetween));
    });
    return to_s;
  }

  CovariancePoint point(const SceneCovariance& pair, double t_s, Moment moment) const {
    return {t_s, moment, truth_at(scene_.trajectory, t_s).nav.r_e_m, pair.claimed(), pair.truth()};
  }

  /// The error at the arrival of the fix of now, before it is used.
  void score(double arrival_s) {
    Variances variances;
    variances << pair_.claimed().diagonal(), pair_.truth().diagonal();
    window_.largest = window_.largest.max(variances);
    // Of the earlier windows nothing but their repetition counts.
    if (window_.index > 0 && !config_.observer) return;
    if (arrival_s == now_s_) {
      score(pair_, now_s_);
    } else {
      SceneCovariance ahead = pair_;
      score(ahead, advance(ahead, now_s_, arrival_s));
    }
  }

  void score(const SceneCovariance& pair, double t_s) {
    const CovariancePoint before = point(pair, t_s, Moment::kBeforeFix);
    if (config_.observer) config_.observer(before);
    if (window_.index > 0) return;
    const Eigen::Matrix2d claimed =
        horizontal_covariance(before.r_e_m, before.claimed.block<3, 3>(kDr, kDr));
    const Eigen::Matrix2d truth =
        horizontal_covariance(before.r_e_m, before.truth.block<3, 3>(kDr, kDr));
    ++window_.fixes;
    window_.claimed_sum_m2 += claimed.trace();
    window_.true_sum_m2 += truth.trace();
    CovarianceAnalysis& r = window_.result;
    r.claimed_m = std::max(r.claimed_m, horizontal_error_m(scene_.limit.metric, claimed));
    const double true_m = horizontal_error_m(scene_.limit.metric, truth);
    if (true_m <= r.true_m) return;
    r.true_m = true_m;
    r.worst_s = t_s;
    r.worst = before;
    if (!config_.by_source) return;
    r.error_budget = pair.error_budget(ned_to_ecef(geodetic_from_ecef(before.r_e_m)));
  }

  void enter_window(double t_s) {
    // A fix on the border of two counts for the later one.
    const double windows_left = (scene_.duration_s - t_s) / window_s_;
    const auto index = std::max(0L, static_cast<long>(std::ceil(windows_left - 1e-9)) - 1);
    if (index == window_.index) return;
    if (window_.index >= 0) {
      compare_with_previous();
      previous_ = window_.largest;
    }
    window_ = Window{};
    window_.index = index;
  }

  void compare_with_previous() {
    // Variances change twice as much as sigmas.
    const bool repeats =
        previous_ &&
        ((window_.largest - *previous_).abs() <= 2.0 * kSettledRelative * *previous_).all();
    if (!repeats) settled_s_.reset();
    if (repeats && !settled_s_) settled_s_ = now_s_;
  }

  CovarianceAnalysis finished() {
    if (window_.index != 0) {
      throw Error("scene '" + scene_.name + "': no fix in its last " + std::to_string(window_s_) +
                  " s: shorten the fix interval or move the outages");
    }
    compare_with_previous();
    CovarianceAnalysis r = window_.result;
    r.claimed_drms_m = std::sqrt(window_.claimed_sum_m2 / window_.fixes);
    r.true_drms_m = std::sqrt(window_.true_sum_m2 / window_.fixes);
    r.window_s = window_s_;
    r.fixes = fixes_;
    r.settled = settled_s_.has_value();
    r.settled_s = settled_s_.value_or(scene_.duration_s);
    return r;
  }

  void update() {
    const TruthPoint truth = truth_at(scene_.trajectory, now_s_);
    const double weight =
        gnss_position_weight(now_s_ - last_fix_s_, scene_.filter.gnss_correlation_s);
    last_fix_s_ = now_s_;
    pair_.update(fix_rows(truth.nav, truth.omega_ib_b_radps, scene_.filter.lever_arm_b_m,
                          scene_.gnss.errors, weight));
    ++fixes_;
    if (config_.observer) config_.observer(point(pair_, now_s_, Moment::kAfterFix));
  }

  const Scene& scene_;
  const ErrorTrack& track_;
  const CovarianceConfig& config_;
  SceneCovariance pair_;
  double window_s_;
  double now_s_{0.0};
  double last_fix_s_{-std::numeric_limits<double>::infinity()};  // the first fix has weight 1
  std::size_t fixes_{0};
  Window window_{};
  std::optional<Variances> previous_{};
  std::optional<double> settled_s_{};
};

}  // namespace

ErrorTrack error_track(const Scene& scene, double step_s) {
  const ProcessNoise noise = process_noise(scene.filter.imu, scene.filter.biases);
  return {scene.trajectory,
          scene.duration_s,
          {std::min(step_s, step_limit_s(scene.imu)), !parameter_moments(scene.imu).empty(),
           noise.tau_a_s, noise.tau_g_s}};
}

void free_inertial(const Scene& scene, const ErrorTrack& track,
                   const std::function<bool(const CovariancePoint&)>& observer) {
  validate(scene);
  Scene perfectly_started = scene;
  perfectly_started.initial = InitialSigma{};
  SceneCovariance pair(perfectly_started, false);
  CovariancePoint point;
  do {
    const Leg leg = track.leg(point.t_s, scene.duration_s);
    pair.propagate(leg);
    point.t_s = leg.end_s;
    point.r_e_m = truth_at(scene.trajectory, leg.end_s).nav.r_e_m;
    point.claimed = pair.claimed();
    point.truth = pair.truth();
  } while (observer(point) && point.t_s < scene.duration_s);
}

CovarianceAnalysis analyze(const Scene& scene, const ErrorTrack& track,
                           const CovarianceConfig& config) {
  validate(scene);
  return Analysis(scene, track, config).run();
}

}  // namespace leeway::sim
