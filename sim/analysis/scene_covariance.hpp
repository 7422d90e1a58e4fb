/// @file
/// The covariance that a scene's filter claims and the true one, side by side. Part of
/// covariance_analysis.
#pragma once

#include <optional>

#include "leeway/model/process_noise.hpp"
#include "sim/analysis/truth_model.hpp"

namespace leeway::sim {

class SceneCovariance {
 public:
  /// At the scene's start. @param by_source  keeps the sources apart, for error_budget()
  SceneCovariance(const Scene& scene, bool by_source);

  void propagate(const Leg& leg);

  /// Takes the fix into both with the filter's gains.
  void update(const FixRows& fix);

  const ErrorMatrix& claimed() const { return P_; }
  ErrorMatrix truth() const { return truth_ ? truth_->covariance() : P_; }

  /// @pre made by source.
  ErrorBudget error_budget(const Eigen::Matrix3d& C_en) const { return truth_->error_budget(C_en); }

 private:
  ImuErrorModel imu_;
  ProcessNoise noise_;
  ErrorMatrix P_;
  std::optional<TruthModel<1>> truth_;  // none: the filter knows all there is, P is the truth
};

}  // namespace leeway::sim
