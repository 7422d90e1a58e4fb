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

/// BasicEkf over any kernel, with any error.
template <class Kernel, class Error>
class WatchedEkf final : public WatchedFilter {
 public:
  explicit WatchedEkf(const BasicEkf<Kernel, Error>& filter, const FixTrust& trust = {})
      : filter_(filter), trust_(trust) {}

  void predict(const ImuIncrement& inc) override {
    filter_.predict(inc);
    step_s_ = inc.dt_s;
  }

  void update(const GnssFix& fix) override {
    const UpdateOutcome outcome = filter_.update(fix, trust_);
    note(outcome.dof == 0, "fix unusable");
    if (outcome.dof == 0) return;
    note(outcome.outcome == UpdateOutcome::Outcome::kGated, "gated");
    if (outcome.covariance_positive) nis_.note(outcome.nis, outcome.dof);
    const ErrorMatrix P = filter_.covariance();
    note_claim(fix, P);
    note(outcome.outcome == UpdateOutcome::Outcome::kFused &&
             noise_rounding<typename Kernel::Number>(P.diagonal(), noise_of_a_step()) > kNoiseLost,
         "noise lost");
  }

  Estimate estimate() const override { return filter_.estimate(); }
  std::optional<ErrorMatrix> covariance() const override { return filter_.covariance(); }

  Reports reported() const override {
    Reports all = reports_;
    if (nis_.is_high()) all.insert("NIS high");
    if (nis_.is_low()) all.insert("NIS low");
    return all;
  }

 private:
  static constexpr double kNoiseLost = 0.5;

  void note(bool is_so, const char* what) {
    if (is_so) reports_.insert(what);
  }

  void note_claim(const GnssFix& fix, const ErrorMatrix& P) {
    constexpr double kOneFilterRad = HeadingBank::kOneFilterRad;
    const bool at_rest =
        fix.velocity && fix.velocity->v_e_mps.norm() < AlignmentConfig{}.rest_speed_mps;
    const Estimate& estimate = filter_.estimate();
    note(!is_positive_definite(P), "P not positive");
    note(heading_variance_rad2(estimate, P) > kOneFilterRad * kOneFilterRad, "heading too open");
    note(at_rest && rest_hides_heading(filter_.inertial().config().imu, estimate, P),
         "rest hides heading");
  }

  /// Half of what one propagation adds, as it is added before Phi and after.
  ErrorVector noise_of_a_step() const {
    const double interval_s = filter_.inertial().config().covariance_interval_s;
    return noise_variance(filter_.inertial().noise(), 0.5 * std::max(interval_s, step_s_));
  }

  BasicEkf<Kernel, Error> filter_;
  FixTrust trust_;
  NisMonitor nis_{};
  Reports reports_{};
  double step_s_{0.0};  // of the newest increment
};

}  // namespace leeway::sim
