#include "sim/reduce/linear_filter.hpp"

#include <cmath>
#include <optional>

#include "leeway/covariance/covariance_track.hpp"
#include "leeway/covariance/symmetric_kernel.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/model/process_noise.hpp"
#include "sim/analysis/scene_covariance.hpp"
#include "sim/trials/trial_score.hpp"

namespace leeway::sim {
namespace {

Estimate estimate_at(const NavState& nav) {
  Estimate estimate;
  estimate.nav = nav;
  return estimate;
}

Eigen::Vector3d rate_in(const TruePath& path, std::size_t increment) {
  const ImuIncrement inc = path.plan.increments()[increment];
  return inc.dtheta_b_rad / inc.dt_s;
}

/// Position and velocity of an antenna at the end of an increment.
Eigen::Matrix<double, 6, 1> antenna_e(const TruePath& path, std::size_t increment,
                                      const Eigen::Vector3d& lever_arm_b_m) {
  const Estimate estimate = estimate_at(path.states[increment + 1]);
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
        fixes_(arriving_fixes(path.plan)),
        weights_(fix_weights(path.plan, model.config.gnss_correlation_s)),
        noise_(process_noise(model.config.imu, model.config.biases)),
        strapdown_(strapdown_function(model.config.strapdown)),
        state_{ErrorVector::Zero(),
               {SymmetricKernel<Scalar>(initial_covariance(estimate_at(path.states.front()),
                                                           path.plan.initial(), model.config.imu,
                                                           model.config.biases)),
                model.config.covariance_interval_s}} {}

  LinearFilterRun run() {
    const auto divider = static_cast<std::size_t>(model_.imu_divider);
    for (std::size_t first = 0; next_ < fixes_.size(); first += divider) {
      step(first, divider);
      take_fix(first + divider - 1);
    }
    return std::move(result_);
  }

 private:
  using Covariance = CovarianceTrack<SymmetricKernel<Scalar>>;
  struct State {
    ErrorVector mean;
    Covariance covariance;
  };

  /// What one increment of the model does to a mean error.
  struct Stretch {
    const Transition& Phi;
    const ErrorVector& missed;
    const Eigen::Vector3d& r_e_m;
    const Eigen::Matrix3d& gravity_gradient_e;
    double dt_s;
  };

  void step(std::size_t first, std::size_t count) {
    ImuIncrement inc = path_.plan.increments()[first];
    for (std::size_t k = first + 1; k < first + count; ++k) append(inc, path_.plan.increments()[k]);
    NavState nav = path_.states[first];
    const StrapdownStep step = strapdown_(nav, inc, history_);
    const ErrorVector missed =
        difference(estimate_at(path_.states[first + count]), estimate_at(nav));
    const Eigen::Matrix3d true_gradient_e = gravity_gradient_e(path_.states[first].r_e_m);
    ErrorDynamics dynamics{.dt_s = inc.dt_s,
                           .C_eb_mean = step.C_eb_mean,
                           .dv_f_e_mps = step.dv_f_e_mps,
                           .gravity_gradient_e = true_gradient_e,
                           .a_a = bias_decay(inc.dt_s, noise_.tau_a_s),
                           .g_g = bias_decay(inc.dt_s, noise_.tau_g_s)};
    Transition Phi;
    advance(Phi, dynamics);
    if (!model_.config.gravity_gradient) dynamics.gravity_gradient_e.setZero();
    const Stretch stretch{Phi, missed, path_.states[first].r_e_m, true_gradient_e, inc.dt_s};
    carry(state_, stretch, dynamics);
    if (without_fix_) carry(*without_fix_, stretch, dynamics);
  }

  void carry(State& state, const Stretch& stretch, const ErrorDynamics& dynamics) const {
    ErrorVector& mean = state.mean;
    const Eigen::Vector3d push_e_mps = gravity_beyond_linear(mean.segment<3>(kDr), stretch);
    mean = times(stretch.Phi, mean) + stretch.missed;
    mean.segment<3>(kDv) += push_e_mps;
    mean.segment<3>(kDr) += 0.5 * stretch.dt_s * push_e_mps;
    state.covariance.propagate(dynamics, noise_);
  }

  /// The model's field, not the normal one, is what the erring filter falls in, and over kilometres
  /// neither is linear.
  Eigen::Vector3d gravity_beyond_linear(const Eigen::Vector3d& dr_e_m,
                                        const Stretch& stretch) const {
    const GravityModel gravity = model_.config.strapdown.gravity;
    const Eigen::Vector3d difference =
        gravity_e(gravity, stretch.r_e_m) - gravity_e(gravity, stretch.r_e_m - dr_e_m);
    return stretch.dt_s * (difference - stretch.gravity_gradient_e * dr_e_m);
  }

  void take_fix(std::size_t increment) {
    const TrialPlan::Fix& fix = fixes_[next_];
    const std::size_t used_at = model_.knows_latency ? fix.at : fix.arrives;
    if (increment == used_at) {
      if (fix.scored) without_fix_ = state_;
      update(fix, increment);
    }
    if (increment != fix.arrives) return;
    ++next_;
    if (!fix.scored) return;
    result_.epochs.push_back({without_fix_->mean, without_fix_->covariance.matrix(noise_)});
    without_fix_.reset();
  }

  void update(const TrialPlan::Fix& fix, std::size_t increment) {
    const double weight = weights_[next_];
    const FixRows rows = fix_rows(path_, increment, model_.config.lever_arm_b_m, weight);
    state_.covariance.flush(noise_);
    const FixGain gain = take(state_.covariance.kernel(), rows.H);
    const ErrorMatrix P = state_.covariance.kernel().matrix();
    if (!std::isfinite(expected_nees(P, P))) result_.is_positive = false;
    const Eigen::Vector3d& lever = path_.plan.scene().gnss.errors.lever_arm_b_m;
    const FixRows truth = fix_rows(path_, increment, lever, weight);
    const Eigen::Matrix3d C_ne =
        ned_to_ecef(geodetic_from_ecef(path_.states[increment + 1].r_e_m)).transpose();
    const Eigen::Matrix<double, 6, 1> missed_e =
        antenna_e(path_, fix.at, lever) - antenna_e(path_, increment, model_.config.lever_arm_b_m);
    Eigen::Matrix<double, 6, 1> missed;
    missed << C_ne * missed_e.head<3>(), C_ne * missed_e.tail<3>();
    missed = missed.cwiseProduct(rows.per_sigma);
    state_.mean -= gain * (truth.H * state_.mean + missed);
    result_.gains.push_back(gain);
  }

  /// The kernel takes the rows; the estimate is linear in what they measure.
  static FixGain take(SymmetricKernel<Scalar>& kernel,
                      const Eigen::Matrix<double, 6, kErrorStates>& H) {
    const MeasurementRows rows = H;
    FixGain gain;
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
  std::vector<TrialPlan::Fix> fixes_;
  std::vector<double> weights_;
  ProcessNoise noise_;
  StrapdownFunction strapdown_;
  ImuHistory history_{};
  State state_;
  std::optional<State> without_fix_{};  // what is scored when the fix arrives
  std::size_t next_{0};                 // fix
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

std::vector<TrialPlan::Fix> arriving_fixes(const TrialPlan& plan) {
  std::vector<TrialPlan::Fix> fixes;
  for (const TrialPlan::Fix& fix : plan.fixes()) {
    if (fix.arrives < plan.increments().size()) fixes.push_back(fix);
  }
  return fixes;
}

FixRows fix_rows(const TruePath& path, std::size_t increment, const Eigen::Vector3d& lever_arm_b_m,
                 double weight) {
  const NavState& nav = path.states[increment + 1];
  const GnssFix fix{nav.time, GnssPosition{}, GnssVelocity{}};
  const Measurement m =
      gnss_measurement(fix, estimate_at(nav), lever_arm_b_m, rate_in(path, increment));
  const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(nav.r_e_m)).transpose();
  FixRows rows;
  rows.per_sigma = fix_variance(path.plan.scene().gnss.errors).cwiseSqrt().cwiseInverse();
  rows.per_sigma.head<3>() *= weight;
  rows.H << C_ne * m.H.topRows<3>(), C_ne * m.H.bottomRows<3>();
  rows.H = rows.per_sigma.asDiagonal() * rows.H;
  return rows;
}

std::vector<double> fix_weights(const TrialPlan& plan, double correlation_s) {
  std::vector<double> weights;
  std::optional<std::size_t> last;
  for (const TrialPlan::Fix& fix : arriving_fixes(plan)) {
    const double since_s =
        last ? static_cast<double>(fix.at - *last) / plan.scene().imu_rate_hz : 0.0;
    weights.push_back(last ? gnss_position_weight(since_s, correlation_s) : 1.0);
    last = fix.at;
  }
  return weights;
}

LinearFilterRun run_linear_filter(const TruePath& path, const FilterModel& model) {
  return model.precision == Precision::kFloat ? Pass<float>(path, model).run()
                                              : Pass<double>(path, model).run();
}

}  // namespace leeway::sim
