#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "tests/sim/cli/simulated.hpp"
#include "tests/support/near.hpp"

namespace leeway::test {
namespace {

using nlohmann::json;

TEST_CASE("fuse reads back what simulate wrote: errors of the size of the fixes") {
  const TempDir dir;
  const auto outages = dir.file("outages.json", R"([{"start_s": 80, "duration_s": 20},
                                                    {"start_s": 90, "duration_s": 20}])");
  const Outcome outcome = leeway(simulated().fuse_with_truth() + " --json --outages " +
                                 quoted(outages) + " --out " + quoted(dir / "solution.csv.gz"));
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
  const json object = outcome.json();
  CHECK(object.size() == 4);
  CHECK(object.at("leeway").is_string());
  CHECK(object.at("command") == "fuse");
  CHECK(object.at("input").at("imu_model") == "tactical/low");
  const json& results = object.at("results");

  const json& rms = results.at("rms");
  CHECK(rms.at("epochs") > 1000);
  CHECK(rms.at("horizontal_m") < kFusedRmsM);
  CHECK(rms.at("vertical_m") < kFusedRmsM);
  CHECK(rms.at("velocity_mps") < 0.05);
  // Tilt by the low end of the accelerometer bias is 0.06 deg; heading settles to some tenths.
  CHECK(rms.at("attitude_deg") < 1.0);

  REQUIRE(results.at("outages").size() == 2);
  for (const json& outage : results.at("outages")) {
    CHECK(outage.at("start_s").is_number());
    CHECK(outage.at("duration_s") == 20.0);
    CHECK(outage.at("against") == "reference");
    // b t^2 / 2 with b = 0.01 m/s^2 is 2 m per axis; the tilt it comes with takes most of it away.
    CHECK(outage.at("end_error_h_m") < 4.0);
    CHECK(outage.at("end_error_h_m") <= outage.at("max_error_h_m"));
    CHECK(outage.at("end_error_v_m").is_number());
  }
  const json& summary = results.at("outage_summary");
  REQUIRE(summary.size() == 1);
  CHECK(summary[0].at("count") == 2);
  const double a = results.at("outages")[0].at("end_error_h_m");
  const double b = results.at("outages")[1].at("end_error_h_m");
  CHECK(near(summary[0].at("rms_end_h_m").get<double>(), std::sqrt((a * a + b * b) / 2.0), 1e-9));

  CHECK(results.at("verdicts").at("fused") > 100);
  CHECK(results.at("verdicts").at("gated") == 0);
  // 115 fixes of six components: the mean NIS has a sigma of sqrt(2 * 6 / 115) = 0.32; 4 of them.
  CHECK(near(results.at("nis_mean").get<double>(), 6.0, 1.3));
  CHECK(results.at("logs").at("imu").at("damaged_lines") == 0);
  CHECK(results.at("logs").at("imu").at("records") == 15000);
  CHECK(std::filesystem::file_size(dir / "solution.csv.gz") > 0);
  CHECK(!std::filesystem::exists(dir / "solution.csv.gz.partial"));
}

TEST_CASE("fuse --scheme takes the names of filter files and compare; an old one with a note") {
  const auto fused_by = [](const std::string& scheme) {
    const Outcome outcome = leeway(simulated().fuse() + " --json --scheme " + scheme);
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.json().at("input").at("scheme") == "runge-kutta-4");
    return outcome.err;
  };
  CHECK(fused_by("runge-kutta-4").empty());
  CHECK(fused_by("runge_kutta_4") == "leeway: note: runge_kutta_4 is now written runge-kutta-4\n");
  CHECK(fused_by("rk4") == "leeway: note: rk4 is now written runge-kutta-4\n");
}

TEST_CASE("fuse prints tables with units, and says what errors are measured against") {
  const TempDir dir;
  const auto outages = dir.file("outages.json", R"([{"start_s": 80, "duration_s": 20}])");
  const std::string with_outages = " --outages " + quoted(outages);
  const Outcome by_truth = leeway(simulated().fuse_with_truth() + with_outages);
  CHECK(by_truth.exit_code == 0);
  for (const char* text : {"horizontal, m", "velocity 3-D, m/s", "against the reference", "fused",
                           "RMS h, m", "median h, m", "tactical/low", "CSV, increments"}) {
    CAPTURE(text);
    CHECK(contains(by_truth.out, text));
  }
  const Outcome by_fixes = leeway(simulated().fuse() + with_outages);
  CHECK(by_fixes.exit_code == 0);
  CHECK(contains(by_fixes.out, "against the withheld fixes"));
  CHECK(!contains(by_fixes.out, "reference"));

  const auto object = leeway(simulated().fuse() + with_outages + " --json").json();
  CHECK(object.at("results").at("outages")[0].at("against") == "gnss");
  CHECK(!object.at("results").contains("rms"));
}

