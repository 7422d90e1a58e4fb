#include "sim/trials/estimators.hpp"

#include "leeway/covariance/covariance.hpp"
#include "leeway/earth/earth.hpp"
#include "sim/trials/trial_score.hpp"

namespace leeway::sim {
namespace {

Ekf filter_of(const TrialPlan& plan, const TrialStart& start) {
  return {plan.scene().filter, start.estimate, start.P};
}

void add_outcome(TrialScore& score, const UpdateOutcome& outcome, bool scored) {
  if (outcome.outcome == UpdateOutcome::Outcome::kGated) ++score.gated;
  if (outcome.outcome != UpdateOutcome::Outcome::kFused) return;
  ++score.fused;
  if (!scored) return;
  score.nis += outcome.nis;
  score.nis_dof += outcome.dof;
}

}  // namespace

EkfUnderTest::EkfUnderTest(const TrialPlan& plan, std::uint64_t seed)
    : filter_(filter_of(plan, trial_start(plan, seed))) {}

void EkfUnderTest::advance(const ImuIncrement& inc) {
  filter_.predict(inc);
  if (without_fix_) without_fix_->predict(inc);
}

std::optional<TrialBelief> EkfUnderTest::at_fix() const {
  return TrialBelief{filter_.estimate(), filter_.covariance()};
}

void EkfUnderTest::take(const GnssFix& fix, bool scored, TrialScore& score) {
  if (scored) without_fix_ = filter_;
  const UpdateOutcome outcome = filter_.update(fix);
  add_outcome(score, outcome, scored);
  if (!outcome.covariance_positive || !filter_.estimate().nav.r_e_m.allFinite()) {
    score.finite = false;
  }
}

std::optional<TrialBelief> EkfUnderTest::at_arrival() const {
  return TrialBelief{without_fix_->estimate(), without_fix_->covariance()};
}

void EkfUnderTest::arrive(bool scored, TrialScore& /*score*/) {
  if (scored) without_fix_.reset();
}

NavigatorUnderTest::NavigatorUnderTest(const TrialPlan& plan, std::uint64_t seed)
    : plan_(plan), navigator_(navigator_config(plan.scene())) {
  const Scene& scene = plan.scene();
  if (scene.vehicle) sensors_.emplace(*scene.vehicle, seed);
  if (!scene.initial) return;
  const TrialStart start = trial_start(plan, seed);
  navigator_.start(start.estimate, start.P);
}

void NavigatorUnderTest::advance(const ImuIncrement& inc) {
  navigator_.push(inc);
  if (!sensors_) return;
  const double to_s = to_seconds(inc.time);
  sensors_->read(plan_.scene().trajectory, inc.time, to_s - inc.dt_s, to_s,
                 [this](const Reading& reading) { navigator_.push(reading); });
}

void NavigatorUnderTest::arrive(bool scored, TrialScore& score) {
  const bool was_aligned = navigator_.aligned();
  navigator_.push(waiting_.front());
  waiting_.pop_front();
  if (was_aligned) add_outcome(score, navigator_.last_update(), scored);
}

/// The position and its sigmas are those of the solution, which speaks for all headings and rivals
/// that are possible; the rest is the likeliest filter's.
std::optional<TrialBelief> NavigatorUnderTest::belief() const {
  if (!navigator_.aligned()) return {};
  const Solution solution = navigator_.solution();
  TrialBelief belief{navigator_.filter().estimate(), navigator_.filter().covariance()};
  belief.estimate.nav = solution.nav;
  const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(solution.nav.r_e_m)).transpose();
  const Eigen::Vector3d own_sigma_n_m =
      (C_ne * belief.P.block<3, 3>(kDr, kDr) * C_ne.transpose()).diagonal().cwiseSqrt();
  const Eigen::Vector3d widening = solution.sigma_position_n_m.cwiseQuotient(own_sigma_n_m);
  transform_block(belief.P, kDr, C_ne.transpose() * widening.asDiagonal() * C_ne);
  return belief;
}

}  // namespace leeway::sim
