#include <doctest/doctest.h>

#include <functional>

#include "tests/sim/cli/simulated.hpp"

namespace leeway::test {
namespace {

using nlohmann::json;
using Lines = std::vector<std::string>;

/// The figures of a run that succeeded although its input was damaged, and what it said about it.
struct Run {
  json results;
  std::string warnings;
};

Run run(const std::string& arguments) {
  const Outcome outcome = leeway(arguments + " --json");
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  return {outcome.json().at("results"), outcome.err};
}

std::string with_truth(const std::filesystem::path& imu, const std::filesystem::path& gnss) {
  return Simulated::fuse(imu, gnss) + " --truth " + quoted(simulated().truth);
}

void check_refused(const std::string& arguments, const std::string& named) {
  const Outcome outcome = leeway(arguments + " --json");
  CAPTURE(arguments);
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.out.empty());
  CHECK(outcome.err.starts_with("leeway: "));
  CHECK(contains(outcome.err, named));
}

TEST_CASE("a file that is missing, empty, a folder or without a column is refused by name") {
  const TempDir dir;
  const auto empty = dir.file("empty.csv", "");
  Lines lines = lines_of(simulated().imu);
  lines[0].replace(lines[0].find("dtheta_y_rad"), 12, "dtheta_y_deg");
  const auto no_column = dir.file("no_column.csv", text_of(lines));
  const auto& s = simulated();
  for (const auto& path : {dir / "missing.csv", empty, dir / ""}) {
    check_refused(Simulated::fuse(path, s.gnss), path.string());
    check_refused(Simulated::fuse(s.imu, path), path.string());
    check_refused(s.fuse() + " --truth " + quoted(path), path.string());
  }
  check_refused(Simulated::fuse(no_column, s.gnss), "dtheta_y_rad");
  check_refused(Simulated::fuse(s.gnss, s.imu), "gnss.csv");
  check_refused(s.fuse() + " --outages " + quoted(dir / "missing.json"), "missing.json");
  check_refused(s.fuse() + " --imu-model x", "--imu-model");  // it names an --imu-class as well
  check_refused("fuse --drive " + quoted(dir / "no_drive"), "no_drive");
}

TEST_CASE("outages and a drive's meta.json that are not what they should be are refused") {
  const TempDir dir;
  for (const char* text : {"", "[", "[1]", R"([{"start_s": 5}])", R"([{"start_s": "5"}])",
                           R"([{"start_s": 5, "duration_s": -1}])"}) {
    CAPTURE(text);
    const auto path = dir.file("outages.json", text);
    check_refused(simulated().fuse() + " --outages " + quoted(path), "outages.json");
  }
  for (const char* text : {"", "{}", R"({"mount_rpy_deg": [1, 2]})",
                           R"({"mount_rpy_deg": [1, 2, 3], "reference_window_s": 5})"}) {
    CAPTURE(text);
    dir.file("meta.json", text);
    check_refused("fuse --drive " + quoted(dir / ""), "meta.json");
  }
}

TEST_CASE("a damaged line costs that line: it is counted, named and the result stays") {
  const struct {
    const char* reason;
    std::function<void(Lines&)> damage;
  } cases[] = {
      {"not a number", [](Lines& l) { l[9000] = "90.0,0.01,what,0,0,0,0,0"; }},
      {"not finite", [](Lines& l) { l[9000] = "90.0,0.01,nan,0,0,0,0,0"; }},
      {"missing field", [](Lines& l) { l[9000] = "90.0,0.01,0.0"; }},
      {"time goes back", [](Lines& l) { l[9000] = "10" + l[9000].substr(l[9000].find(',')); }},
      {"time repeated", [](Lines& l) { l.insert(l.begin() + 9001, l[9000]); }},
  };
  for (const auto& c : cases) {
    CAPTURE(c.reason);
    const TempDir dir;
    Lines lines = lines_of(simulated().imu);
    c.damage(lines);
    const auto imu = dir.file("damaged.csv", text_of(lines));
    const Run damaged = run(with_truth(imu, simulated().gnss));
    const json& log = damaged.results.at("logs").at("imu");
    CHECK(log.at("damaged_lines") == 1);
    CHECK(log.at("damaged").at(c.reason) == 1);
    CHECK(contains(damaged.warnings, "damaged.csv"));
    CHECK(contains(damaged.warnings, c.reason));
    // 10 ms without IMU data at up to 25 m/s; the next fixes take out what that costs.
    CHECK(damaged.results.at("rms").at("horizontal_m") < kFusedRmsM);
  }
}

TEST_CASE("damaged lines of a GNSS log") {
  const TempDir dir;
  Lines lines = lines_of(simulated().gnss);
  lines[80] = "80,NaN" + lines[80].substr(lines[80].find(',', 3));
  lines[90] = "garbage";
  std::swap(lines[100], lines[101]);
  const Run damaged = run(with_truth(simulated().imu, dir.file("damaged.csv", text_of(lines))));
  CHECK(damaged.results.at("logs").at("gnss").at("damaged_lines") == 3);
  CHECK(contains(damaged.warnings, "damaged.csv:91:"));
  CHECK(damaged.results.at("rms").at("horizontal_m") < kFusedRmsM);
}

TEST_CASE("a truncated gzip log is used up to its end") {
  const TempDir dir;
  const auto whole = dir.gzip_file("whole.csv.gz", read_file(simulated().imu));
  const std::string bytes = read_file(whole);
  const auto cut = dir.file("cut.csv.gz", bytes.substr(0, bytes.size() * 3 / 4));
  const Run damaged = run(with_truth(cut, simulated().gnss));
  CHECK(damaged.results.at("logs").at("imu").at("incomplete").is_string());
  CHECK(damaged.results.at("logs").at("imu").at("records") > 9000);
  CHECK(contains(damaged.warnings, "cut.csv.gz ends early"));
  CHECK(damaged.results.at("rms").at("horizontal_m") < kFusedRmsM);
}

TEST_CASE("a gap of 5 s in the IMU data is bridged and counted") {
  const TempDir dir;
  Lines lines = lines_of(simulated().imu);
  lines.erase(lines.begin() + 9001, lines.begin() + 9501);
  const Run gap = run(with_truth(dir.file("gap.csv", text_of(lines)), simulated().gnss));
  CHECK(gap.results.at("verdicts").at("gap") == 1);
  CHECK(contains(gap.warnings, "gap"));
  // Bridging 5 s of a car's driving may be off by tens of metres before the next fix: as
  // the RMS over 115 s, 30 m for 1 s is 2.8 m.
  CHECK(gap.results.at("rms").at("horizontal_m") < 3.0);
  CHECK(gap.results.at("solution").at("last_s") > 149.0);
}

TEST_CASE("a GNSS outlier of 100 m is refused and counted") {
  const TempDir dir;
  Lines lines = lines_of(simulated().gnss);
  const std::size_t comma = lines[100].find(',');
  const double lat_deg = std::stod(lines[100].substr(comma + 1));
  std::ostringstream moved;
  moved.precision(15);
  moved << lines[100].substr(0, comma + 1) << lat_deg + 100.0 / 111.3e3
        << lines[100].substr(lines[100].find(',', comma + 1));
  lines[100] = moved.str();
  const Run outlier = run(with_truth(simulated().imu, dir.file("outlier.csv", text_of(lines))));
  CHECK(outlier.results.at("verdicts").at("partly") == 1);
  CHECK(contains(outlier.warnings, "gate"));
  CHECK(outlier.results.at("rms").at("horizontal_m") < kFusedRmsM);
}

TEST_CASE("a model file with an unknown key or unit is refused with its line") {
  const TempDir dir;
  const auto model = dir.file("model.toml", "[gyro]\nbias_sigma_deg_per_hour = 1\n");
  check_refused(simulated().fuse().replace(5, Simulated::imu_model().size(), "") + " --imu-model " +
                    quoted(model),
                "model.toml:2:1: unknown key 'bias_sigma_deg_per_hour': did you mean "
                "'bias_sigma_deg_per_h'?");
  check_refused(
      "simulate --trajectory car --out " + quoted(dir / "out") + " --imu-model " + quoted(model),
      "bias_sigma_deg_per_hour");
  CHECK(!std::filesystem::exists(dir / "out"));
}

}  // namespace
}  // namespace leeway::test