double horizontal_rms_m(const std::string& arguments, const std::string& before = "") {
  const Outcome outcome = leeway(arguments + " --json", before);
  CAPTURE(arguments);
  REQUIRE(outcome.exit_code == 0);
  return outcome.json().at("results").at("rms").at("horizontal_m");
}

/// The simulated IMU log as sensors in other axes would have given it: axis i of the sensor is
/// sign[i] times body axis from[i].
std::string in_sensor_axes(const std::array<std::size_t, 3>& from,
                           const std::array<double, 3>& sign) {
  std::vector<std::string> lines = lines_of(simulated().imu);
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const std::vector<double> row = numbers_of(lines[k]);
    std::ostringstream text;
    text.precision(17);
    text << row[0] << "," << row[1];
    for (const std::size_t triad : {2u, 5u}) {
      for (std::size_t i = 0; i < 3; ++i) text << "," << sign[i] * row[triad + from[i]];
    }
    lines[k] = text.str();
  }
  return text_of(lines);
}

TEST_CASE("fuse --mount takes sensor axes to the body, as forward-left-up or as given" *
          doctest::test_suite("heavy")) {
  const TempDir dir;
  const std::string truth = " --truth " + quoted(simulated().truth);
  const double plain_m = horizontal_rms_m(simulated().fuse_with_truth());
  // Rotating numbers by a matrix of rounded sines costs 1e-16 of them: far below 1e-6 m.
  constexpr double kToleranceM = 1e-6;

  const auto flu = dir.file("flu.csv", in_sensor_axes({0, 1, 2}, {1.0, -1.0, -1.0}));
  CHECK(near(horizontal_rms_m(Simulated::fuse(flu, simulated().gnss) + truth + " --mount 0,0,0"),
             plain_m, kToleranceM));
  // Sensor turned left by 90 deg seen from above, in forward-left-up axes: x left, y back.
  const auto left = dir.file("left.csv", in_sensor_axes({1, 0, 2}, {-1.0, -1.0, -1.0}));
  CHECK(near(horizontal_rms_m(Simulated::fuse(left, simulated().gnss) + truth + " --mount 0,0,90"),
             plain_m, kToleranceM));
  // Turned right by 90 deg in forward-right-down axes: x right, y back.
  const auto right = dir.file("right.csv", in_sensor_axes({1, 0, 2}, {1.0, -1.0, 1.0}));
  CHECK(near(horizontal_rms_m(Simulated::fuse(right, simulated().gnss) + truth +
                              " --mount-axes frd --mount=-0,0,90"),
             plain_m, kToleranceM));
  const Outcome upside_down = leeway(Simulated::fuse(flu, simulated().gnss));
  CHECK(contains(upside_down.err, "vertical sensor axis points up"));
}

TEST_CASE("fuse --vehicle car finds the mount, and takes an odometer that reads too much" *
          doctest::test_suite("heavy")) {
  const TempDir dir;
  // Sensor axes left, back, up: roll 180, yaw -90 deg to forward, right, down.
  const auto left = dir.file("left.csv", in_sensor_axes({1, 0, 2}, {-1.0, -1.0, -1.0}));
  const std::string car = Simulated::fuse(left, simulated().gnss) + " --vehicle car --truth " +
                          quoted(simulated().truth) + " --json";
  const json found = leeway(car).json().at("results");
  const json mount = found.at("solution").at("health").at("mount_rpy_deg");
  constexpr double kFoundDeg = 6.0;  // as good as a heading known to 0.1 rad
  CHECK(std::abs(std::abs(mount[0].get<double>()) - 180.0) < kFoundDeg);
  CHECK(std::abs(mount[1].get<double>()) < kFoundDeg);
  CHECK(std::abs(mount[2].get<double>() + 90.0) < kFoundDeg);
  CHECK(found.at("verdicts").at("gated") == 0);

  std::string speeds = "t_s,speed_mps\n";
  std::size_t readings = 0;
  for (const std::string& line : lines_of(simulated().truth)) {
    if (line.starts_with("t_s")) continue;
    const std::vector<double> row = numbers_of(line);
    if (row[0] != std::floor(row[0])) continue;
    speeds += std::to_string(row[0]) + "," +
              std::to_string(1.02 * std::hypot(row[4], row[5], row[6])) + "\n";
    ++readings;
  }
  const std::string odometer = " --odometer " + quoted(dir.file("odometer.csv", speeds));
  const json off = leeway(car + odometer + " --without odometer").json().at("results");
  CHECK(off.at("verdicts").at("unused") == readings);
  CHECK(off.at("verdicts").at("fused") == found.at("verdicts").at("fused"));
  const json on = leeway(car + odometer).json().at("results");
  CHECK(on.at("verdicts").at("fused") > found.at("verdicts").at("fused"));
  CHECK(on.at("verdicts").at("gated") == 0);
  CHECK(on.at("rms").at("velocity_mps") < 1.1 * found.at("rms").at("velocity_mps").get<double>());
}

