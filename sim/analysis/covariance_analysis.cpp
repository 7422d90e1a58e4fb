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

constexpr double kSamePhase = 1e-6;
/// What fixes that are taken as one may take off the variance of the position: the sigma between
/// them, taken for the mean, is then wrong by 2e-4.
constexpr double kMostOfAFix = 0.05;
constexpr int kStepsAsOne = 2;

/// A navigator takes positions as good as carrier phase gives them for white.
double believed_correlation_s(const Scene& scene) {
  const bool is_white = scene.estimator == SceneEstimator::kNavigator &&
                        has_white_error(fix_variance(scene.gnss.errors).head<3>().sum());
  return is_white ? 0.0 : scene.filter.gnss_correlation_s;
}

template <int kParameters>
class Analysis {
 public:
  static constexpr int kOfVehicle = kParameters;

  /// @param stretches  of the track, when only the scene's end matters
  Analysis(const Scene& scene, const ErrorTrack& track, const CovarianceConfig& config,
           Stretches* stretches = nullptr)
      : scene_(scene),
        track_(track),
        stretches_(stretches),
        config_(config),
        correlation_s_(believed_correlation_s(scene)),
        pair_(scene, config.by_source, track.aiding()),
        scored_s_(scored_part_s(scene)),
        settling_(scene),
        scored_(scene, track) {
    if (!pair_.takes_stretches()) stretches_ = nullptr;
  }

  /// Takes the fixes of a step as one, or of some steps of steady motion, where all that follow the
  /// filter's settling are looked at.
  void take_fixes_of(int most_steps) {
    const bool all_are_seen = scene_.gnss.settle_s > 0.0 && scene_.gnss.outages.empty();
    most_steps_ = all_are_seen ? most_steps : 0;
  }

  /// Begins with the filter settled; one that is yet to be known is made on the way.
  void begin_with(std::optional<SettledFilter<kParameters>>& settled) {
    if (scene_.gnss.settle_s == 0.0 || !scene_.gnss.outages.empty()) return;
    settled_ = &settled;
    if (!settled) return;
    pair_ = settled->pair;
    for (const VariancesBefore& fix : settled->fixes) settling_.see(fix);
    fixes_ = settled->fixes.size();
    now_s_ = last_fix_s_ = settled_until_s_ = settled->fixes.back().t_s;
  }

