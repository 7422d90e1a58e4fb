#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/sim/cli/program.hpp"
#include "tests/sim/cli/simulated.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::test {
namespace {

/// A case of the shared folder: its logs in a row.
std::string file_of_case(const std::string& name, const std::string& file) {
  return quoted(std::filesystem::path(LEEWAY_SHARED_DIR) / "cases" / name / file) + " ";
}

bool are_cases_there() {
  return std::filesystem::exists(std::filesystem::path(LEEWAY_SHARED_DIR) / "cases");
}

std::string fuse_of_case(const std::string& name, const std::string& more = "") {
  return "fuse --imu " + file_of_case(name, "imu.csv") + "--gnss " +
         file_of_case(name, "gnss.csv") + "--truth " + file_of_case(name, "truth.csv") +
         "--gnss-correlation-s 0 --json " + more;
}

}  // namespace

TEST_CASE("info: right logs have no finding but notes, and the next command is said") {
  const std::string logs = quoted(simulated().gnss) + " " + quoted(simulated().imu);
  const auto found = leeway("info " + logs + " --json").json().at("results");
  for (const auto& finding : found.at("findings")) CHECK(finding.at("certainty") == "note");
  CHECK(found.at("imu").at("time").at("records") == 15000);
  CHECK(found.at("gnss").at("with_velocity") == 150);
  const Outcome text = leeway("info " + logs);
  CHECK(text.exit_code == 0);
  CHECK(contains(text.out, "leeway replay --imu"));
}

TEST_CASE("info: what is no log is refused with what it lacks") {
  const TempDir dir;
  const Outcome outcome = leeway("info " + quoted(dir.file("notes.txt", "no numbers\nhere\n")));
  CHECK(outcome.exit_code == 1);
  CHECK(contains(outcome.err, "notes.txt"));
  CHECK(contains(outcome.err, "missing columns"));
}

TEST_CASE("cases: what is certainly wrong stops fuse, with the option that mends it") {
  if (!are_cases_there()) return;
  struct Case {
    std::string name;
    std::string says;
    std::string mend;
  };
  for (const Case& c : {Case{"accelerometer-in-g", "--accel-unit g", "--accel-unit g"},
                        Case{"velocity-up-sign", "--column vd=-", "--column vd=-vd_mps"}}) {
    CAPTURE(c.name);
    const TempDir dir;
    const Outcome refused = leeway(fuse_of_case(c.name, "--out " + quoted(dir / "s.csv")));
    CHECK(refused.exit_code == 2);
    CHECK(contains(refused.err, c.says));
    CHECK_FALSE(std::filesystem::exists(dir / "s.csv"));
    CHECK(leeway(fuse_of_case(c.name, "--as-is")).exit_code == 0);
    const auto mended = leeway(fuse_of_case(c.name, c.mend)).json().at("results");
    CHECK(mended.at("refused") == false);
    // The case's README: 0.52 m, 0.67 m and 1.6 deg with the right log.
    CHECK(mended.at("rms").at("horizontal_m") < 0.55);
    CHECK(mended.at("rms").at("vertical_m") < 0.7);
    CHECK(mended.at("rms").at("attitude_deg") < 1.8);
  }
}

TEST_CASE("case: an odometer in km/h is named, and its unit in the column's name mends it") {
  if (!are_cases_there()) return;
  const std::string name = "odometer-in-km-per-h";
  const std::string car = "--vehicle car --mount 0,0,0 --mount-axes frd --odometer ";
  const Outcome refused = leeway(fuse_of_case(name, car + file_of_case(name, "odometer.csv")));
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "km/h"));
  const TempDir dir;
  std::string text =
      read_file(std::filesystem::path(LEEWAY_SHARED_DIR) / "cases" / name / "odometer.csv");
  text.replace(text.find("speed_mps"), 9, "speed_kmh");
  const auto mended =
      leeway(fuse_of_case(name, car + quoted(dir.file("odometer.csv", text)))).json().at("results");
  CHECK(mended.at("refused") == false);
  CHECK(mended.at("verdicts").at("gated") == 0);
}

TEST_CASE("clocks of unknown begin: auto finds what lies between them") {
  const TempDir dir;
  std::string text = read_file(simulated().gnss);
  std::string shifted;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t comma = line.find(',');
    if (!shifted.empty()) {
      line = std::to_string(std::stod(line.substr(0, comma)) + 1e9) + line.substr(comma);
    }
    shifted += line + "\n";
  }
  const auto gnss = dir.file("gnss.csv", shifted);
  const std::string fuse = Simulated::fuse(simulated().imu, gnss);
  const Outcome refused = leeway(fuse);
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "--gnss-time-offset-s"));
  const Outcome found = leeway(fuse + " --gnss-time-offset-s auto --json");
  REQUIRE(found.exit_code == 0);
  CHECK(contains(found.err, "by the turns"));
}

TEST_CASE("case: two sessions are scored at the times of their solutions") {
  if (!are_cases_there()) return;
  const auto rms = leeway(fuse_of_case("two-sessions")).json().at("results").at("rms");
  CHECK(rms.at("horizontal_m") < 0.56);  // 0.55 m in the case's README; 33.7 m was printed
}

}  // namespace leeway::test