TEST_CASE("fuse takes a heading: in its own log, in that of the receiver, or told at the start") {
  const TempDir dir;
  leeway("simulate --trajectory static --duration-s 40 --imu-rate-hz 50 " + Simulated::imu_model() +
         " --out " + quoted(dir / ""));
  // The nose of the body at rest is north.
  std::string headings = "t_s,heading_deg,heading_sigma_deg\n";
  std::string fixes;
  for (const std::string& line : lines_of(dir / "gnss.csv")) {
    const bool is_header = line.starts_with("t_s");
    fixes += line + (is_header ? ",heading_deg,heading_sigma_deg" : ",359.5,0.5") + "\n";
    if (!is_header) headings += line.substr(0, line.find(',')) + ",0.5,0.5\n";
  }
  const auto by_receiver = dir.file("fixes.csv", fixes);
  const std::string by_log = " --heading " + quoted(dir.file("heading.csv", headings));
  const std::string rest = " --vehicle walker --json --truth " + quoted(dir / "truth.csv");
  const std::string plain = Simulated::fuse(dir / "imu.csv", dir / "gnss.csv") + rest;
  const auto attitude_deg = [](const std::string& command) {
    const Outcome outcome = leeway(command);
    CHECK(outcome.exit_code == 0);
    return outcome.json().at("results").at("rms").at("attitude_deg").get<double>();
  };
  // A tactical gyro does not find north in 40 s.
  const json open = leeway(plain).json().at("results").at("solution").at("health");
  CHECK(open.at("state") == "heading_open");
  // 0.5 deg of heading, and the tilt of an accelerometer of this class.
  CHECK(near(attitude_deg(plain + by_log), 0.5, 0.3));
  CHECK(near(attitude_deg(Simulated::fuse(dir / "imu.csv", by_receiver) + rest), 0.5, 0.3));
  CHECK(near(attitude_deg(plain + " --start-heading-deg=-3"), 3.0, 0.5));
  const json told = leeway(plain + " --start-heading-deg 3 --start-heading-sigma-deg 2").json();
  CHECK(told.at("input").at("start_heading_deg") == 3.0);
  CHECK(told.at("input").at("start_heading_sigma_deg") == 2.0);
  const json off = leeway(plain + by_log + " --without heading").json().at("results");
  CHECK(off.at("verdicts").at("unused") > 30);
}

TEST_CASE("fuse takes a log through a pipe") {
  CHECK(near(horizontal_rms_m(Simulated::fuse("/dev/stdin", simulated().gnss) + " --truth " +
                                  quoted(simulated().truth),
                              "cat " + quoted(simulated().imu) + " | "),
             horizontal_rms_m(simulated().fuse_with_truth()), 0.0));
}

TEST_CASE("fuse corrects for the lever arm it is given") {
  const TempDir dir;
  leeway("simulate --trajectory car --duration-s 150 --imu-rate-hz 100 --lever 0,4,-1 " +
         Simulated::imu_model() +
         " --gnss-sigma-h-m 0.1 --gnss-sigma-v-m 0.1 --gnss-correlated-sigma-m 0 --out " +
         quoted(dir / ""));
  const std::string fuse =
      Simulated::fuse(dir / "imu.csv", dir / "gnss.csv") + " --truth " + quoted(dir / "truth.csv");
  CHECK(horizontal_rms_m(fuse + " --lever 0,4,-1") < kFusedRmsM);
  CHECK(horizontal_rms_m(fuse) > 2.0);
}

