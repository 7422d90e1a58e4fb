/// @file
/// BasicEkf over any kernel, watched: also over kernels that only a scene has.
#pragma once

#include <algorithm>

#include "leeway/alternatives/nis_monitor.hpp"
#include "leeway/alternatives/noise_rounding.hpp"
#include "leeway/covariance/covariance.hpp"
#include "leeway/ekf/ekf.hpp"
#include "leeway/model/heading.hpp"
#include "leeway/model/process_noise.hpp"
#include "leeway/navigator/heading_bank.hpp"
#include "sim/atlas/watched_filter.hpp"

namespace leeway::sim {

/// What can be seen of any filter by its estimate and covariance.
class CommonDetectors {
 public:
  explicit CommonDetectors(const ImuErrorModel& imu) : imu_(imu) {}

  void note(const GnssFix& fix, const Estimate& estimate, const ErrorMatrix& P) {
    if (!is_positive_definite(P)) reports_.insert("P not positive");
    const bool at_rest =
        fix.velocity && fix.velocity->v_e_mps.norm() < AlignmentConfig{}.rest_speed_mps;
    const double heading_variance = heading_variance_rad2(estimate, P);
    constexpr double kOneFilterRad = HeadingBank::kOneFilterRad;
    if (heading_variance > kOneFilterRad * kOneFilterRad) reports_.insert("heading too open");
    if (at_rest && rest_hides_heading(imu_, estimate, P)) reports_.insert("rest hides heading");
  }

  void note_unusable() { reports_.insert("fix unusable"); }
  void note_gated() { reports_.insert("gated"); }
  void note_noise_lost() { reports_.insert("noise lost"); }
  void note_nis(double nis, int dof) { nis_.note(nis, dof); }

  Reports reports() const {
    Reports all = reports_;
    if (nis_.is_high()) all.insert("NIS high");
    if (nis_.is_low()) all.insert("NIS low");
    return all;
  }

 private:
  ImuErrorModel imu_;
  NisMonitor nis_{};
  Reports reports_{};
};

/// BasicEkf over any kernel, with any error.
template <class Kernel, class Error>
class WatchedEkf final : public WatchedFilter {
 public:
  explicit WatchedEkf(const BasicEkf<Kernel, Error>& filter, const FixTrust& trust = {})
      : filter_(filter), trust_(trust), detectors_(filter.inertial().config().imu) {}

  void predict(const ImuIncrement& inc) override {
    filter_.predict(inc);
    step_s_ = inc.dt_s;
  }

  void update(const GnssFix& fix) override {
    const UpdateOutcome outcome = filter_.update(fix, trust_);
    if (outcome.dof == 0) return detectors_.note_unusable();
    const bool is_fused = outcome.outcome == UpdateOutcome::Outcome::kFused;
    if (outcome.outcome == UpdateOutcome::Outcome::kGated) detectors_.note_gated();
    if (outcome.covariance_positive) detectors_.note_nis(outcome.nis, outcome.dof);
    const ErrorMatrix P = filter_.covariance();
    detectors_.note(fix, filter_.estimate(), P);
    if (is_fused &&
        noise_rounding<typename Kernel::Number>(P.diagonal(), noise_of_a_step()) > kNoiseLost) {
      detectors_.note_noise_lost();
    }
  }

  Estimate estimate() const override { return filter_.estimate(); }
  std::optional<ErrorMatrix> covariance() const override { return filter_.covariance(); }
  Reports reported() const override { return detectors_.reports(); }

 private:
  static constexpr double kNoiseLost = 0.5;

  /// Half of what one propagation adds, as it is added before Phi and after.
  ErrorVector noise_of_a_step() const {
    const double interval_s = filter_.inertial().config().covariance_interval_s;
    return noise_variance(filter_.inertial().noise(), 0.5 * std::max(interval_s, step_s_));
  }

  BasicEkf<Kernel, Error> filter_;
  FixTrust trust_;
  CommonDetectors detectors_;
  double step_s_{0.0};  // of the newest increment
};

}  // namespace leeway::sim
