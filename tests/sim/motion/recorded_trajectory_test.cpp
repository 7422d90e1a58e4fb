#include "leeway/sim/motion/recorded_trajectory.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/logs/truth_log.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/motion/waypoints.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/sim/tools/random.hpp"
#include "leeway/strapdown/strapdown.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::sim {
namespace {

using test::contains;
using test::near;
using test::TempDir;

struct LogShape {
  double rate_hz{20.0};
  double noise_m{0.0};
  bool attitude{true};
};

void write_log(const std::filesystem::path& path, const Trajectory& trajectory, LogShape shape) {
  TruthLogWriter writer(path);
  Random random(1);
  const int rows = static_cast<int>(trajectory.duration_s * shape.rate_hz);
  for (int k = 0; k <= rows; ++k) {
    NavState nav = truth_at(trajectory, k / shape.rate_hz).nav;
    nav.r_e_m += shape.noise_m * random.normal3();
    writer.write({ned_from_nav_state(nav), true, shape.attitude});
  }
  writer.close();
}

struct Agreement {
  double position_m{0.0};
  double velocity_mps{0.0};
  double attitude_rad{0.0};
  double force_rms_mps2{0.0};
  double rate_rms_radps{0.0};
};

/// Largest differences, and of the rates the root mean square; without the ends.
Agreement compare(const Trajectory& a, const Trajectory& b) {
  Agreement worst;
  int count = 0;
  for (double t_s = 5.0; t_s < a.duration_s - 5.0; t_s += 0.037, ++count) {
    const TruthPoint p = truth_at(a, t_s);
    const TruthPoint q = truth_at(b, t_s);
    worst.position_m = std::max(worst.position_m, (p.nav.r_e_m - q.nav.r_e_m).norm());
    worst.velocity_mps = std::max(worst.velocity_mps, (p.nav.v_e_mps - q.nav.v_e_mps).norm());
    worst.attitude_rad =
        std::max(worst.attitude_rad, log_quaternion(p.nav.q_eb.conjugate() * q.nav.q_eb).norm());
    worst.force_rms_mps2 += (p.f_ib_b_mps2 - q.f_ib_b_mps2).squaredNorm();
    worst.rate_rms_radps += (p.omega_ib_b_radps - q.omega_ib_b_radps).squaredNorm();
  }
  worst.force_rms_mps2 = std::sqrt(worst.force_rms_mps2 / count);
  worst.rate_rms_radps = std::sqrt(worst.rate_rms_radps / count);
  return worst;
}

Trajectory drive() { return car_drive({.duration_s = 300.0}); }

std::string text_rows(int rows) {
  std::string text = "t_s,lat_deg,lon_deg,height_m\n";
  for (int k = 0; k < rows; ++k) {
    text += std::to_string(10.0 + 0.5 * k) + "," + std::to_string(50.0 + 1e-5 * k) + ",8.0,100\n";
  }
  return text;
}

std::string refusal(const std::string& text) {
  const TempDir dir;
  const auto path = dir.file("log.csv", text);
  return test::message_of<Error>([&path] { recorded_trajectory({.file = path}); });
}

}  // namespace

TEST_CASE("recorded: a simulated drive comes back from its truth log") {
  const TempDir dir;
  write_log(dir / "truth.csv", drive(), {});
  const Trajectory recorded = recorded_trajectory({.file = dir / "truth.csv", .smoothing_s = 0.25});
  CHECK(near(recorded.duration_s, 300.0, 1e-9));
  CHECK(!recorded.period_s.has_value());
  const Agreement a = compare(drive(), recorded);
  // The drive bumps at up to 1.1 Hz, which knots of 0.25 s (1 Hz) pass nearly.
  CHECK(a.position_m < 1e-4);
  CHECK(a.velocity_mps < 1e-3);
  CHECK(a.attitude_rad < 3e-4);
  CHECK(a.force_rms_mps2 < 2e-3);
  CHECK(a.rate_rms_radps < 1e-3);
}

TEST_CASE("recorded: noise of 2 cm at 10 Hz does not get into the specific force") {
  const TempDir dir;
  write_log(dir / "truth.csv", drive(), {10.0, 0.02, true});
  const Agreement a =
      compare(drive(), recorded_trajectory({.file = dir / "truth.csv", .smoothing_s = 1.0}));
  // Ten samples for a knot and axis; differenced twice the noise would make 2 cm / (0.1 s)^2 times
  // 2.4: 4.9 m/s^2.
  CHECK(a.position_m < 0.05);
  CHECK(a.velocity_mps < 0.08);
  CHECK(a.force_rms_mps2 < 0.15);
}