  void walk() {
    int waiting = 0;
    for (const double t_s : fix_times_s(scene_.gnss, scene_.duration_s)) {
      if (t_s <= settled_until_s_) continue;
      if (waiting == 0) fixes_in_one_ = fixes_after(last_fix_s_);
      if (++waiting < fixes_in_one_) continue;
      waiting = 0;
      if (t_s < repeated_until_s_) {
        ++fixes_;
        continue;
      }
      const double arrival_s = t_s + scene_.gnss.latency_s;
      if (arrival_s > scene_.duration_s) break;
      keep_settled(t_s);
      now_s_ = advance(pair_, now_s_, t_s);
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

  void tell(const SceneCovariance<kParameters>& pair, CovariancePoint before) const {
    if (!config_.observer) return;
    before.innovation_n_m2 = pair.innovation_n_m2(ned_to_ecef(geodetic_from_ecef(before.r_e_m)));
    config_.observer(before);
  }

  /// The fix of now, or as many as one that stands for them ends with.
  void take_fix(double arrival_s) {
    const int fixes = fixes_in_one_;
    VariancesBefore fix{now_s_, arrival_s};
    fix.variances << pair_.claimed().diagonal(), pair_.truth().diagonal();
    settling_.see(fix);
    if (settled_ != nullptr && !*settled_) settling_fixes_.push_back(fix);
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
    tell(pair, before);
    if (!counts(before.t_s)) return;
    const bool is_worst = scored_.add(before, std::max(last_fix_s, 0.0));
    if (!is_worst || !config_.by_source) return;
    error_budget_ = pair.error_budget(ned_to_ecef(geodetic_from_ecef(before.r_e_m)));
  }

  bool counts(double arrival_s) const { return stretch_of(scene_, arrival_s, scored_s_) == 0; }

  /// @param t_s  of the next fix
  void keep_settled(double t_s) {
    if (settled_ == nullptr || *settled_ || settling_fixes_.empty()) return;
    if (t_s <= scene_.gnss.settle_s) return;
    settled_->emplace(SettledFilter<kParameters>{pair_, std::move(settling_fixes_)});
  }

  CovarianceAnalysis finished() {
    if (scored_.empty()) {
      throw Error("scene '" + scene_.name + "': no fix in its last " + std::to_string(scored_s_) +
                  " s: shorten the fix interval or move the outages");
    }
    const std::optional<double> settled_s = settling_.finish(now_s_);
    CovarianceAnalysis r = scored_.result();
    r.error_budget = error_budget_;
    r.window_s = scored_s_;
    r.fixes = fixes_;
    r.settled = settled_s.has_value();
    r.settled_s = settled_s.value_or(scene_.duration_s);
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
    const double followed_s = std::max(scored_s_, 2.0 * settling_.window_s());
    const FixSpan span{now_s_, scene_.duration_s - scene_.gnss.latency_s - followed_s, interval_s,
                       gnss_position_weight(interval_s, correlation_s_)};
    const auto pattern = fix_pattern(scene_, track_, span);
    if (!pattern) return;
    now_s_ = repeat_fixes(pair_, scene_, *stretches_, span, *pattern);
    const double fixes = std::floor((now_s_ - span.from_s) / interval_s + kSamePhase);
    last_fix_s_ = span.from_s + fixes * interval_s;
    repeated_until_s_ = last_fix_s_ + 0.5 * interval_s;
    settling_.forget();
  }

  /// How many fixes after this one are taken as one. The first of them are not: the filter has yet
  /// to come to them.
  int fixes_after(double fix_s) const {
    const double step_s = track_.step_s();
    if (most_steps_ == 0 || fix_s < scene_.gnss.settle_s + most_steps_ * step_s) return 1;
    const auto run_at = [&](double t_s) {
      return track_.run_of(static_cast<std::size_t>(t_s / step_s + kSamePhase) % track_.steps());
    };
    int steps = most_steps_;
    while (steps > 1 && run_at(fix_s) != run_at(fix_s + steps * step_s)) steps /= 2;
    return std::max(static_cast<int>(steps * step_s / scene_.gnss.interval_s + kSamePhase), 1);
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
  double scored_s_;
  Settling settling_;
  double now_s_{0.0};
  double last_fix_s_{-std::numeric_limits<double>::infinity()};  // the first fix has weight 1
  double repeated_until_s_{0.0};
  bool has_tried_to_repeat_{false};
  int most_steps_{0};
  int fixes_in_one_{1};
  bool is_coarse_{false};
  std::size_t fixes_{0};
  std::optional<SettledFilter<kParameters>>* settled_{nullptr};
  std::vector<VariancesBefore> settling_fixes_{};
  double settled_until_s_{0.0};
  ScoredFixes scored_;
  ErrorBudget error_budget_{};
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

CovarianceAnalysis EndAnalysis::at(double interval_s) {
  scene_.gnss.interval_s = interval_s;
  if (const auto result = run(kStepsAsOne)) return *result;
  if (const auto result = run(1)) return *result;
  return *run(0);
}

std::optional<CovarianceAnalysis> EndAnalysis::run(int most_steps) {
  const CovarianceConfig config;
  return with_analysis(scene_, track_, config, &stretches_, [&](auto analysis) {
    analysis.begin_with(std::get<Settled<decltype(analysis)::kOfVehicle>>(settled_));
    analysis.take_fixes_of(most_steps);
    return analysis.run();
  });
}

}  // namespace leeway::sim
