#include <spdlog/fmt/fmt.h>

#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "sim/atlas/free_run.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kFloatRunS = 60.0;

/// 20 m/s on a circle of 100 m: the reference vector circle20.
const Trajectory& float_drive() {
  static const Trajectory kDrive = circle20();
  return kDrive;
}

Eigen::Vector3d in_float(const Eigen::Vector3d& v) { return v.cast<float>().cast<double>(); }

/// What a step leaves in single precision.
using Rounding = void (*)(NavState& nav, const NavState& start);

double rounded_run_error_m(const std::vector<ImuIncrement>& increments, Rounding rounding) {
  const NavState start = truth_at(float_drive(), 0.0).nav;
  NavState nav = start;
  ImuHistory history;
  for (const ImuIncrement& inc : increments) {
    strapdown_step(nav, inc, history);
    rounding(nav, start);
  }
  return horizontal_error_m(truth_at(float_drive(), kFloatRunS).nav, nav);
}

std::vector<AtlasCell> run_float_position(const AtlasOptions& options) {
  const auto rates_hz =
      options.brief ? std::vector{10.0, 100.0} : std::vector{1.0, 10.0, 50.0, 100.0, 400.0};
  const NavState truth = truth_at(float_drive(), kFloatRunS).nav;
  return cells_over(rates_hz, [&](double rate_hz) {
    const auto increments = true_increments(float_drive(), rate_hz, kFloatRunS);
    const std::string condition = fmt::format("{:g} Hz", rate_hz);
    std::vector<AtlasCell> cells{
        free_run(Scheme::kTwoSample, condition, truth_at(float_drive(), 0.0).nav, increments,
                 [&truth](const NavState& nav) { return horizontal_error_m(truth, nav); })};
    cells.front().variant = "two-sample/double";
    const auto add = [&](const char* variant, Rounding rounding) {
      cells.push_back({AtlasGroup::kNotOffered, variant, condition,
                       rounded_run_error_m(increments, rounding)});
    };
    add("position/float",
        [](NavState& nav, const NavState&) { nav.r_e_m = in_float(nav.r_e_m); });
    add("position and velocity/float", [](NavState& nav, const NavState&) {
      nav.r_e_m = in_float(nav.r_e_m);
      nav.v_e_mps = in_float(nav.v_e_mps);
    });
    // Metres from a place nearby.
    add("offset from a place nearby/float", [](NavState& nav, const NavState& start) {
      nav.r_e_m = start.r_e_m + in_float(nav.r_e_m - start.r_e_m);
    });
    return cells;
  });
}

}  // namespace

AtlasScene float_position() {
  return {.place = 240,
          .key = "float-position",
          .title = "Earth-fixed position in single precision",
          .figure = "horizontal error after 60 s",
          .unit = "m",
          .limits = {0.1, 1.0,
                     "0.1 m is what no GNSS receiver without carrier phase would see; a metre "
                     "after a minute is what the sensors of a car-grade IMU cost"},
          .run = run_float_position};
}

}  // namespace leeway::sim::scenes
