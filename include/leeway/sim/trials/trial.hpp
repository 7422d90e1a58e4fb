/// @file
/// One nonlinear run of a scene: its estimator on simulated sensors, compared with the truth just
/// before fixes are used, where the interval between them shows.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "leeway/model/initial_covariance.hpp"
#include "leeway/sim/scene/scene.hpp"
#include "leeway/sim/sensors/true_increments.hpp"

namespace leeway::sim {

/// Plan of a scene's trials: what all of them share. Safe to share between threads.
class TrialPlan {
 public:
  /// A fix at the end of increment `at`, the one nearest to its time, that reaches the filter at
  /// the end of increment `arrives`.
  struct Fix {
    std::size_t at{};
    std::size_t arrives{};
    bool scored{};
  };

  /// @param score_last_s  fixes that arrive this close to the scene's end are scored; absent:
  ///                      scored_part_s(scene)
  /// @param threads       that compute the true increments; 0: as many as there are processors
  /// @throws Error when the scene is invalid, is shorter than two GNSS intervals, has fixes closer
  /// together than IMU increments, or none to score.
  explicit TrialPlan(const Scene& scene, std::optional<double> score_last_s = {}, int threads = 0);

  const Scene& scene() const { return scene_; }
  const TrueIncrements& increments() const { return increments_; }
  const std::vector<Fix>& fixes() const { return fixes_; }
  const InitialSigma& initial() const { return initial_; }

 private:
  Scene scene_;
  TrueIncrements increments_;
  std::vector<Fix> fixes_;
  InitialSigma initial_;
};

/// Sums over the scored fixes of one trial, of the error before the fix is used: at its arrival,
/// without it. Every fix is fused at its own time; with latency, a fix that comes while another is
/// on its way is not scored.
struct TrialScore {
  std::uint64_t seed{};
  std::int64_t epochs{0};
  Eigen::Vector3d error_sq_n_m2{Eigen::Vector3d::Zero()};  ///< squared north, east, down error
  Eigen::Vector3d variance_n_m2{Eigen::Vector3d::Zero()};  ///< what the filter claims for it
  double nees{0.0};                                        ///< 15 states
  double nis{0.0};                                         ///< of fused fixes
  std::int64_t nis_dof{0};
  std::int64_t beyond_r95{0};     ///< epochs with an error beyond the claimed R95 radius
  double largest_horizontal_m{};  ///< error
  /// A horizontal error beyond ten sigmas of the claim, which an honest filter makes once in 1e21
  /// epochs; no solution when a fix that is scored arrives; or not finite.
  bool diverged{false};
  bool finite{true};  ///< and P positive; else the trial ended early and its sums are worth nothing
  std::int64_t fused{0};  ///< fixes of the whole run
  std::int64_t gated{0};
};

/// A moment just before a fix is used, at the fix's own time whatever the latency.
struct TrialEpoch {
  double t_s{};
  double error_h_m{};      ///< infinite, as the claim, where there is no solution yet
  double claimed_r95_m{};  ///< the radius that 95 % of such errors stay within, says the filter
  Eigen::Vector3d error_n_m{Eigen::Vector3d::Zero()};  ///< north, east, down; infinite likewise
};

/// The score of one trial. The filter is told scene.filter and starts from its known biases, zero
/// spread bias, and a start error drawn from initial_sigma(scene); the sensors are scene.imu. A
/// navigator (scene.estimator) is told navigator_config(scene), and aligns by itself unless the
/// scene has start errors; of it fused fixes are told as they arrive. Same plan and seed, same
/// bits.
/// @param observer  called before every fix, scored or not
TrialScore run_trial(const TrialPlan& plan, std::uint64_t seed,
                     const std::function<void(const TrialEpoch&)>& observer = {});

}  // namespace leeway::sim
