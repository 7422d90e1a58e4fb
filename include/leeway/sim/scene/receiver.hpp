/// @file
/// A GNSS receiver in a scene: its error model, and now and then an outlier.
#pragma once

#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

/// A receiver, asked at ascending times. Outages and latency are the caller's.
class Receiver {
 public:
  /// @throws Error when the error model is not valid or the trajectory has no motion.
  Receiver(const Trajectory& trajectory, const GnssScenario& gnss, std::uint64_t seed)
      : simulator_(trajectory, gnss.errors, Random(seed, 0, kGnssStream)),
        outliers_(seed, 0, kOutlierStream),
        outlier_probability_(gnss.outlier_probability),
        outlier_sigma_m_(gnss.outlier_sigma_m) {}

  /// A fix at a time in s; the covariance reported does not know of an outlier.
  /// @throws Error as GnssSimulator does.
  GnssFix fix_at(double t_s) {
    GnssFix fix = simulator_.fix_at(t_s);
    if (outlier_probability_ > 0.0 && outliers_.uniform() < outlier_probability_) {
      fix.position->r_e_m += outlier_sigma_m_ * outliers_.normal3();
    }
    return fix;
  }

 private:
  GnssSimulator simulator_;
  Random outliers_;
  double outlier_probability_;
  double outlier_sigma_m_;
};

}  // namespace leeway::sim
