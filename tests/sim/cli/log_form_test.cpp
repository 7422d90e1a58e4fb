#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "tests/sim/cli/program.hpp"
#include "tests/support/near.hpp"

namespace leeway::test {
namespace {

const std::filesystem::path kCases = std::filesystem::path(LEEWAY_SHARED_DIR) / "cases";

Outcome fuse_case(const std::string& imu, const std::string& gnss, const std::string& rest = "") {
  return leeway("fuse --gnss-correlation-s 0 --imu " + quoted(kCases / imu) + " --gnss " +
                quoted(kCases / gnss) + " " + rest);
}

bool has_cases() {
  if (std::filesystem::exists(kCases)) return true;
  MESSAGE("skipped: no cases at " << kCases.string());
  return false;
}

/// The solution of a case, as text.
std::string solution_of(const std::string& imu, const std::string& gnss) {
  const TempDir dir;
  const Outcome outcome = fuse_case(imu, gnss, "--out " + quoted(dir / "s.csv"));
  CHECK(outcome.exit_code == 0);
  return std::filesystem::exists(dir / "s.csv") ? read_file(dir / "s.csv") : std::string();
}

TEST_CASE("fuse: a spreadsheet's dialect makes no difference") {
  if (!has_cases()) return;
  const std::string gnss = "spreadsheet-csv/gnss.csv";
  const std::string plain = solution_of("spreadsheet-csv/imu.csv", gnss);
  REQUIRE(!plain.empty());
  for (const char* kind : {"quoted", "semicolon", "tab", "decimal-comma"}) {
    CAPTURE(kind);
    CHECK(solution_of("spreadsheet-csv/imu-" + std::string(kind) + ".csv", gnss) == plain);
  }
}

TEST_CASE("fuse: CSV in seconds of week goes on over the end of the week") {
  if (!has_cases()) return;
  const std::string solution =
      solution_of("csv-week-rollover/imu.csv", "csv-week-rollover/gnss.csv");
  // The drive ends 80 s after 604760.
  CHECK(contains(solution, "\n604839."));
}

TEST_CASE("fuse: an RTKLIB solution without its header is that with it") {
  if (!has_cases()) return;
  const std::string imu = "headerless-llh/imu.csv";
  const std::string with = solution_of(imu, "headerless-llh/rover.pos");
  REQUIRE(!with.empty());
  CHECK(solution_of(imu, "headerless-llh/rover.LLH") == with);
}

TEST_CASE("fuse: times in milliseconds are named, and read where they are said") {
  if (!has_cases()) return;
  const std::string imu = "time-in-milliseconds/imu.csv", gnss = "time-in-milliseconds/gnss.csv";
  const Outcome refused = fuse_case(imu, gnss);
  CHECK(refused.exit_code == 1);
  CHECK(contains(refused.err, "a step of 100 s between rows"));
  CHECK(contains(refused.err, "are its times in ms?"));
  CHECK(fuse_case(imu, gnss, "--time-unit ms,s").exit_code == 0);
}

TEST_CASE("fuse: a unit that is said, on the command line or in a file") {
  if (!has_cases()) return;
  const TempDir dir;
  const auto file = dir.file("my-logger.toml", "[imu]\naccel_unit = \"g\"\n");
  const std::string imu = "accelerometer-in-g/imu.csv", gnss = "accelerometer-in-g/gnss.csv";
  const std::string rest =
      "--json --truth " + quoted(kCases / "accelerometer-in-g/truth.csv") + " ";
  for (const std::string& said : {std::string("--accel-unit g"), "--log-format " + quoted(file)}) {
    const Outcome outcome = fuse_case(imu, gnss, rest + said);
    REQUIRE(outcome.exit_code == 0);
    // The case says 0.52 m with right units, 9.5 m without.
    CHECK(outcome.json().at("results").at("rms").at("horizontal_m") < 0.6);
  }
  CHECK(contains(fuse_case(imu, gnss, "--accel-unit furlong").err, "is not one of m/s^2, g, mg"));
}

}  // namespace
}  // namespace leeway::test
