#include <numbers>

#include "leeway/earth/rotation.hpp"
#include "sim/atlas/free_run.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kScullingRad = 0.2 * kRadPerDeg;
constexpr double kScullingMps2 = 20.0;

/// Rolls and swings sideways in phase: the force has a mean upwards in the body's axes, none in
/// level ones.
LocalMotion sculling_motion(double frequency_hz, double t_s) {
  const double omega_radps = 2.0 * std::numbers::pi * frequency_hz;
  const Jet swing = sin(omega_radps * time_jet(t_s));
  LocalMotion m;
  m.roll_rad = kScullingRad * swing;
  m.east_m = -kScullingMps2 / (omega_radps * omega_radps) * swing;
  return m;
}

double force_error_mg(const NavState& truth, const NavState& nav, double t_s) {
  return (truth.v_e_mps - nav.v_e_mps).norm() / t_s / kStandardGravityMps2 * 1e3;
}

}  // namespace

AtlasScene sculling() {
  return {.place = 260,
          .key = "sculling",
          .title = "Sculling vibration",
          .figure = "error of the mean acceleration",
          .unit = "mg",
          .limits = {0.1, 1.0,
                     "0.1 mg is the bias of an accelerometer between tactical and aviation grade, "
                     "1 mg that of a tactical one"},
          .run = [](const AtlasOptions& options) {
            return vibration_cells(sculling_motion, force_error_mg, options);
          }};
}

}  // namespace leeway::sim::scenes
