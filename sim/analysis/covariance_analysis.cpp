#include "leeway/sim/analysis/covariance_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "leeway/covariance/covariance.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/ekf/held_update.hpp"
#include "leeway/model/error_metric.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/model/heading.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "sim/analysis/doubling/end_analysis.hpp"
#include "sim/analysis/doubling/repeated_fixes.hpp"
#include "sim/analysis/scene_covariance.hpp"
#include "sim/analysis/scored_fixes.hpp"

namespace leeway::sim {
namespace {

using Moment = CovariancePoint::Moment;
using Variances = Eigen::Array<double, 2 * kErrorStates, 1>;  // claimed, then true

constexpr double kSettledRelative = 1e-3;
constexpr double kSamePhase = 1e-6;
constexpr double kMostOfAFix = 0.1;

/// A navigator takes positions as good as carrier phase gives them for white.
double believed_correlation_s(const Scene& scene) {
  const bool is_white = scene.estimator == SceneEstimator::kNavigator &&
                        has_white_error(fix_variance(scene.gnss.errors).head<3>().sum());
  return is_white ? 0.0 : scene.filter.gnss_correlation_s;
}

/// The extremes of a stretch of the scene, to be compared with those of the next.
struct Window {
  long index{-1};  // counted back from the end
  Variances largest{Variances::Zero()};
};

template <int kParameters>
class Analysis {
 public:
  /// @param stretches  of the track, when only the scene's end matters
  Analysis(const Scene& scene, const ErrorTrack& track, const CovarianceConfig& config,
           Stretches* stretches = nullptr)
      : scene_(scene),
        track_(track),
        stretches_(stretches),
        config_(config),
        correlation_s_(believed_correlation_s(scene)),
        pair_(scene, config.by_source, track.aiding()),
        window_s_(repeating_part_s(scene)),
        scored_s_(scored_part_s(scene)),
        scored_(scene, track) {
    if (!pair_.takes_stretches()) stretches_ = nullptr;
  }

  /// Takes the fixes of a step as one, where all that follow the filter's settling are looked at.
  void take_steps_of_fixes() {
    if (scene_.gnss.settle_s == 0.0 || !scene_.gnss.outages.empty()) return;
    const double fixes = track_.step_s() / scene_.gnss.interval_s;
    fixes_in_one_ = std::max(static_cast<int>(fixes + kSamePhase), 1);
  }

  void walk() {
    int waiting = 0;
    for (const double t_s : fix_times_s(scene_.gnss, scene_.duration_s)) {
      if (++waiting < fixes_by(t_s)) continue;
      waiting = 0;
      if (t_s < repeated_until_s_) {
        ++fixes_;
        continue;
      }
      const double arrival_s = t_s + scene_.gnss.latency_s;
      if (arrival_s > scene_.duration_s) break;
      now_s_ = advance(pair_, now_s_, t_s);
      enter_window(arrival_s);
      take_fix(arrival_s);
      if (is_coarse_) return;
      if constexpr (kParameters == 0) repeat();
    }
    if (config_.observer) advance(pair_, now_s_, scene_.duration_s);
  }

  /// @returns none where fixes may not be taken together
  std::optional<CovarianceAnalysis> run() {
    walk();
    if (is_coarse_) return {};
    return finished();
  }

 private:
  double advance(SceneCovariance<kParameters>& pair, double from_s, double to_s) const {
    if constexpr (kParameters == 0) {
      if (stretches_ != nullptr) {
        stretches_->follow(from_s, to_s, [&](const auto& part) { pair.propagate(part); });
        return to_s;
      }
    }
    const bool is_watched = &pair == &pair_ && config_.observer;
    track_.follow(from_s, to_s, [&](const Leg& leg) {
      pair.propagate(leg);
      if (!is_watched || leg.end_s >= to_s) return;
      config_.observer(point(pair, leg.end_s, Moment::kBetween));
    });
    return to_s;
  }

  CovariancePoint point(const SceneCovariance<kParameters>& pair, double t_s, Moment moment) const {
    return {t_s, moment, track_.truth(scene_.trajectory, t_s).nav.r_e_m, pair.claimed(),
            pair.truth()};
  }

  /// The fix of now, or as many as one that stands for them ends with.
  void take_fix(double arrival_s) {
    const int fixes = fixes_by(now_s_);
    Variances variances;
    variances << pair_.claimed().diagonal(), pair_.truth().diagonal();
    window_.largest = window_.largest.max(variances);
    const bool is_scored = counts(arrival_s);
    if (fixes > 1 && is_scored) return take_fixes(fixes, arrival_s);
    if (is_scored || config_.observer) {
      at_arrival(arrival_s, [this](const SceneCovariance<kParameters>& pair, double t_s) {
        score(pair, point(pair, t_s, Moment::kBeforeFix), last_fix_s_);
      });
    }
    update(fixes);
  }