TEST_CASE("recorded: without attitude the body points along the path") {
  const TempDir dir;
  write_log(dir / "truth.csv", drive(), {20.0, 0.0, false});
  const Trajectory recorded = recorded_trajectory({.file = dir / "truth.csv", .smoothing_s = 0.5});
  const Agreement a = compare(drive(), recorded);
  // The drive rolls and pitches by up to 2.1 deg and 0.8 deg against its path, which a course does
  // not tell.
  CHECK(a.position_m < 0.01);
  CHECK(a.attitude_rad < 3.0 * kRadPerDeg);
  for (double t_s = 60.0; t_s < 290.0; t_s += 1.0) {
    CAPTURE(t_s);
    const NavStateNed here = ned_from_nav_state(truth_at(recorded, t_s).nav);
    const Eigen::Vector3d v = here.v_n_mps;
    CHECK(near(here.attitude.roll_rad, 0.0, 1e-6));
    if (v.norm() < 3.0) continue;
    CHECK(near(wrap_pi(here.attitude.yaw_rad - std::atan2(v.y(), v.x())), 0.0, 0.01));
    CHECK(near(here.attitude.pitch_rad, std::atan2(-v.z(), v.head<2>().norm()), 0.01));
  }
}

TEST_CASE("recorded: its true increments carry a strapdown along it") {
  const TempDir dir;
  write_log(dir / "truth.csv", drive(), {10.0, 0.02, true});
  const Trajectory recorded = recorded_trajectory({.file = dir / "truth.csv"});
  NavState state = truth_at(recorded, 0.0).nav;
  ImuHistory history;
  for (const ImuIncrement& inc : true_increments(recorded, 100.0, 200.0)) {
    strapdown_step<Scheme::kRungeKutta4>(state, inc, history);
  }
  const NavState truth = truth_at(recorded, 200.0).nav;
  // As for the built-in trajectories.
  CHECK(near(state.r_e_m, truth.r_e_m, 2e-5));
  CHECK(near(state.v_e_mps, truth.v_e_mps, 1e-7));
  CHECK(log_quaternion(truth.q_eb.conjugate() * state.q_eb).norm() < 1e-9);
}

TEST_CASE("recorded: a flight of 300 km keeps its height and levels with the Earth") {
  WaypointParameters flight;
  flight.waypoints = {{{0.8, 0.1, 10000.0}, 250.0, {}}, {{0.84, 0.13, 10000.0}, 250.0, {}}};
  const TempDir dir;
  write_log(dir / "truth.csv", waypoint_trajectory(flight), {1.0, 0.0, true});
  const Trajectory recorded = recorded_trajectory({.file = dir / "truth.csv", .smoothing_s = 5.0});
  for (double t_s = 0.0; t_s < recorded.duration_s; t_s += 10.0) {
    const NavStateNed here = ned_from_nav_state(truth_at(recorded, t_s).nav);
    CHECK(near(here.position.height_m, 10000.0, 1e-3));
    CHECK(near(here.attitude.pitch_rad, 0.0, 1e-6));
    CHECK(near(here.attitude.roll_rad, 0.0, 1e-6));
  }
}

TEST_CASE("recorded: holes up to the stated length are bridged, longer ones refused") {
  const TempDir dir;
  std::string text = text_rows(40);
  const std::size_t first = text.find("20.000000,");
  text.erase(first, text.find("24.000000,") - first);
  const auto path = dir.file("log.csv", text);
  CHECK(near(recorded_trajectory({.file = path, .max_gap_s = 5.0}).duration_s, 19.5, 1e-9));
  const std::string message =
      test::message_of<Error>([&path] { recorded_trajectory({.file = path}); });
  CHECK(contains(message, "log.csv: data line 21: a hole of 4.5 s"));
  CHECK(contains(message, "max_gap_s = 3"));
}

TEST_CASE("recorded: what is no usable log is refused by file and line") {
  CHECK(contains(refusal("a,b\n1,2\n"), "missing columns"));
  CHECK(contains(refusal(text_rows(4)), "4 rows are too few"));
  CHECK(contains(refusal(text_rows(20) + "x,50,8,100\n"), "log.csv:22:1:"));
  CHECK(contains(refusal(text_rows(20) + "21,-50,8,100\n"), "7000 km"));
  const TempDir dir;
  for (const auto& path : {dir / "none.csv", dir / ""}) {
    const std::string message =
        test::message_of<Error>([&path] { recorded_trajectory({.file = path}); });
    CHECK(contains(message, path.string()));
  }
  std::string mixed = "t_s,lat_deg,lon_deg,height_m,roll_deg,pitch_deg,yaw_deg\n";
  for (int k = 0; k < 20; ++k) {
    mixed += std::to_string(k) + ",50,8,100" + (k == 7 ? ",,,\n" : ",0,0,0\n");
  }
  CHECK(contains(refusal(mixed), "data line 8: attitude"));
  const auto path = dir.file("log.csv", text_rows(40));
  CHECK_THROWS_AS(recorded_trajectory({.file = path, .smoothing_s = 0.0}), Error);
  CHECK_THROWS_AS(recorded_trajectory({.file = path, .smoothing_s = 50.0}), Error);
}

}  // namespace leeway::sim
