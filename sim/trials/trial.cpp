#include "leeway/sim/trials/trial.hpp"

#include <cmath>
#include <sstream>
#include <string>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/model/horizontal.hpp"
#include "leeway/sim/scene/receiver.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/sim/tools/random.hpp"
#include "sim/trials/trial_score.hpp"

namespace leeway::sim {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw Error("Monte Carlo trial: " + what); }

const Scene& checked(const Scene& scene) {
  validate(scene);
  std::ostringstream message;
  if (scene.gnss.interval_s * scene.imu_rate_hz < 1.0 - 1e-9) {
    message << "gnss interval_s is " << scene.gnss.interval_s << ", must be at least that of the "
            << "IMU, " << 1.0 / scene.imu_rate_hz << " s: raise imu_rate_hz";
    refuse(message.str());
  }
  if (scene.duration_s < 2.0 * scene.gnss.interval_s) {
    message << "duration_s is " << scene.duration_s << ", must be at least two GNSS intervals of "
            << scene.gnss.interval_s << " s";
    refuse(message.str());
  }
  return scene;
}

/// Fixes are valid, and arrive, at the end of what the filter takes for one increment.
void require_step(const Scene& scene, const TrialPlan::Fix& fix) {
  const auto n = static_cast<std::size_t>(scene.imu_divider);
  if ((fix.at + 1) % n == 0 && (fix.arrives + 1) % n == 0) return;
  refuse("imu_divider is " + std::to_string(n) + ", but a fix is valid at increment " +
         std::to_string(fix.at + 1) + " and arrives at " + std::to_string(fix.arrives + 1) +
         ": both must be multiples of it");
}

Ekf started(const TrialPlan& plan, std::uint64_t seed) {
  const TrialStart start = trial_start(plan, seed);
  return {plan.scene().filter, start.estimate, start.P};
}

class Trial {
 public:
  Trial(const TrialPlan& plan, std::uint64_t seed,
        const std::function<void(const TrialEpoch&)>& observer)
      : plan_(plan),
        observer_(observer),
        sensor_(plan.scene().imu, Random(seed, 0, kImuStream)),
        receiver_(plan.scene().trajectory, plan.scene().gnss, seed),
        filter_(started(plan, seed)) {
    score_.seed = seed;
  }

  TrialScore run();

 private:
  void take_fix(const TrialPlan::Fix& fix);
  void score(const Ekf& filter);
  void tell();

  const TrialPlan& plan_;
  const std::function<void(const TrialEpoch&)>& observer_;
  ImuErrorSimulator sensor_;
  Receiver receiver_;
  Ekf filter_;
  std::optional<Ekf> without_fix_{};  // the filter without the scored fix that is on its way
  std::size_t arrives_{};             // when that fix does
  TrialScore score_{};
};

TrialScore Trial::run() {
  const TrueIncrements& truth = plan_.increments();
  auto next = plan_.fixes().begin();
  const auto divider = static_cast<std::size_t>(plan_.scene().imu_divider);
  ImuIncrement inc;
  for (std::size_t k = 0; k < truth.size() && score_.finite; ++k) {
    append(inc, sensor_.measure(truth[k]));
    if ((k + 1) % divider != 0) continue;
    filter_.predict(inc);
    if (without_fix_) without_fix_->predict(inc);
    inc = ImuIncrement{};
    if (without_fix_ && k == arrives_) {
      score(*without_fix_);
      without_fix_.reset();
    }
    if (next != plan_.fixes().end() && k == next->at) take_fix(*next++);
  }
  if (!score_.finite) score_.diverged = true;
  return score_;
}

void Trial::take_fix(const TrialPlan::Fix& fix) {
  if (observer_) tell();
  if (fix.scored && fix.arrives == fix.at) score(filter_);
  if (fix.scored && fix.arrives > fix.at) {
    without_fix_ = filter_;
    arrives_ = fix.arrives;
  }
  const UpdateOutcome report =
      filter_.update(receiver_.fix_at(to_seconds(filter_.estimate().nav.time)));
  if (report.outcome == UpdateOutcome::Outcome::kGated) ++score_.gated;
  if (report.outcome == UpdateOutcome::Outcome::kFused) {
    ++score_.fused;
    if (fix.scored) {
      score_.nis += report.nis;
      score_.nis_dof += report.dof;
    }
  }
  if (!report.covariance_positive || !filter_.estimate().nav.r_e_m.allFinite()) {
    score_.finite = false;
  }
}

void Trial::score(const Ekf& filter) {
  Estimate truth;
  truth.nav = truth_at(plan_.scene().trajectory, to_seconds(filter.estimate().nav.time)).nav;
  truth.bias = {sensor_.accelerometer_bias_mps2(), sensor_.gyro_bias_radps()};
  const ErrorMatrix P = filter.covariance();
  score_epoch(score_, truth, filter.estimate(), &P);
}

void Trial::tell() {
  const NavState& nav = filter_.estimate().nav;
  const double t_s = to_seconds(nav.time);
  const NavState truth = truth_at(plan_.scene().trajectory, t_s).nav;
  const Eigen::Vector3d error_n_m =
      ned_to_ecef(geodetic_from_ecef(truth.r_e_m)).transpose() * (nav.r_e_m - truth.r_e_m);
  const Eigen::Matrix2d P_ne_m2 =
      horizontal_covariance(nav.r_e_m, filter_.covariance().block<3, 3>(kDr, kDr));
  observer_({t_s, error_n_m.head<2>().norm(), horizontal_error_m(HorizontalMetric::kR95, P_ne_m2)});
}

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
  return Trial(plan, seed, observer).run();
}

}  // namespace leeway::sim
