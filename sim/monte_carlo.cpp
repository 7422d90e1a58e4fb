#include "leeway/sim/monte_carlo.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <string>
#include <vector>

#include "leeway/error.hpp"
#include "leeway/filters/chi_square.hpp"
#include "leeway/sim/imu_simulator.hpp"
#include "leeway/sim/parallel.hpp"
#include "leeway/sim/random.hpp"

namespace leeway::sim {
namespace {

struct TrialScore {
  double error_sq_m2{0.0};
  double variance_m2{0.0};
  int epochs{0};
  double nees{0.0};
};

void validate(const MonteCarloConfig& c) {
  if (c.trials < 1 || !(c.gnss_interval_s > 0.0) || !(c.duration_s >= 2.0 * c.gnss_interval_s)) {
    throw Error("Monte Carlo: " + std::to_string(c.trials) + " trials, GNSS interval " +
                std::to_string(c.gnss_interval_s) + " s, duration " + std::to_string(c.duration_s) +
                " s: wanted at least 1 trial, an interval > 0 and a duration of two intervals");
  }
}

/// A start whose error is drawn from P: the estimate e with difference(truth, e) = x, x ~ N(0, P).
Estimate drawn_start(const Estimate& truth, const ErrorMatrix& P, Random random) {
  ErrorVector unit;
  for (int i = 0; i < kErrorStates; ++i) unit(i) = random.normal();
  const Eigen::LDLT<ErrorMatrix> ldlt(P);
  const ErrorVector x =
      ldlt.transpositionsP().transpose() *
      (ldlt.matrixL() * (ldlt.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal() * unit));
  Estimate estimate = truth;
  inject(estimate, -x);
  return estimate;
}

class Trial {
 public:
  Trial(const Trajectory& trajectory, const std::vector<ImuIncrement>& truth,
        const MonteCarloConfig& config, std::uint64_t seed)
      : trajectory_(trajectory),
        truth_(truth),
        config_(config),
        sensor_(config.imu, Random(seed, 0, kImuStream)),
        receiver_(trajectory, config.gnss, Random(seed, 0, kGnssStream)),
        filter_(started(seed)) {}

  TrialScore run() {
    double next_fix_s = config_.gnss_interval_s;
    const double slack_s = 0.5 / config_.imu_rate_hz;
    for (const ImuIncrement& inc : truth_) {
      filter_.predict(sensor_.measure(inc));
      const double t_s = to_seconds(inc.time);
      if (t_s < next_fix_s - slack_s) continue;
      next_fix_s += config_.gnss_interval_s;
      if (t_s > config_.duration_s - config_.score_last_s - slack_s) score(t_s);
      filter_.update(receiver_.fix_at(t_s));
    }
    return score_;
  }

 private:
  Estimate truth_at_time(double t_s) const {
    Estimate truth;
    truth.nav = truth_at(trajectory_, t_s).nav;
    truth.bias = {sensor_.accelerometer_bias_mps2(), sensor_.gyro_bias_radps()};
    return truth;
  }

  Ekf started(std::uint64_t seed) const {
    Estimate truth = truth_at_time(0.0);
    // The filter starts from zero bias; what the sensors drew is then its error.
    Estimate nominal = truth;
    nominal.bias = {};
    ErrorMatrix P = initial_covariance(nominal, config_.initial, config_.filter.imu);
    ErrorMatrix P_nav = P;
    P_nav.bottomRightCorner<6, 6>().setZero();
    return {config_.filter, drawn_start(nominal, P_nav, Random(seed, 0, kInitialStateStream)), P};
  }

  void score(double t_s) {
    const Estimate truth = truth_at_time(t_s);
    const ErrorVector x = difference(truth, filter_.estimate());
    const ErrorMatrix P = filter_.covariance();
    const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(truth.nav.r_e_m)).transpose();
    score_.error_sq_m2 += (C_ne * x.segment<3>(kDr)).head<2>().squaredNorm();
    score_.variance_m2 +=
        (C_ne * P.block<3, 3>(kDr, kDr) * C_ne.transpose()).diagonal().head<2>().sum();
    ++score_.epochs;
    score_.nees += x.dot(Eigen::LDLT<ErrorMatrix>(P).solve(x));
  }

  const Trajectory& trajectory_;
  const std::vector<ImuIncrement>& truth_;
  const MonteCarloConfig& config_;
  ImuErrorSimulator sensor_;
  GnssSimulator receiver_;
  Ekf filter_;
  TrialScore score_{};
};

}  // namespace

MonteCarloResult monte_carlo(const Trajectory& trajectory, const MonteCarloConfig& config,
                             const std::function<void(double fraction)>& progress) {
  validate(config);
  const std::vector<ImuIncrement> truth =
      true_increments(trajectory, config.imu_rate_hz, config.duration_s);
  const auto trials = static_cast<std::size_t>(config.trials);
  std::vector<TrialScore> scores(trials);
  parallel_for(
      trials,
      [&](std::size_t k) {
        scores[k] = Trial(trajectory, truth, config, config.first_seed + k).run();
      },
      [&](std::size_t finished) {
        if (progress) progress(static_cast<double>(finished) / config.trials);
      });

  // Summed in the order of the trials, whatever thread ran them.
  TrialScore sum;
  for (const TrialScore& s : scores) {
    sum.error_sq_m2 += s.error_sq_m2;
    sum.variance_m2 += s.variance_m2;
    sum.epochs += s.epochs;
    sum.nees += s.nees;
  }
  MonteCarloResult result;
  result.rms_horizontal_m = std::sqrt(sum.error_sq_m2 / sum.epochs);
  result.sigma_horizontal_m = std::sqrt(sum.variance_m2 / sum.epochs);
  result.rms_over_sigma = result.rms_horizontal_m / result.sigma_horizontal_m;
  result.mean_nees = sum.nees / sum.epochs;
  const int dof = kErrorStates * config.trials;
  result.nees_low = chi_square_threshold(0.975, dof) / config.trials;
  result.nees_high = chi_square_threshold(0.025, dof) / config.trials;
  return result;
}

}  // namespace leeway::sim
