/// Prints the states and sigmas of a drive, for check.sh to compare with the committed ones: once
/// by the navigator, which has to find its heading, once by the filter alone, from a known start.
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/navigator/navigator.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/true_increments.hpp"
#include "tests/filters/navigator/recording.hpp"

namespace leeway {
namespace {

constexpr double kDurationS = 200.0;
constexpr double kRateHz = 50.0;
constexpr double kEpochS = 4.0;

/// Writes the rows. Positions are from where the drive starts: the digits of an ECEF position are
/// the Earth's.
class Trace {
 public:
  Trace() {
    std::printf(
        "source,time_s,north_m,east_m,down_m,v_north_mps,v_east_mps,v_down_mps,q_x,q_y,q_z,q_w,"
        "b_a_x_mps2,b_a_y_mps2,b_a_z_mps2,b_g_x_radps,b_g_y_radps,b_g_z_radps");
    for (const char* block : {"attitude", "velocity", "position", "b_a", "b_g"}) {
      for (const char axis : {'1', '2', '3'}) std::printf(",sigma_%s_%c", block, axis);
    }
    std::printf("\n");
  }

  /// At the epochs, every kEpochS, and between them nothing.
  bool is_epoch(Time time) const {
    return std::abs(std::remainder(to_seconds(time), kEpochS)) < 0.5 / kRateHz;
  }

  void print(const Navigator& navigator) const {
    const Solution s = navigator.solution();
    print("navigator", {s.nav, {s.b_a_mps2, s.b_g_radps}},
          {s.sigma_attitude_rad, s.sigma_velocity_n_mps, s.sigma_position_n_m, s.sigma_b_a_mps2,
           s.sigma_b_g_radps});
  }

  /// The sigmas of the error state itself, in its own order and axes.
  void print(const Ekf& filter) const {
    const ErrorVector sigma = filter.covariance().diagonal().cwiseSqrt();
    std::array<Eigen::Vector3d, 5> blocks;
    for (int i = 0; i < 5; ++i) blocks[static_cast<std::size_t>(i)] = sigma.segment<3>(3 * i);
    print("ekf", filter.estimate(), blocks);
  }

 private:
  void print(const char* source, const Estimate& estimate,
             const std::array<Eigen::Vector3d, 5>& sigmas) const {
    const NavState& nav = estimate.nav;
    std::printf("%s,%.0f", source, to_seconds(nav.time));
    print(plane_.C_el.transpose() * (nav.r_e_m - plane_.origin_e_m));
    print(plane_.C_el.transpose() * nav.v_e_mps);
    const double sign = nav.q_eb.w() < 0.0 ? -1.0 : 1.0;
    print(sign * nav.q_eb.vec());
    std::printf(",%.17g", sign * nav.q_eb.w());
    print(estimate.bias.b_a_mps2);
    print(estimate.bias.b_g_radps);
    for (const Eigen::Vector3d& sigma : sigmas) print(sigma);
    std::printf("\n");
  }

  static void print(const Eigen::Vector3d& v) {
    std::printf(",%.17g,%.17g,%.17g", v.x(), v.y(), v.z());
  }

  sim::TangentPlane plane_{sim::CarDriveParameters{}.origin};
};

/// Half a minute at rest, turns, stops; no fixes in the half minute from 120 s on.
test::Recording drive(const sim::Trajectory& trajectory) {
  test::Recording log =
      test::record(trajectory, sim::true_increments(trajectory, kRateHz, kDurationS),
                   automotive_mems_model(), {}, 1.0, 0.5, 1);
  std::erase_if(log.fixes, [](const GnssFix& fix) {
    const double t_s = to_seconds(fix.time);
    return t_s > 120.0 && t_s < 150.0;
  });
  return log;
}

/// Calls push(fix) and push(increment) in the order of time, then print.
template <class Push, class Print>
void play(const test::Recording& log, Push&& push, Print&& print) {
  auto fix = log.fixes.begin();
  for (const ImuIncrement& inc : log.imu) {
    push(inc);
    while (fix != log.fixes.end() && fix->time <= inc.time) push(*fix++);
    print(inc.time);
  }
}

/// At rest the navigator cannot know its heading: it drives off with a bank of them.
void trace_navigator(const Trace& trace, const test::Recording& log) {
  NavigatorConfig config;
  config.vehicle.zero_velocity = true;
  config.vehicle.zero_angular_rate = true;
  config.vehicle.non_holonomic = true;
  Navigator navigator(config);
  play(
      log, [&](const auto& input) { navigator.push(input); },
      [&](Time time) {
        if (navigator.aligned() && trace.is_epoch(time)) trace.print(navigator);
      });
}

void predict_or_update(Ekf& filter, const ImuIncrement& inc) { filter.predict(inc); }
void predict_or_update(Ekf& filter, const GnssFix& fix) { filter.update(fix); }

void trace_filter(const Trace& trace, const sim::Trajectory& trajectory,
                  const test::Recording& log) {
  const EkfConfig config;
  const Estimate start = test::truth_estimate(trajectory, 0.0);
  Ekf filter(config, start, initial_covariance(start, {0.01, 0.05, 0.1, 3.0}, config.imu));
  play(
      log, [&](const auto& input) { predict_or_update(filter, input); },
      [&](Time time) {
        if (trace.is_epoch(time)) trace.print(filter);
      });
}

void trace_all() {
  const Trace trace;
  const sim::Trajectory trajectory = sim::car_drive();
  const test::Recording log = drive(trajectory);
  trace_navigator(trace, log);
  trace_filter(trace, trajectory, log);
}

}  // namespace
}  // namespace leeway

int main() { leeway::trace_all(); }
