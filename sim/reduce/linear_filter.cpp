#include "sim/reduce/linear_filter.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "leeway/covariance/covariance_track.hpp"
#include "leeway/covariance/symmetric_kernel.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/ekf/inertial_estimate.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/model/process_noise.hpp"
#include "sim/trials/player.hpp"
#include "sim/trials/recorded_trial.hpp"
#include "sim/trials/trial_score.hpp"

namespace leeway::sim {
namespace {

Eigen::Vector3d rate_in(const TruePath& path, std::size_t increment) {
  const ImuIncrement inc = path.plan.increments()[increment];
  return inc.dtheta_b_rad / inc.dt_s;
}

/// Position and velocity of an antenna at the end of an increment.
Eigen::Matrix<double, 6, 1> antenna_e(const TruePath& path, std::size_t increment,
                                      const Eigen::Vector3d& lever_arm_b_m) {
  const Estimate estimate{path.at_end_of(increment), {}};
  Eigen::Matrix<double, 6, 1> antenna;
  antenna << antenna_position_e(estimate, lever_arm_b_m),
      antenna_velocity_e(estimate, lever_arm_b_m, rate_in(path, increment));
  return antenna;
}

template <class Scalar>
class Pass {
 public:
  Pass(const TruePath& path, const FilterModel& model)
      : path_(path),
        model_(model),
        weight_(model.config.gnss_correlation_s),
        steady_noise_(process_noise(model.config.imu, model.config.biases)),
        noise_(steady_noise_),
        strapdown_(strapdown_function(model.config.strapdown)),
        state_{ErrorVector::Zero(),
               {SymmetricKernel<Scalar>(initial_covariance({path.states.front(), {}},
                                                           path.plan.initial(), model.config.imu,
                                                           model.config.biases)),
                model.config.covariance_interval_s}} {}

  LinearFilterRun run() {
    using Fix = TrialPlan::Fix;
    const auto divider = static_cast<std::size_t>(model_.imu_divider);
    play(
        path_.plan.increments().size(), divider, arriving_fixes(path_.plan),
        [&](std::size_t k) { step(k + 1 - divider, divider); },
        [&](const Fix& fix) {
          if (model_.knows_latency) use(fix, fix.at);
        },
        [&](const Fix& fix) {
          if (!model_.knows_latency) use(fix, fix.arrives);
          if (fix.scored) score();
        });
    return std::move(result_);
  }

 private:
  using Covariance = CovarianceTrack<SymmetricKernel<Scalar>>;
  struct State {
    ErrorVector mean;
    Covariance covariance;
  };

  /// The mean motion, as InertialEstimate has it, and the noise in it.
  void follow_motion(const ImuIncrement& inc, const StrapdownStep& step, const NavState& nav) {
    motion_s_ = std::min(motion_s_ + inc.dt_s, InertialEstimate::kMeanRateS);
    const double share = inc.dt_s / std::max(motion_s_, inc.dt_s);
    const Eigen::Vector3d acceleration_e_mps2 =
        step.dv_f_e_mps / inc.dt_s - kStandardGravityMps2 * nav.r_e_m.normalized();
    motion_.omega_ib_b_radps += share * (inc.dtheta_b_rad / inc.dt_s - motion_.omega_ib_b_radps);
    motion_.acceleration_e_mps2 += share * (acceleration_e_mps2 - motion_.acceleration_e_mps2);
    noise_ = with_motion(steady_noise_, model_.config.imu, motion_);
  }

  void step(std::size_t first, std::size_t count) {
    ImuIncrement inc = path_.plan.increments()[first];
    for (std::size_t k = first + 1; k < first + count; ++k) append(inc, path_.plan.increments()[k]);
    NavState nav = path_.states[first];
    const StrapdownStep step = strapdown_(nav, inc, history_);
    follow_motion(inc, step, nav);
    const ErrorVector missed = difference({path_.states[first + count], {}}, {nav, {}});
    const Eigen::Vector3d r_e_m = path_.states[first].r_e_m;
    const Eigen::Matrix3d true_gradient_e = gravity_gradient_e(r_e_m);
    ErrorDynamics dynamics{.dt_s = inc.dt_s,
                           .C_eb_mean = step.C_eb_mean,
                           .dv_f_e_mps = step.dv_f_e_mps,
                           .gravity_gradient_e = true_gradient_e,
                           .a_a = bias_decay(inc.dt_s, noise_.tau_a_s),
                           .g_g = bias_decay(inc.dt_s, noise_.tau_g_s)};
    Transition Phi;
    advance(Phi, dynamics);
    if (!model_.config.gravity_gradient) dynamics.gravity_gradient_e.setZero();
    const auto carry = [&](State& state) {
      ErrorVector& mean = state.mean;
      const Eigen::Vector3d dr_e_m = mean.segment<3>(kDr);
      const Eigen::Vector3d push_e_mps =
          inc.dt_s * (gravity_change_e(r_e_m, dr_e_m) - true_gradient_e * dr_e_m);
      mean = times(Phi, mean) + missed;
      mean.segment<3>(kDv) += push_e_mps;
      mean.segment<3>(kDr) += 0.5 * inc.dt_s * push_e_mps;
      state.covariance.propagate(dynamics, noise_);
    };
    carry(state_);
    if (without_fix_) carry(*without_fix_);
  }

