/// @file
/// What the innovations say of a sensor's claimed noise.
#pragma once

#include <cstdint>

namespace leeway {

/// A factor on the standard deviations that a receiver claims, learned from the normalized
/// innovations: up to 10 when it is over-confident, down to a half when it is modest. Within a band
/// around 1 of their mean the claim is left alone. Not further down: errors that are alike from fix
/// to fix look small in the innovations, and are not (docs/theory/fix_monitor.md).
class NoiseScale {
 public:
  double sigma_scale() const { return sigma_scale_; }

  /// Mean of nis / dof over the last 30 fixes or so, by the scaled claim; 1 before any.
  double nis_ratio() const { return nis_ratio_; }

  /// Of a fix judged with the present scale, fused or gated.
  void note(double nis, int dof);

  template <class Archive>
  void visit(Archive& archive) {
    archive(sigma_scale_, nis_ratio_, count_);
  }

 private:
  double sigma_scale_{1.0};
  double nis_ratio_{1.0};
  std::int64_t count_{0};
};

}  // namespace leeway
