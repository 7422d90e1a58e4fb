/// @file
/// Whether a filter has settled: its sigmas repeat from one part of the scene to the next. Part of
/// covariance_analysis.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "leeway/model/error_state.hpp"
#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

/// Claimed, then true.
using Variances = Eigen::Array<double, 2 * kErrorStates, 1>;

/// The variances just before a fix.
struct VariancesBefore {
  double t_s{};
  double arrival_s{};
  Variances variances{Variances::Zero()};
};

/// Which stretch of the scene a fix belongs to, counted back from the end. One on the border of
/// two counts for the later one.
inline long stretch_of(const Scene& scene, double arrival_s, double length_s) {
  const double left = (scene.duration_s - arrival_s) / length_s;
  return std::max(0L, static_cast<long>(std::ceil(left - 1e-9)) - 1);
}

class Settling {
 public:
  explicit Settling(const Scene& scene) : scene_(scene), window_s_(repeating_part_s(scene)) {}

  double window_s() const { return window_s_; }

  void see(const VariancesBefore& fix) {
    const long index = stretch_of(scene_, fix.arrival_s, window_s_);
    if (index != window_.index) {
      if (window_.index >= 0) {
        compare_with_previous(fix.t_s);
        previous_ = window_.largest;
      }
      window_ = Window{index};
    }
    window_.largest = window_.largest.max(fix.variances);
  }

  void forget() {
    window_ = Window{};
    previous_.reset();
  }

  /// The last part ends. @returns since when they repeat
  std::optional<double> finish(double t_s) {
    compare_with_previous(t_s);
    return settled_s_;
  }

 private:
  static constexpr double kSettledRelative = 1e-3;

  /// The extremes of a stretch of the scene.
  struct Window {
    long index{-1};  // counted back from the end
    Variances largest{Variances::Zero()};
  };

  void compare_with_previous(double t_s) {
    // Variances change twice as much as sigmas.
    const bool repeats =
        previous_ &&
        ((window_.largest - *previous_).abs() <= 2.0 * kSettledRelative * *previous_).all();
    if (!repeats) settled_s_.reset();
    if (repeats && !settled_s_) settled_s_ = t_s;
  }

  const Scene& scene_;
  double window_s_;
  Window window_{};
  std::optional<Variances> previous_{};
  std::optional<double> settled_s_{};
};

}  // namespace leeway::sim
