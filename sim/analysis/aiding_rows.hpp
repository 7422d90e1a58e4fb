/// @file
/// What the vehicle itself tells over a step of a scene, as linear analyses take it: the rows of
/// its constraints and sensors in units of what the filter takes for their noise.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "leeway/ekf/update_outcome.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/model/vehicle_state.hpp"
#include "leeway/sim/analysis/scene_tracks.hpp"
#include "leeway/sim/scene/scene.hpp"
#include "sim/analysis/fix_rows.hpp"
#include "sim/analysis/motion_samples.hpp"

namespace leeway::sim {

/// One row. innovation = h x + per_sigma * (error of the sensor).
struct AidingRow {
  RowKind kind{};
  double per_sigma{};
  JointVector h{JointVector::Zero()};  ///< of the 15 errors and the vehicle's parameters
  Held held{Held::kNothing};
};

/// The vehicle aiding of a scene's navigator, without noise in its decisions: where the truth rests
/// the vehicle is at rest. Sampled once, at the ends of steps. Measurements of a step count as one
/// at its end, with the noise of their mean.
class SceneAiding {
 public:
  SceneAiding(const Scene& scene, std::shared_ptr<const MotionSamples> motion,
              const RestsAt& rests_at = {});

  bool has_rows() const { return !rows_.empty(); }

  /// The rows of the step that ends at this time; none between the ends of steps.
  std::span<const AidingRow> rows(double end_s) const;

  /// Whether the truth has been at rest, as long as the navigator takes to see it.
  bool rests(double t_s) const { return sample_at(t_s).rests; }

  /// How long, s, no horizontal acceleration has been more than that of a tilt.
  double even_s(double t_s) const { return sample_at(t_s).even_s; }

  /// The truth at the last end of a step.
  Estimate truth(double t_s) const { return {ends_[index_at(t_s)].nav, {}}; }

 private:
  struct Sample {
    bool rests{};
    float even_s{};
    std::uint32_t first_row{};
  };

  std::size_t index_at(double t_s) const;
  const Sample& sample_at(double t_s) const { return samples_[index_at(t_s)]; }
  void add_rows(const Scene& scene, const TruthPoint& truth);
  void add(RowKind kind, const Measurement& m, double interval_s, double seconds, Held held);
  void add_constraints(const Scene& scene, const TruthPoint& truth);
  void add_sensors(const Scene& scene, const TruthPoint& truth);

  std::shared_ptr<const MotionSamples> motion_;
  const std::vector<TruthPoint>& ends_;
  double step_s_;
  VehicleVector believed_{VehicleVector::Zero()};
  std::vector<Sample> samples_{};
  std::vector<AidingRow> rows_{};
};

}  // namespace leeway::sim
