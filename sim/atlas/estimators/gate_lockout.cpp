#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kShockS = 60.0;     // for one second from here ..
constexpr double kShockMps2 = 50.0;  // .. the accelerometers read so much too much

void add_shock(RecordedTrial& trial) {
  for (ImuIncrement& inc : trial.imu) {
    const double t_s = to_seconds(inc.time);
    if (t_s > kShockS && t_s < kShockS + 1.0) inc.dv_b_mps.x() += kShockMps2 * inc.dt_s;
  }
}

std::vector<AtlasCell> run_gate_lockout(const AtlasOptions& options) {
  const Scene scene = drive_scene(circle({.duration_s = 150.0}), 50.0);
  auto trials = recorded_trials(scene, options.brief ? 2 : 8);
  for (RecordedTrial& trial : trials) add_shock(trial);
  return scored(few_atlas_columns(), scene.filter, trials, {},
                score_after(kShockS + 60.0, &ErrorSums::horizontal_rms_m));
}

}  // namespace

AtlasScene gate_lockout() {
  return {.place = 100,
          .key = "gate-lockout",
          .title = "A gate that refuses right fixes",
          .figure = "RMS horizontal error before fixes, from a minute after the shock",
          .unit = "m",
          .limits = {8.0, 80.0,
                     "fixes of 2.5 m every second keep an unhurt filter within 3 sigma; ten times "
                     "as much is of no use on a road"},
          .run = run_gate_lockout};
}

}  // namespace leeway::sim::scenes
