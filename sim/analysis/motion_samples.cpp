#include "sim/analysis/motion_samples.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/ekf/inertial_estimate.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway::sim {
namespace {

Eigen::Vector3d acceleration_e(const TruthPoint& truth) {
  return truth.nav.q_eb * truth.f_ib_b_mps2 + gravity_e(GravityModel::kNormal, truth.nav.r_e_m);
}

/// Whether one truth may stand for a stretch of time.
bool is_steady(const TruthPoint& start, const TruthPoint& middle, const TruthPoint& end,
               double dt_s) {
  constexpr double kTurnRad = 1e-4;
  constexpr double kRateRadps = 1e-5;
  constexpr double kForceMps2 = 1e-3;
  const auto differ = [](const auto& a, const auto& b, double by) { return (a - b).norm() > by; };
  if (differ(start.omega_ib_b_radps, middle.omega_ib_b_radps, kRateRadps)) return false;
  if (differ(end.omega_ib_b_radps, middle.omega_ib_b_radps, kRateRadps)) return false;
  if (differ(start.f_ib_b_mps2, middle.f_ib_b_mps2, kForceMps2)) return false;
  if (differ(end.f_ib_b_mps2, middle.f_ib_b_mps2, kForceMps2)) return false;
  if (start.nav.q_eb.angularDistance(end.nav.q_eb) > kTurnRad) return false;
  // Nothing has happened between the three that they do not show.
  const Eigen::Vector3d coriolis = 2.0 * earth_rotation_e_radps().cross(middle.nav.v_e_mps);
  const Eigen::Vector3d expected = start.nav.v_e_mps + dt_s * (acceleration_e(middle) - coriolis);
  return !differ(end.nav.v_e_mps, expected, dt_s * kForceMps2);
}

}  // namespace

/// The truth of a trajectory, taken as densely as it changes.
class MotionSamples::Sampler {
 public:
  Sampler(MotionSamples& samples, const Trajectory& trajectory, std::size_t steps)
      : samples_(samples),
        trajectory_(trajectory),
        steps_(steps),
        start_(truth_at(trajectory, 0.0)) {}

  void sample() {
    while (step_ < steps_) {
      const std::size_t first_piece = samples_.pieces_.size();
      const Eigen::Vector3d v_before = start_.nav.v_e_mps;
      std::size_t legs = std::min(2 * legs_, std::min(kMostLegs, steps_ - step_));
      while (legs > 1 && !add_steady(legs)) legs /= 2;
      if (legs == 1 && !add_steady(1)) add_moving();
      const double run_s = static_cast<double>(legs) * samples_.step_s_;
      Run run;
      run.first_piece = first_piece;
      run.is_steady = samples_.pieces_.size() == first_piece + 1;
      run.gain_e_mps2 = (start_.nav.v_e_mps - v_before) / run_s;
      run.gravity_gradient_e = gravity_gradient_e(middle_.nav.r_e_m);
      run.middle = middle_;
      run.middle_s = time_s(static_cast<double>(step_)) + 0.5 * run_s;
      samples_.run_of_.insert(samples_.run_of_.end(), legs,
                              static_cast<std::uint32_t>(samples_.runs_.size()));
      samples_.runs_.push_back(run);
      step_ += legs;
      legs_ = legs;
    }
  }

 private:
  static constexpr std::size_t kMostLegs = 64;

  double time_s(double step) const { return step * samples_.step_s_; }

  /// One piece for some legs in a row. @returns false, and changes nothing, where they differ.
  bool add_steady(std::size_t legs) {
    const auto begin = static_cast<double>(step_);
    const auto count = static_cast<double>(legs);
    const TruthPoint end = truth_at(trajectory_, time_s(begin + count));
    middle_ = truth_at(trajectory_, time_s(begin + 0.5 * count));
    if (!is_steady(start_, middle_, end, time_s(count))) return false;
    if (legs > 1 && !mean_has_come_to(middle_)) return false;
    MeanMotion of_leg;
    for (int i = 0; i < kPiecesPerStep; ++i) {
      let_mean_follow(middle_);
      of_leg.omega_ib_b_radps += mean_.omega_ib_b_radps / kPiecesPerStep;
      of_leg.acceleration_e_mps2 += mean_.acceleration_e_mps2 / kPiecesPerStep;
    }
    pieces_before_ += (legs - 1) * kPiecesPerStep;
    add_piece(middle_, of_leg);
    start_ = end;
    return true;
  }

