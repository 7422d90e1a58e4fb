/// @file
/// What the vehicle itself tells over a step of a scene, as linear analyses take it: the rows of its
/// constraints and sensors in units of what the filter takes for their noise.
#pragma once

#include <vector>

#include "leeway/ekf/update_outcome.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/model/vehicle_state.hpp"
#include "leeway/sim/scene/scene.hpp"
#include "sim/analysis/fix_rows.hpp"

namespace leeway::sim {

/// One row. innovation = h x + per_sigma * (error of the sensor).
struct AidingRow {
  RowKind kind{};
  double per_sigma{};
  JointVector h{JointVector::Zero()};  ///< of the 15 errors and the vehicle's parameters
  Held held{Held::kNothing};
};

/// The vehicle aiding of a scene's navigator, without noise in its decisions: where the truth rests
/// the vehicle is at rest. Measurements of a step count as one at its end, with the noise of their
/// mean.
class SceneAiding {
 public:
  /// @pre scene.vehicle
  explicit SceneAiding(const Scene& scene);

  /// Whether anything is told at all.
  bool any() const;

  /// The rows of a step that ends at to_s.
  std::vector<AidingRow> rows(double from_s, double to_s) const;

 private:
  const Scene& scene_;
  const VehicleConfig& config_;
  VehicleVector believed_;
};

/// Whether the truth has been at rest, as long as the navigator takes to see it.
bool rests(const Trajectory& trajectory, double t_s);

}  // namespace leeway::sim
