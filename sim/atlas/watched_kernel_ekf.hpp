/// @file
/// KernelEkf over any kernel, watched: also over kernels that only a scene has.
#pragma once

#include <utility>

#include "leeway/alternatives/kernel_ekf.hpp"
#include "leeway/alternatives/nis_monitor.hpp"
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

/// KernelEkf of any kind.
template <class Filter>
class WatchedKernelEkf final : public WatchedFilter {
 public:
  WatchedKernelEkf(Filter filter, const ImuErrorModel& imu)
      : filter_(std::move(filter)), detectors_(imu) {}

  void predict(const ImuIncrement& inc) override { filter_.predict(inc); }

  void update(const GnssFix& fix) override {
    const FusedFix fused = filter_.update(fix);
    if (fused.dof == 0) return detectors_.note_unusable();
    detectors_.note_nis(fused.nis, fused.dof);
    detectors_.note(fix, filter_.estimate(), filter_.covariance());
    if (filter_.noise_rounding() > kNoiseLost) detectors_.note_noise_lost();
  }

  Estimate estimate() const override { return filter_.estimate(); }
  std::optional<ErrorMatrix> covariance() const override { return filter_.covariance(); }
  Reports reported() const override { return detectors_.reports(); }

 private:
  static constexpr double kNoiseLost = 0.5;

  Filter filter_;
  CommonDetectors detectors_;
};

}  // namespace leeway::sim
