#include "leeway/sim/scene/scene_file.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/sim/tools/random.hpp"
#include "leeway/strapdown/strapdown.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::sim {
namespace {

using test::contains;
using test::near;

const std::filesystem::path kScenes = LEEWAY_SCENES_DIR;

const std::string kImu = "[imu]\nclass = \"tactical\"\n";
const std::string kStill = "[trajectory]\ntype = \"static\"\n";

Scene parsed(const std::string& text) { return parse_scene(text, "scene.toml"); }

std::string scene_refusal(const std::string& text) {
  return test::message_of<Error>([&text] { parsed(text); });
}

std::vector<std::filesystem::path> ready_scenes() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

TEST_CASE("the defined case, moving and at rest, is the one of the reference") {
  for (const char* file : {"square-loop.toml", "static-45.toml"}) {
    CAPTURE(file);
    const Scene scene = read_scene(kScenes / file);
    const bool moves = std::string(file) == "square-loop.toml";
    CHECK(scene.duration_s == 14400.0);
    CHECK(scene.trajectory.plane.origin.lat_rad == 45.0 * kRadPerDeg);
    CHECK(scene.gnss.errors.position_sigma_n_m == Eigen::Vector3d(2.5, 2.5, 3.5));
    CHECK(scene.gnss.errors.velocity_sigma_n_mps == Eigen::Vector3d::Constant(0.05));
    CHECK(scene.gnss.errors.correlated_sigma_n_m.isZero(0.0));
    CHECK(scene.filter.gnss_correlation_s == 0.0);
    CHECK(scene.filter.gate_probability == 0.0);
    CHECK(scene.filter.lever_arm_b_m.isZero(0.0));
    CHECK(scene.filter.imu.gyro.bias_sigma == scene.imu.gyro.bias_sigma);
    CHECK(!scene.initial.has_value());
    CHECK(scene.gnss.outages.empty());
    // Four sides of 50 s and 10 s; a quarter turn in 10 s.
    const TruthPoint on_straight = truth_at(scene.trajectory, 20.0);
    const TruthPoint in_turn = truth_at(scene.trajectory, 55.0);
    CHECK(near(on_straight.nav.v_e_mps.norm(), moves ? 20.0 : 0.0, 1e-12));
    // Of the Earth's rotation 5e-5 rad/s is along down.
    CHECK(near(in_turn.omega_ib_b_radps.z(), moves ? 9.0 * kRadPerDeg : 0.0, 1e-4));
    CHECK(near(on_straight.omega_ib_b_radps.z(), 0.0, 1e-4));
  }
}

TEST_CASE("every ready scene is valid, and its true increments reproduce its truth" *
          doctest::test_suite("heavy")) {
  const auto paths = ready_scenes();
  CHECK(paths.size() == 14);
  for (const auto& path : paths) {
    CAPTURE(path.string());
    const Scene scene = read_scene(path);
    validate(scene);
    CHECK(!scene.name.empty());
    const double until_s = std::min(scene.duration_s, 120.0);
    NavState state = truth_at(scene.trajectory, 0.0).nav;
    ImuHistory history;
    for (const ImuIncrement& inc : true_increments(scene.trajectory, 100.0, until_s)) {
      strapdown_step<Scheme::kRungeKutta4>(state, inc, history);
    }
    const NavState truth = truth_at(scene.trajectory, to_seconds(state.time)).nav;
    // 12 000 steps rounded to 5e-10 m; a jump of the turn rate within the four increments that the
    // scheme looks at costs 1e-6 m/s, which the square loop has four times in 2 minutes.
    CHECK(near(state.r_e_m, truth.r_e_m, 1e-4));
    CHECK(near(state.v_e_mps, truth.v_e_mps, 4e-6));
    CHECK(log_quaternion(truth.q_eb.conjugate() * state.q_eb).norm() < 1e-8);
  }
}

TEST_CASE("a scene of the least keys has the defaults of the guide") {
  const Scene scene = parsed(kStill + kImu);
  CHECK(scene.name == "scene");
  CHECK(scene.duration_s == 3600.0);
  CHECK(scene.imu_rate_hz == 50.0);
  CHECK(scene.trials == 200);
  CHECK(scene.first_seed == 1);
  CHECK(scene.imu_name == "tactical/mid");
  CHECK(scene.gnss.interval_s == 1.0);
  CHECK(scene.gnss.latency_s == 0.0);
  CHECK(scene.gnss.outlier_probability == 0.0);
  CHECK(scene.filter.gnss_correlation_s == 0.0);
  CHECK(scene.filter.gate_probability == 1e-6);
  CHECK(scene.limit.metric == ErrorMetric::kDrms);
  CHECK(scene.limit.limit_m == 10.0);
}

TEST_CASE("what a scene says arrives, in SI") {
  const Scene scene = parsed(R"(
[scene]
name = "a name"
duration_min = 10
imu_rate_hz = 100
trials = 7
first_seed = 3
[trajectory]
type = "straight"
speed_km_per_h = 72
heading_deg = 90
[imu]
class = "marine"
range = "high"
bias = "gauss_markov"
bias_tau_h = 2
[gnss]
interval_ms = 200
position_sigma_ned_m = [1, 2, 3]
velocity_sigma_mps = [0.1, 0.2, 0.3]
correlated_sigma_h_m = 1.5
correlation_s = 45
latency_ms = 150
lever_arm_m = [1.0, -0.5, -2.0]
outlier_probability = 0.01
outlier_sigma_m = 30
outages = [{start_s = 60, duration_s = 30}, {start_min = 5, duration_min = 1}]
[filter]
gate_probability = 1e-4
covariance_interval_s = 1
scheme = "trapezoid"
gravity = "j2"
earth_rotation = false
[filter.imu]
class = "automotive-mems"
[initial]
tilt_mrad = 2
heading_deg = 3
velocity_mps = 0.5
position_m = 4
[limit]
metric = "r95"
limit_m = 25
)");
  CHECK(scene.name == "a name");
  CHECK(scene.duration_s == 600.0);
  CHECK(scene.trials == 7);
  CHECK(scene.first_seed == 3);
  const Eigen::Vector3d v_n_mps = ned_from_nav_state(truth_at(scene.trajectory, 0.0).nav).v_n_mps;
  CHECK(near(v_n_mps, Eigen::Vector3d(0.0, 20.0, 0.0), 1e-12));
  const ImuErrorModel marine = imu_class_model(ImuClass::kMarine, RangeEnd::kHigh);
  CHECK(scene.imu.gyro.bias_sigma == 0.0);
  CHECK(scene.imu.gyro.in_run.sigma == marine.gyro.bias_sigma);
  CHECK(scene.imu.accelerometer.in_run.sigma == marine.accelerometer.bias_sigma);
  CHECK(scene.imu.accelerometer.in_run.tau_s == 7200.0);
  CHECK(scene.imu.gyro.noise_density == marine.gyro.noise_density);
  CHECK(scene.filter.imu.gyro.bias_sigma == automotive_mems_model().gyro.bias_sigma);
  const GnssErrorModel& errors = scene.gnss.errors;
  CHECK(near(scene.gnss.interval_s, 0.2, 1e-16));
  CHECK(near(scene.gnss.latency_s, 0.15, 1e-16));
  CHECK(errors.position_sigma_n_m == Eigen::Vector3d(1.0, 2.0, 3.0));
  CHECK(errors.velocity_sigma_n_mps == Eigen::Vector3d(0.1, 0.2, 0.3));
  CHECK(errors.correlated_sigma_n_m == Eigen::Vector3d(1.5, 1.5, 0.0));
  CHECK(errors.correlation_time_s == 45.0);
  CHECK(errors.lever_arm_b_m == Eigen::Vector3d(1.0, -0.5, -2.0));
  CHECK(scene.filter.lever_arm_b_m == errors.lever_arm_b_m);
  CHECK(scene.filter.gnss_correlation_s == 45.0);
  CHECK(scene.gnss.outlier_probability == 0.01);
  CHECK(scene.gnss.outlier_sigma_m == 30.0);
  REQUIRE(scene.gnss.outages.size() == 2);
  CHECK(scene.gnss.outages[1].start_s == 300.0);
  CHECK(scene.gnss.outages[1].duration_s == 60.0);
  CHECK(scene.filter.gate_probability == 1e-4);
  CHECK(scene.filter.covariance_interval_s == 1.0);
  CHECK(scene.filter.strapdown.scheme == Scheme::kTrapezoid);
  CHECK(scene.filter.strapdown.gravity == GravityModel::kJ2);
  CHECK(scene.filter.strapdown.rotation == EarthRotation::kOff);
  REQUIRE(scene.initial.has_value());
  CHECK(scene.initial->tilt_rad == 2e-3);
  CHECK(near(scene.initial->heading_rad, 3.0 * kRadPerDeg, 1e-17));
  CHECK(scene.initial->velocity_mps == 0.5);
  CHECK(scene.initial->position_m == 4.0);
  CHECK(scene.limit.metric == ErrorMetric::kR95);
  CHECK(scene.limit.limit_m == 25.0);
}

TEST_CASE("[budget] is read as the old name of [limit], with a note") {
  const std::string text = kStill + kImu;
  std::vector<std::string> notes;
  CHECK(parse_scene(text + "[limit]\nlimit_m = 25\n", "s.toml", {}, &notes).limit.limit_m == 25.0);
  CHECK(notes.empty());
  CHECK(parse_scene(text + "[budget]\nlimit_m = 25\n", "s.toml", {}, &notes).limit.limit_m == 25.0);
  REQUIRE(notes.size() == 1);
  CHECK(notes.front() == "s.toml: [budget] is now called [limit]");
}

TEST_CASE("waypoints by latitude or by metres; what one leaves out is as at the one before") {
  const Scene scene = parsed(kImu + R"(
[trajectory]
type = "waypoints"
latitude_deg = 50
longitude_deg = 8
height_m = 300
[[trajectory.waypoint]]
north_m = 0
east_m = 0
speed_km_per_h = 36
[[trajectory.waypoint]]
north_m = 1000
east_m = 0
down_m = -20
[[trajectory.waypoint]]
latitude_deg = 50.02
longitude_deg = 8.02
stop_s = 0
)");
  CHECK(scene.duration_s == scene.trajectory.duration_s);
  const auto at = [&scene](double t_s) {
    return ned_from_nav_state(truth_at(scene.trajectory, t_s).nav);
  };
  CHECK(near(at(0.0).position.lat_rad, 50.0 * kRadPerDeg, 1e-15));
  CHECK(near(at(0.0).position.height_m, 300.0, 1e-8));
  CHECK(near(at(0.0).v_n_mps.norm(), 10.0, 0.02));
  const NavStateNed end = at(scene.duration_s);
  CHECK(near(end.position.lat_rad, 50.02 * kRadPerDeg, 1e-14));
  CHECK(near(end.position.height_m, 320.0, 1e-8));
  CHECK(near(end.v_n_mps.norm(), 0.0, 1e-12));
}

TEST_CASE("an IMU model is taken from a file beside the scene, or from the scene itself") {
  const test::TempDir dir;
  dir.file("model.toml", "[gyro]\nbias_sigma_deg_per_h = 36\n");
  const auto path = dir.file("scene.toml", kStill + "[imu]\nmodel = \"model.toml\"\n");
  const Scene scene = read_scene(path);
  CHECK(near(scene.imu.gyro.bias_sigma, 0.01 * kRadPerDeg, 1e-18));
  CHECK(scene.imu_name == "model.toml");
  const Scene own = parsed(kStill + "[imu.gyro]\nbias_sigma_deg_per_h = 36\n");
  CHECK(near(own.imu.gyro.bias_sigma, 0.01 * kRadPerDeg, 1e-18));
  const auto lost = dir.file("lost.toml", kStill + "[imu]\nmodel = \"none.toml\"\n");
  const std::string message = test::message_of<Error>([&lost] { read_scene(lost); });
  CHECK(contains(message, "lost.toml:4:9: 'model' cannot be used"));
  CHECK(contains(message, "none.toml"));
}

TEST_CASE("a recording is found beside the scene, and cannot be longer than it is") {
  const test::TempDir dir;
  std::string log = "t_s,lat_deg,lon_deg,height_m\n";
  for (int k = 0; k <= 40; ++k) {
    log += std::to_string(k) + "," + std::to_string(50.0 + 1e-4 * k) + ",8.0,100\n";
  }
  dir.file("log.csv", log);
  const std::string text = kImu + "[trajectory]\ntype = \"recorded\"\nfile = \"log.csv\"\n";
  const auto path = dir.file("scene.toml", text);
  const Scene scene = read_scene(path);
  CHECK(near(scene.duration_s, 40.0, 1e-12));
  // 1e-4 deg of latitude at 50 deg is 11.123 m.
  const NavStateNed here = ned_from_nav_state(truth_at(scene.trajectory, 20.0).nav);
  CHECK(near(here.v_n_mps, Eigen::Vector3d(11.123, 0.0, 0.0), 2e-3));
  CHECK(read_scene(path, 20.0).trajectory.duration_s == 20.0);
  const std::string longer = test::message_of<Error>([&path] { read_scene(path, 100.0); });
  CHECK(contains(longer, "scene.toml:5:8: 'file' ends after 40 s"));
  const std::string lost = scene_refusal(text);  // not beside this one
  CHECK(contains(lost, "scene.toml:5:8: 'file' cannot be used"));
  CHECK(contains(lost, "log.csv"));
}

TEST_CASE("a scene can be ended at another time") {
  const std::string text = "[scene]\nduration_s = 600\n" + kStill + kImu +
                           "[gnss]\noutages = [{start_s = 300, duration_s = 60}]\n";
  CHECK(parse_scene(text, "s").duration_s == 600.0);
  CHECK(parse_scene(text, "s", 86400.0).trajectory.duration_s == 86400.0);
  CHECK(parse_scene(text, "s", 100.0).gnss.outages.empty());
  CHECK(parse_scene(text, "s", 310.0).gnss.outages.size() == 1);
  CHECK_THROWS_AS(parse_scene(text, "s", 0.5), Error);
  const std::string route = kImu +
                            "[trajectory]\ntype = \"waypoints\"\n"
                            "waypoint = [{north_m = 0, east_m = 0, speed_mps = 10}, "
                            "{north_m = 1000, east_m = 0}]\n";
  // 1 km at 10 m/s.
  CHECK(near(parse_scene(route, "s").duration_s, 100.0, 0.2));
  CHECK(parse_scene(route, "s", 50.0).duration_s == 50.0);
  const std::string message = test::message_of<Error>([&route] { parse_scene(route, "s", 200.0); });
  CHECK(contains(message, "the route ends at"));
}

TEST_CASE("a limit as text, that grows with the way, or of a preset") {
  const auto limit_of = [](const std::string& section) {
    return parse_scene(kStill + kImu + "[limit]\n" + section, "s.toml").limit;
  };
  const ErrorLimit growing = limit_of("metric = \"along95\"\nlimit = \"5m+5%\"\nlast_s = 60\n");
  CHECK(growing.metric == ErrorMetric::kAlong95);
  CHECK(growing.allowed() == AllowedError(5.0, 0.05));
  CHECK(growing.last_s == 60.0);
  CHECK(growing.preset.empty());
  CHECK(limit_of("limit = \"7\"\n").allowed() == AllowedError(7.0));
  const ErrorLimit preset = limit_of("preset = \"imo-b\"\nlast_s = 60\n");
  CHECK(preset.metric == ErrorMetric::kR95);
  CHECK(preset.allowed() == AllowedError(10.0));
  CHECK(preset.preset == "imo-b");
  for (const ErrorMetric metric : kAll<ErrorMetric>) {
    CHECK(limit_of("metric = \"" + std::string(name(metric)) + "\"\n").metric == metric);
  }
}

TEST_CASE("mistakes in a scene are refused with line, column and what was meant") {
  const std::string all = kStill + kImu;
  const struct {
    std::string text;
    const char* where;
    const char* named;
  } cases[] = {
      {"", ":1:1", "needs [trajectory]"},
      {kStill, ":1:1", "needs [imu]"},
      {kImu, ":1:1", "needs [trajectory]"},
      {kStill + "[imu\n", ":3:", "scene.toml"},
      {all + "[gnas]\n", ":5:", "did you mean 'gnss'"},
      {"trajectory = 1\n" + kImu, ":1:14", "must be a section"},
      {"[trajectory]\ntype = \"sqare_loop\"\n" + kImu, ":2:8", "did you mean 'square-loop'"},
      {"[trajectory]\ntyp = \"static\"\n" + kImu, ":2:1", "did you mean 'type'"},
      {"[trajectory]\n" + kImu, ":1:1", "needs type"},
      {"[trajectory]\ntype = \"static\"\nspeed_mps = 3\n" + kImu, ":3:1", "unknown key"},
      // Slips of the unit.
      {"[trajectory]\ntype = \"straight\"\nspeed_mps = 900\n" + kImu, ":3:13", "'speed_km_per_h'"},
      {"[trajectory]\ntype = \"circle\"\nspeed_mps = 72\nradius_m = 10\n" + kImu, ":1:1", "km/h"},
      {"[scene]\nduration_s = 14400000\n" + all, ":2:14", "'duration_ms'"},
      {"[scene]\nduration = 60\n" + all, ":2:1", "needs its unit: duration_s"},
      {all + "[gnss]\nlatency_s = 200\n", ":6:13", "'latency_ms'"},
      {all + "[gnss]\nlever_arm_m = [120, 0, 0]\n", ":6:16", "'lever_arm_cm'"},
      {all + "[gnss]\nvelocity_sigma_mps = 50\n", ":6:22", "'velocity_sigma_km_per_h'"},
      {all + "[gnss]\nposition_sigma_h = 2.5\n", ":6:1", "position_sigma_h_m"},
      {all + "[gnss]\ninterval_s = 0\n", ":6:14", "is 0"},
      {all + "[gnss]\noutlier_probability = 5\n", ":6:23", "0 to 0.5"},
      {all + "[filter]\ngate_probability = 0.999\n", ":6:20", "0 to 0.1"},
      {all + "[initial]\ntilt_deg = 200\nheading_deg = 1\nvelocity_mps = 1\nposition_m = 1\n",
       ":6:12", "'tilt_mrad'"},
      {all + "[initial]\ntilt_deg = 1\n", ":5:1", "needs heading_deg"},
      {all + "[limit]\nmetric = \"cep\"\n", ":6:10", "drms"},
      {all + "[limit]\nlimit_m = -3\n", ":6:11", "is -3"},
      {all + "[limit]\nlimit = \"5 ft\"\n", ":6:9", "metres, as in 5 or 5m"},
      {all + "[limit]\nlimit = 5\n", ":6:9", "must be text in quotes"},
      {all + "[limit]\nlimit = \"5m\"\nlimit_m = 5\n", ":7:1", "give one"},
      {all + "[limit]\npreset = \"rnp-3\"\n", ":6:10", "rnp-0.3"},
      {all + "[limit]\npreset = \"rnp-1\"\nlimit_m = 5\n", ":6:10", "give it alone"},
      {all + "[limit]\npreset = \"rnp-1\"\nmetric = \"r95\"\n", ":6:10", "give it alone"},
      {"[scene]\ntrials = 0\n" + all, ":2:10", "from 1 to"},
      {"[scene]\nimu_rate_hz = 1e9\n" + all, ":2:15", "10000"},
      // Contradictions.
      {all + "[limit]\nlimit_m = 3\n[budget]\nlimit_m = 3\n", ":7:", "old name of [limit]"},
      {kStill + "[imu]\n", ":3:1", "an IMU is one of"},
      {kStill + "[imu]\nclass = \"marine\"\nmodel = \"m.toml\"\n", ":3:1", "an IMU is one of"},
      {kStill + "[imu]\nclass = \"marine\"\n[imu.gyro]\nbias_sigma_deg_per_h = 1\n", ":3:1",
       "an IMU is one of"},
      {kStill + "[imu]\nclass = \"automotive-mems\"\nrange = \"low\"\n", ":5:9", "has none"},
      {kStill + "[imu]\nclass = \"automotive-mems\"\nbias = \"gauss_markov\"\n", ":5:8",
       "of its own"},
      {kStill + "[imu]\nclass = \"marine\"\nbias_tau_s = 100\n", ":3:1", "gauss_markov"},
      {all + "[gnss]\noutages = [{start_s = 3590, duration_s = 60}]\n", ":6:12", "ends at 3650 s"},
      {all + "[gnss]\noutages = [{start_s = 10}]\n", ":6:12", "needs duration_s"},
      {all + "[gnss]\noutages = 3\n", ":6:11", "list of sections"},
      {all + "[gnss]\ninterval_s = 4000\n", ":5:1", "longer than the scene"},
      {all + "[gnss]\ninterval_s = 0.01\n", ":5:1", "raise imu_rate_hz"},
      {all + "[gnss]\nposition_sigma_h_m = 1\nposition_sigma_ned_m = [1, 1, 1]\n", ":7:1",
       "give one"},
      {all + "[gnss]\nposition_sigma_h_m = 0\n", ":5:1", "no receiver is exact"},
      {"[trajectory]\ntype = \"waypoints\"\n" + kImu, ":1:1", "2 to 2000"},
      {"[trajectory]\ntype = \"waypoints\"\nwaypoint = [{north_m = 0, speed_mps = 1}]\n" + kImu,
       ":3:13", "either latitude_deg"},
      {"[trajectory]\ntype = \"waypoints\"\nwaypoint = [{north_m = 0, east_m = 0}]\n" + kImu,
       ":3:13", "needs speed_mps"},
      {"[trajectory]\ntype = \"waypoints\"\nwaypoint = [{north_m = 0, east_m = 0, speed_mps = 1}, "
       "{north_m = 0, east_m = 0}]\n" +
           kImu,
       ":1:1", "to wait at a place use stop_s"},
      {"[trajectory]\ntype = \"waypoints\"\nwaypoint = [{north_m = 0, east_m = 0, speed_mps = "
       "0.01}, "
       "{north_km = 50, east_m = 0}]\n" +
           kImu,
       ":1:1", "the motion takes"},
      {kStill + "[imu]\nmodel = \"/dev/zero\"\n", ":4:9", "cannot be read"},
      {"[trajectory]\ntype = \"recorded\"\nfile = \"/dev/zero\"\n" + kImu, ":3:8", "is no file"},
  };
  for (const auto& c : cases) {
    CAPTURE(c.text);
    const std::string message = scene_refusal(c.text);
    CAPTURE(message);
    CHECK(contains(message, std::string("scene.toml") + c.where));
    CHECK(contains(message, c.named));
  }
}

TEST_CASE("a damaged scene is read or refused, whatever the damage") {
  std::vector<std::string> texts;
  for (const auto& path : ready_scenes()) texts.push_back(test::read_file(path));
  const std::string bytes = "[]{}=\"'.,#\n\t -+0123456789eEinfa_xyz\xff\x80";
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const auto below = [&random](std::size_t n) {
      return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
    };
    std::string text = texts[below(texts.size())];
    for (std::size_t k = below(6) + 1; k > 0; --k) {
      const std::size_t at = below(text.size());
      if (random.uniform() < 0.3)
        text.erase(at, below(20));
      else
        text.insert(at, 1, bytes[below(bytes.size())]);
    }
    try {
      validate(parse_scene(text, "damaged.toml"));
    } catch (const Error& error) {
      CHECK(contains(error.what(), "damaged.toml"));
    }
  }
}

TEST_CASE("a scene that is no file, or too long for one, is refused") {
  const test::TempDir dir;
  CHECK_THROWS_AS(read_scene(dir / "missing.toml"), Error);
  CHECK_THROWS_AS(read_scene(dir / ""), Error);
  const auto path = dir.file("long.toml", std::string(kLongestSceneFile + 1, '\n'));
  CHECK(
      contains(test::message_of<Error>([&path] { read_scene(path); }), "too long for a TOML file"));
  CHECK_THROWS_AS(parse_scene(std::string(kLongestSceneFile + 1, '\n'), "s"), Error);
}

}  // namespace leeway::sim
