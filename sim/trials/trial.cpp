#include "leeway/sim/trials/trial.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <string>

#include "leeway/earth/error.hpp"
#include "leeway/model/horizontal.hpp"
#include "leeway/sim/scene/receiver.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/sim/tools/random.hpp"
#include "sim/trials/estimators.hpp"
#include "sim/trials/player.hpp"
#include "sim/trials/recorded_trial.hpp"
#include "sim/trials/trial_score.hpp"

namespace leeway::sim {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw Error("Monte Carlo trial: " + what); }

const Scene& checked(const Scene& scene) {
  validate(scene);
  if (scene.gnss.interval_s * scene.imu_rate_hz < 1.0 - 1e-9) {
    refuse(fmt::format("gnss interval_s is {:g}, must be at least that of the IMU, {:g} s: raise "
                       "imu_rate_hz",
                       scene.gnss.interval_s, 1.0 / scene.imu_rate_hz));
  }
  if (scene.duration_s < 2.0 * scene.gnss.interval_s) {
    refuse(fmt::format("duration_s is {:g}, must be at least two GNSS intervals of {:g} s",
                       scene.duration_s, scene.gnss.interval_s));
  }
  return scene;
}

/// Fixes are valid, and arrive, at the end of what the filter takes for one increment.
void require_step(const Scene& scene, const TrialPlan::Fix& fix) {
  if (fits(fix, scene.imu_divider)) return;
  refuse("imu_divider is " + std::to_string(scene.imu_divider) +
         ", but a fix is valid at increment " + std::to_string(fix.at + 1) + " and arrives at " +
         std::to_string(fix.arrives + 1) + ": both must be multiples of it");
}

template <class UnderTest>
class Trial {
 public:
  Trial(const TrialPlan& plan, std::uint64_t seed,
        const std::function<void(const TrialEpoch&)>& observer)
      : plan_(plan),
        observer_(observer),
        sensor_(plan.scene().imu, Random(seed, 0, kImuStream)),
        receiver_(plan.scene().trajectory, plan.scene().gnss, seed),
        estimator_(plan, seed) {
    score_.seed = seed;
  }

  TrialScore run() {
    const auto divider = static_cast<std::size_t>(plan_.scene().imu_divider);
    const auto while_finite = [this](auto&& call) {
      return [this, call](const auto& event) {
        if (score_.finite) call(event);
      };
    };
    play(plan_.increments().size(), divider, plan_.fixes(),
         while_finite([&](std::size_t k) { advance(k + 1 - divider, divider); }),
         while_finite([&](const TrialPlan::Fix& fix) { take(fix); }),
         while_finite([&](const TrialPlan::Fix& fix) { arrive(fix); }));
    if (!score_.finite) score_.diverged = true;
    return score_;
  }

 private:
  void advance(std::size_t first, std::size_t count) {
    ImuIncrement inc;
    for (std::size_t k = first; k < first + count; ++k) {
      append(inc, sensor_.measure(plan_.increments()[k]));
    }
    now_ = inc.time;
    estimator_.advance(inc);
  }

  void take(const TrialPlan::Fix& fix) {
    if (observer_) tell();
    estimator_.take(receiver_.fix_at(to_seconds(now_)), fix.scored, score_);
  }

  void arrive(const TrialPlan::Fix& fix) {
    if (fix.scored) score();
    estimator_.arrive(fix.scored, score_);
  }

  void score() {
    const std::optional<TrialBelief> belief = estimator_.at_arrival();
    if (!belief) {
      // No answer where one is wanted.
      score_.diverged = true;
      return;
    }
    Estimate truth;
    truth.nav = truth_at(plan_.scene().trajectory, to_seconds(now_)).nav;
    truth.bias = {sensor_.accelerometer_bias_mps2(), sensor_.gyro_bias_radps()};
    score_epoch(score_, truth, belief->estimate, &belief->P);
  }

  void tell() {
    const std::optional<TrialBelief> belief = estimator_.at_fix();
    const double t_s = to_seconds(now_);
    if (!belief) {
      constexpr double kUnknown = std::numeric_limits<double>::infinity();
      observer_({t_s, kUnknown, kUnknown, Eigen::Vector3d::Constant(kUnknown)});
      return;
    }
    const Estimate truth{truth_at(plan_.scene().trajectory, t_s).nav, {}};
    const Eigen::Matrix2d P_ne_m2 =
        horizontal_covariance(belief->estimate.nav.r_e_m, belief->P.block<3, 3>(kDr, kDr));
    const Eigen::Vector3d error_n_m = position_error_n_m(truth, belief->estimate);
    observer_({t_s, error_n_m.head<2>().norm(), horizontal_radius_m(P_ne_m2, 0.95), error_n_m});
  }

  const TrialPlan& plan_;
  const std::function<void(const TrialEpoch&)>& observer_;
  ImuErrorSimulator sensor_;
  Receiver receiver_;
  UnderTest estimator_;
  Time now_{};
  TrialScore score_{};
};

}  // namespace

TrialPlan::TrialPlan(const Scene& scene, std::optional<double> score_last_s, int threads)
    : scene_(checked(scene)),
      increments_(scene.trajectory, scene.imu_rate_hz, scene.duration_s, threads),
      initial_(initial_sigma(scene)) {
  const double last_s = score_last_s.value_or(scored_part_s(scene));
  const auto epoch = [&](double t_s) {
    return static_cast<std::size_t>(std::llround(t_s * scene.imu_rate_hz)) - 1;
  };
  std::size_t scored = 0;
  std::size_t last_arrives = 0;  // of the scored ones
  for (const double t_s : fix_times_s(scene.gnss, scene.duration_s)) {
    Fix fix{epoch(t_s), epoch(t_s + scene.gnss.latency_s), false};
    fix.scored = t_s + scene.gnss.latency_s > scene.duration_s - last_s - 0.5 / scene.imu_rate_hz &&
                 fix.arrives < increments_.size() && (scored == 0 || fix.at >= last_arrives);
    if (fix.scored) last_arrives = fix.arrives;
    if (fix.scored) ++scored;
    require_step(scene, fix);
    fixes_.push_back(fix);
  }
  if (scored == 0) {
    refuse("no fix to score in the last " + std::to_string(last_s) + " s of the scene '" +
           scene.name + "': lengthen duration_s, or shorten the outages or the latency");
  }
}

TrialScore run_trial(const TrialPlan& plan, std::uint64_t seed,
                     const std::function<void(const TrialEpoch&)>& observer) {
  if (plan.scene().estimator == SceneEstimator::kNavigator) {
    return Trial<NavigatorUnderTest>(plan, seed, observer).run();
  }
  return Trial<EkfUnderTest>(plan, seed, observer).run();
}

}  // namespace leeway::sim