TEST_CASE("fuse: the annotated model file of the default part gives what the default gives") {
  const std::string logs = "fuse --imu " + quoted(simulated().imu) + " --gnss " +
                           quoted(simulated().gnss) + " --truth " + quoted(simulated().truth);
  const std::string file =
      quoted(std::filesystem::path(LEEWAY_MODELS_DIR) / "automotive-mems.toml");
  // Units converted by another path differ in the last bit.
  CHECK(near(horizontal_rms_m(logs + " --imu-model " + file), horizontal_rms_m(logs), 1e-9));
}

TEST_CASE("fuse without an answer exits with 2") {
  const TempDir dir;
  leeway("simulate --trajectory static --duration-s 20 --out " + quoted(dir / ""));
  const Outcome at_rest = leeway(Simulated::fuse(dir / "imu.csv", dir / "gnss.csv") +
                                 " --json --out " + quoted(dir / "solution.csv"));
  CHECK(at_rest.exit_code == 2);
  CHECK(contains(at_rest.err, "never aligned"));
  CHECK(at_rest.json().at("results").at("solution").is_null());
  CHECK(at_rest.json().at("results").at("nis_mean").is_null());

  // 2026-11-24: fixes on another time line were blamed on the speed of the vehicle.
  const auto other_day = dir.file("other_day.csv",
                                  "t_s,lat_deg,lon_deg,height_m,pos_std_n_m,pos_std_e_m,"
                                  "pos_std_d_m\n408640,45,37,100,1,1,2\n408641,45,37,100,1,1,2\n");
  const Outcome apart = leeway(Simulated::fuse(simulated().imu, other_day));
  CHECK(apart.exit_code == 2);
  CHECK(contains(apart.err, "from the same moment"));

  const Outcome elsewhere =
      leeway(simulated().fuse_with_truth() + " --truth-window 1000,2000 --json");
  CHECK(elsewhere.exit_code == 2);
  CHECK(elsewhere.json().at("results").at("rms").at("horizontal_m").is_null());

  const auto late = dir.file("late.json", R"([{"start_s": 1000, "duration_s": 10}])");
  const Outcome unscored = leeway(simulated().fuse() + " --json --outages " + quoted(late));
  CHECK(unscored.exit_code == 2);
  CHECK(unscored.json().at("results").at("outages")[0].at("against").is_null());
  CHECK(unscored.json().at("results").at("outages")[0].at("end_error_h_m").is_null());
}

TEST_CASE("fuse --drive: recorded drives, their outages pooled" * doctest::test_suite("heavy")) {
  const std::filesystem::path drives = std::filesystem::path(LEEWAY_SHARED_DIR) / "data/drives";
  if (!std::filesystem::exists(drives)) {
    MESSAGE("skipped: no recorded drives at " << drives.string());
    return;
  }
  const char* const names[] = {"urban-short-turn-loop-nominal-001",
                               "urban-low-speed-low-signal-001"};
  std::string arguments = "fuse --json";
  for (const char* name : names) arguments += " --drive " + quoted(drives / name);
  const Outcome outcome = leeway(arguments);
  CHECK(outcome.exit_code == 0);
  const json results = outcome.json().at("results");
  REQUIRE(results.at("drives").size() == 2);
  CHECK(results.at("drives")[0].at("drive") == names[0]);
  CHECK(results.at("drives")[0].contains("rms"));
  CHECK(!results.at("drives")[1].contains("rms"));  // its reference is never good
  REQUIRE(results.at("outages").size() == 4);
  for (const json& outage : results.at("outages")) {
    CHECK(outage.at("drive") == names[0]);
    CHECK(outage.at("against") == "reference");
    // A plain filter drifts 33 m RMS in 60 s; 3 of these sigma.
    CHECK(outage.at("end_error_h_m") < 100.0);
  }
  // The reference differs from its own fixes by up to 1.4 m RMS.
  CHECK(results.at("rms").at("horizontal_m") < 3.0);
  const Outcome table = leeway("fuse --drive " + quoted(drives / names[0] / "."));
  CHECK(table.exit_code == 0);
  CHECK(contains(table.out, names[0]));
}

}  // namespace
}  // namespace leeway::test