  void add_moving() {
    for (int i = 0; i < kPiecesPerStep; ++i) {
      const double at = static_cast<double>(step_) + (i + 0.5) / kPiecesPerStep;
      const TruthPoint truth = truth_at(trajectory_, time_s(at));
      let_mean_follow(truth);
      add_piece(truth, mean_);
    }
    start_ = truth_at(trajectory_, time_s(static_cast<double>(step_ + 1)));
  }

  void add_piece(const TruthPoint& truth, const MeanMotion& motion) {
    samples_.pieces_.push_back({truth.nav.q_eb, truth.f_ib_b_mps2, truth.omega_ib_b_radps, motion});
  }

  void let_mean_follow(const TruthPoint& truth) {
    const double piece_s = samples_.piece_s();
    const double window_s = std::clamp(static_cast<double>(++pieces_before_) * piece_s, piece_s,
                                       std::max(InertialEstimate::kMeanRateS, piece_s));
    const double share = piece_s / window_s;
    mean_.omega_ib_b_radps += share * (truth.omega_ib_b_radps - mean_.omega_ib_b_radps);
    mean_.acceleration_e_mps2 += share * (acceleration_e(truth) - mean_.acceleration_e_mps2);
  }

  /// Whether the filter's mean of the motion is that of now.
  bool mean_has_come_to(const TruthPoint& now) const {
    return (mean_.omega_ib_b_radps - now.omega_ib_b_radps).norm() < 1e-5 &&
           (mean_.acceleration_e_mps2 - acceleration_e(now)).norm() < 1e-3;
  }

  MotionSamples& samples_;
  const Trajectory& trajectory_;
  std::size_t steps_;
  TruthPoint start_;   // of the step
  TruthPoint middle_;  // of the run
  std::size_t step_{0};
  std::size_t legs_{1};  // of the last run
  std::size_t pieces_before_{0};
  MeanMotion mean_{};
};

MotionSamples::MotionSamples(const Trajectory& trajectory, double duration_s, double step_s)
    : path_(trajectory, duration_s) {
  require("error track", "step_s", step_s, between(0.01, 100.0));
  require("error track", "duration_s", duration_s, kPositive);
  const double period_s = trajectory.period_s.value_or(duration_s);
  const double span_s = std::min(period_s, duration_s);
  const auto steps = static_cast<std::size_t>(std::ceil(span_s / step_s - kSlack));
  step_s_ = span_s / static_cast<double>(steps);
  run_of_.reserve(steps);
  Sampler(*this, trajectory, steps).sample();
}

TruthPoint MotionSamples::truth(const Trajectory& trajectory, double t_s) const {
  const double span_s = static_cast<double>(steps()) * step_s_;
  const double local_s = t_s - std::max(std::ceil(t_s / span_s - kSlack) - 1.0, 0.0) * span_s;
  const double step = std::max(std::floor(local_s / step_s_ + kSlack), 0.0);
  const Run& run = runs_[run_of_[std::min(static_cast<std::size_t>(step), steps() - 1)]];
  if (!run.is_steady) return truth_at(trajectory, t_s);
  const double dt_s = local_s - run.middle_s;
  TruthPoint truth = run.middle;
  truth.nav.r_e_m += dt_s * truth.nav.v_e_mps;
  truth.nav.v_e_mps += dt_s * run.gain_e_mps2;
  return truth;
}

const std::vector<TruthPoint>& MotionSamples::ends(const Trajectory& trajectory,
                                                   double until_s) const {
  std::call_once(has_ends_, [&] {
    const auto steps = static_cast<std::size_t>(std::floor(until_s / step_s_ + kSlack));
    ends_.reserve(steps + 1);
    for (std::size_t k = 0; k <= steps; ++k) {
      ends_.push_back(truth_at(trajectory, std::min(static_cast<double>(k) * step_s_, until_s)));
    }
  });
  return ends_;
}

}  // namespace leeway::sim