  /// The model's field, not the normal one, is what the erring filter falls in, and over kilometres
  /// neither is linear.
  Eigen::Vector3d gravity_change_e(const Eigen::Vector3d& r_e_m,
                                   const Eigen::Vector3d& dr_e_m) const {
    const GravityModel gravity = model_.config.strapdown.gravity;
    return gravity_e(gravity, r_e_m) - gravity_e(gravity, r_e_m - dr_e_m);
  }

  void score() {
    result_.epochs.push_back({without_fix_->mean, without_fix_->covariance.matrix(noise_)});
    without_fix_.reset();
  }

  /// Takes the fix for valid at the end of an increment.
  void use(const TrialPlan::Fix& fix, std::size_t increment) {
    if (fix.scored) without_fix_ = state_;
    const Time t = path_.at_end_of(fix.at).time;
    const double weight = weight_.of(t);
    weight_.fused(t);
    const FixRows rows = path_.fix_rows(increment, model_.config.lever_arm_b_m, weight);
    state_.covariance.flush(noise_);
    const FixGains<1> gain = take(state_.covariance.kernel(), rows.H);
    const ErrorMatrix P = state_.covariance.kernel().matrix();
    if (!std::isfinite(expected_nees(P, P))) result_.is_positive = false;
    const Eigen::Vector3d& lever = path_.plan.scene().gnss.errors.lever_arm_b_m;
    const FixRows truth = path_.fix_rows(increment, lever, weight);
    const Eigen::Matrix3d C_ne =
        ned_to_ecef(geodetic_from_ecef(path_.at_end_of(increment).r_e_m)).transpose();
    const Eigen::Matrix<double, 6, 1> missed_e =
        antenna_e(path_, fix.at, lever) - antenna_e(path_, increment, model_.config.lever_arm_b_m);
    Eigen::Matrix<double, 6, 1> missed;
    missed << C_ne * missed_e.head<3>(), C_ne * missed_e.tail<3>();
    missed = missed.cwiseProduct(rows.per_sigma);
    state_.mean -= gain * (truth.H * state_.mean + missed);
    result_.gains.push_back(gain);
  }

  /// The kernel takes the rows; the estimate is linear in what they measure.
  static FixGains<1> take(SymmetricKernel<Scalar>& kernel,
                          const Eigen::Matrix<double, 6, kErrorStates>& H) {
    const MeasurementRows rows = H;
    FixGains<1> gain;
    for (int i = 0; i < 6; ++i) {
      SymmetricKernel<Scalar> probe = kernel;
      ErrorVector x_hat = ErrorVector::Zero();
      probe.update(x_hat, rows, MeasurementValues(Eigen::Matrix<double, 6, 1>::Unit(i)));
      gain.col(i) = x_hat;
    }
    ErrorVector none = ErrorVector::Zero();
    kernel.update(none, rows, MeasurementValues(Eigen::Matrix<double, 6, 1>::Zero()));
    return gain;
  }

  const TruePath& path_;
  const FilterModel& model_;
  PositionWeight weight_;
  ProcessNoise steady_noise_;
  ProcessNoise noise_;
  MeanMotion motion_{};
  double motion_s_{0.0};
  StrapdownFunction strapdown_;
  ImuHistory history_{};
  State state_;
  std::optional<State> without_fix_{};  // what is scored when the fix arrives
  LinearFilterRun result_{};
};

}  // namespace

TruePath::TruePath(const TrialPlan& trial_plan, const StrapdownPolicy& full) : plan(trial_plan) {
  const StrapdownFunction strapdown = strapdown_function(full);
  NavState nav = truth_at(plan.scene().trajectory, 0.0).nav;
  ImuHistory history;
  states.reserve(plan.increments().size() + 1);
  states.push_back(nav);
  for (std::size_t k = 0; k < plan.increments().size(); ++k) {
    strapdown(nav, plan.increments()[k], history);
    states.push_back(nav);
  }
}

FixRows TruePath::fix_rows(std::size_t increment, const Eigen::Vector3d& lever_arm_b_m,
                           double weight) const {
  return sim::fix_rows(at_end_of(increment), rate_in(*this, increment), lever_arm_b_m,
                       plan.scene().gnss.errors, weight);
}

LinearFilterRun run_linear_filter(const TruePath& path, const FilterModel& model) {
  return model.precision == Precision::kFloat ? Pass<float>(path, model).run()
                                              : Pass<double>(path, model).run();
}

}  // namespace leeway::sim