  /// Calls f with the covariance at the arrival of the fix of now, before it is used.
  template <class F>
  void at_arrival(double arrival_s, F&& f) {
    if (arrival_s == now_s_) return f(pair_, now_s_);
    SceneCovariance<kParameters> ahead = pair_;
    const double t_s = advance(ahead, now_s_, arrival_s);
    f(ahead, t_s);
  }

  /// The error before fixes that are taken as one: what they make smaller together they do bit by
  /// bit, so that in the mean about half of it is left.
  void take_fixes(int fixes, double arrival_s) {
    CovariancePoint before;
    at_arrival(arrival_s, [&](const SceneCovariance<kParameters>& pair, double t_s) {
      before = point(pair, t_s, Moment::kBeforeFix);
    });
    const ErrorMatrix claimed = pair_.claimed();
    const ErrorMatrix truth = pair_.truth();
    const double fix_before_s = now_s_ - scene_.gnss.interval_s;
    update(fixes);
    const double gone = 0.5 * (fixes - 1) / fixes;
    const ErrorMatrix less_claimed = claimed - pair_.claimed();
    const ErrorMatrix less_truth = truth - pair_.truth();
    before.claimed -= gone * less_claimed;
    before.truth -= gone * less_truth;
    score(pair_, before, fix_before_s);
    const auto changes = [](const ErrorMatrix& less, const ErrorMatrix& P) {
      return less.diagonal().segment<3>(kDr).cwiseAbs().sum() >
             kMostOfAFix * P.diagonal().segment<3>(kDr).sum();
    };
    is_coarse_ = is_coarse_ || changes(less_claimed, claimed) || changes(less_truth, truth);
  }

  void score(const SceneCovariance<kParameters>& pair, const CovariancePoint& before,
             double last_fix_s) {
    if (config_.observer) config_.observer(before);
    if (!counts(before.t_s)) return;
    const bool is_worst = scored_.add(before, std::max(last_fix_s, 0.0));
    if (!is_worst || !config_.by_source) return;
    error_budget_ = pair.error_budget(ned_to_ecef(geodetic_from_ecef(before.r_e_m)));
  }

  /// Which stretch of the scene a fix belongs to, counted back from the end. One on the border of
  /// two counts for the later one.
  long stretch_of(double arrival_s, double length_s) const {
    const double left = (scene_.duration_s - arrival_s) / length_s;
    return std::max(0L, static_cast<long>(std::ceil(left - 1e-9)) - 1);
  }

  bool counts(double arrival_s) const { return stretch_of(arrival_s, scored_s_) == 0; }

  void enter_window(double arrival_s) {
    const long index = stretch_of(arrival_s, window_s_);
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
    if (scored_.empty()) {
      throw Error("scene '" + scene_.name + "': no fix in its last " + std::to_string(scored_s_) +
                  " s: shorten the fix interval or move the outages");
    }
    compare_with_previous();
    CovarianceAnalysis r = scored_.result();
    r.error_budget = error_budget_;
    r.window_s = scored_s_;
    r.fixes = fixes_;
    r.settled = settled_s_.has_value();
    r.settled_s = settled_s_.value_or(scene_.duration_s);
    return r;
  }

  /// @param fixes  that are taken as one
  void update(int fixes) {
    const TruthPoint truth = track_.truth(scene_.trajectory, now_s_);
    const double since_s = (now_s_ - last_fix_s_) / fixes;
    const double weight = gnss_position_weight(since_s, correlation_s_);
    last_fix_s_ = now_s_;
    FixRows rows = fix_rows(truth.nav, truth.omega_ib_b_radps, scene_.filter.lever_arm_b_m,
                            scene_.gnss.errors, weight);
    if (fixes > 1) rows.repeat(fixes);
    pair_.update(rows, held_at(since_s), now_s_);
    fixes_ += static_cast<std::size_t>(fixes);
    if (config_.observer) config_.observer(point(pair_, now_s_, Moment::kAfterFix));
  }

