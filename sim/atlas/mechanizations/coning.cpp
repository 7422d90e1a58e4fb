#include <numbers>

#include "leeway/earth/rotation.hpp"
#include "sim/atlas/free_run.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kConingRad = 0.1 * kRadPerDeg;

/// The body's axes draw cones of this half angle.
LocalMotion coning_motion(double frequency_hz, double t_s) {
  const Jet phase = 2.0 * std::numbers::pi * frequency_hz * time_jet(t_s);
  LocalMotion m;
  m.roll_rad = kConingRad * sin(phase);
  m.pitch_rad = kConingRad * cos(phase);
  return m;
}

double drift_deg_per_h(const NavState& truth, const NavState& nav, double t_s) {
  return attitude_error_e_rad(truth, nav).norm() / t_s / kRadPerDeg * 3600.0;
}

}  // namespace

AtlasScene coning() {
  return {
      .place = 250,
      .key = "coning",
      .title = "Coning vibration",
      .figure = "drift of the attitude",
      .unit = "deg/h",
      .limits =
          {1.0, 10.0,
           "1 deg/h is what a tactical gyro drifts by itself, 10 deg/h what a good MEMS gyro does"},
      .run = [](const AtlasOptions& options) {
        return vibration_cells(coning_motion, drift_deg_per_h, options);
      }};
}

}  // namespace leeway::sim::scenes