  /// Goes from the fix of now over those that need not be followed one by one, if there are any.
  void repeat() {
    const double interval_s = scene_.gnss.interval_s;
    const bool begins = now_s_ > scene_.gnss.settle_s && !has_tried_to_repeat_;
    if (stretches_ == nullptr || !begins) return;
    has_tried_to_repeat_ = true;
    const bool never_holds = scene_.estimator == SceneEstimator::kEkf;
    if (!never_holds || !scene_.gnss.outages.empty()) return;
    // What was moved or has not settled yet has two parts more to be forgotten in.
    const double followed_s = std::max(scored_s_, 2.0 * window_s_);
    const FixSpan span{now_s_, scene_.duration_s - scene_.gnss.latency_s - followed_s, interval_s,
                       gnss_position_weight(interval_s, correlation_s_)};
    const auto pattern = fix_pattern(scene_, track_, span);
    if (!pattern) return;
    now_s_ = repeat_fixes(pair_, scene_, *stretches_, span, *pattern);
    const double fixes = std::floor((now_s_ - span.from_s) / interval_s + kSamePhase);
    last_fix_s_ = span.from_s + fixes * interval_s;
    repeated_until_s_ = last_fix_s_ + 0.5 * interval_s;
    window_ = Window{};
    previous_.reset();
  }

  /// How many fixes are taken as one. The first of them are not: the filter has yet to come to
  /// them.
  int fixes_by(double t_s) const {
    const double apart_s = (fixes_in_one_ + 0.5) * scene_.gnss.interval_s;
    return t_s > scene_.gnss.settle_s + apart_s ? fixes_in_one_ : 1;
  }

  /// What the navigator does not let a fix tell: the heading at rest, or after a while of even
  /// motion.
  Held held_at(double since_s) const {
    const SceneAiding* aiding = track_.aiding().get();
    if (scene_.estimator != SceneEstimator::kNavigator || !aiding) return Held::kNothing;
    const VehicleConfig vehicle = scene_.vehicle ? scene_.vehicle->config : VehicleConfig{};
    const bool hides =
        motion_hides_heading(vehicle, aiding->rests(now_s_), aiding->even_s(now_s_), since_s);
    return hides && pair_.heading_is_hidden(now_s_) ? Held::kHeadingAndTurn : Held::kNothing;
  }

  const Scene& scene_;
  const ErrorTrack& track_;
  Stretches* stretches_;
  const CovarianceConfig& config_;
  double correlation_s_;
  SceneCovariance<kParameters> pair_;
  double window_s_;
  double scored_s_;
  double now_s_{0.0};
  double last_fix_s_{-std::numeric_limits<double>::infinity()};  // the first fix has weight 1
  double repeated_until_s_{0.0};
  bool has_tried_to_repeat_{false};
  int fixes_in_one_{1};
  bool is_coarse_{false};
  std::size_t fixes_{0};
  Window window_{};
  ScoredFixes scored_;
  ErrorBudget error_budget_{};
  std::optional<Variances> previous_{};
  std::optional<double> settled_s_{};
};

/// Calls f with the analysis that fits what the scene's filter estimates.
/// @param stretches  null: every leg is taken
template <class F>
auto with_analysis(const Scene& scene, const ErrorTrack& track, const CovarianceConfig& config,
                   Stretches* stretches, F&& f) {
  validate(scene);
  const bool has_parameters = scene.vehicle && scene.vehicle->config.uses_parameters();
  if (has_parameters) return f(Analysis<kVehicleStates>(scene, track, config, stretches));
  return f(Analysis<0>(scene, track, config, stretches));
}

}  // namespace

void free_inertial(const Scene& scene, const ErrorTrack& track,
                   const std::function<bool(const CovariancePoint&)>& observer) {
  validate(scene);
  Scene perfectly_started = scene;
  perfectly_started.initial = InitialSigma{};
  perfectly_started.vehicle.reset();
  SceneCovariance<0> pair(perfectly_started, false, nullptr);
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

void follow(const Scene& scene, const ErrorTrack& track,
            const std::function<void(const CovariancePoint&)>& observer) {
  CovarianceConfig config;
  config.observer = observer;
  with_analysis(scene, track, config, nullptr, [](auto analysis) { analysis.walk(); });
}

CovarianceAnalysis analyze(const Scene& scene, const ErrorTrack& track,
                           const CovarianceConfig& config) {
  return *with_analysis(scene, track, config, nullptr,
                        [](auto analysis) { return analysis.run(); });
}

CovarianceAnalysis analyze_end(const Scene& scene, Stretches& stretches) {
  const CovarianceConfig config;
  const auto run = [&](bool takes_steps) {
    return with_analysis(scene, stretches.track(), config, &stretches, [&](auto analysis) {
      if (takes_steps) analysis.take_steps_of_fixes();
      return analysis.run();
    });
  };
  if (const auto result = run(true)) return *result;
  return *run(false);
}

}  // namespace leeway::sim
