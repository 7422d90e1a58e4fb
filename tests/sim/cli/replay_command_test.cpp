#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "tests/sim/cli/mpi.hpp"
#include "tests/sim/cli/simulated.hpp"

namespace leeway::test {
namespace {

/// One beginning of each interval: what is asked here is not how sure the answer is.
std::string replay(const std::string& options = "") {
  const Simulated& s = simulated();
  return "replay " + Simulated::imu_model() + " --gnss-correlation-s 0 --imu " + quoted(s.imu) +
         " --gnss " + quoted(s.gnss) + " --phases 1 --settle-s 60 --durations 5,20 " + options;
}

/// The simulated logs as drives of a folder.
void make_drives(const TempDir& dir, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    std::filesystem::create_directories(dir / name);
    // Logs are told from their content, whatever they are called.
    std::filesystem::copy_file(simulated().imu, dir / name / "imu.csv.gz");
    std::filesystem::copy_file(simulated().gnss, dir / name / "gnss.csv.gz");
    dir.file(name + "/meta.json", R"({"mount_rpy_deg": [180, 0, 0], "reference_window_s": null})");
  }
}

}  // namespace

TEST_CASE("replay: the interval, measured and predicted, of a log") {
  const Outcome run = leeway(replay("--limit 1,1000 --json --truth ") + quoted(simulated().truth));
  REQUIRE(run.exit_code == 0);
  const auto results = run.json().at("results");
  CHECK(results.at("metric") == "r95");
  const auto& log = results.at("logs").at(0);
  CHECK(log.at("against") == "reference");
  CHECK(log.at("receiver").at("interval_s") == 1.0);
  CHECK(log.at("not_predicted").is_null());
  CHECK(log.at("outages").size() == 2);
  CHECK(log.at("outages").at(0).at("outages") > 3);
  CHECK(log.at("intervals") == results.at("pooled").at("intervals"));
  const auto& far = log.at("intervals").at(1);
  CHECK(far.at("limit_m") == 1000.0);
  CHECK(far.at("measured") == "longer");  // no such IMU drifts by a kilometre between two fixes
  CHECK(far.at("predicted") == "longer");
  CHECK(far.at("predicted_over_measured").is_null());
  for (const auto& e : log.at("errors")) {
    // Of fewer than twenty errors there are no percentiles.
    CHECK(e.at("measured_m").at("value").is_null() == (e.at("fixes") < 20));
  }
}

TEST_CASE("replay: without truth the withheld fixes tell the errors") {
  const Outcome run = leeway(replay("--metric drms"));
  CHECK(run.exit_code == 0);
  CHECK(contains(run.out, "errors against withheld fixes"));
  CHECK(contains(run.out, "predicted / measured"));
}

TEST_CASE("replay: a folder of drives is each of them, and they are pooled") {
  const TempDir dir;
  make_drives(dir, {"b", "a"});
  const std::string command = "replay " + Simulated::imu_model() +
                              " --gnss-correlation-s 0 --phases 1 --settle-s 60 --json --drive " +
                              quoted(dir / "");
  const Outcome run = leeway(command);
  REQUIRE(run.exit_code == 0);
  const auto results = run.json().at("results");
  REQUIRE(results.at("logs").size() == 2);
  CHECK(results.at("logs").at(0).at("log") == "a");
  CHECK(results.at("logs").at(1).at("log") == "b");
  const auto& one = results.at("logs").at(0).at("errors");
  const auto& both = results.at("pooled").at("errors");
  CHECK(both.at(0).at("fixes").get<int>() == 2 * one.at(0).at("fixes").get<int>());
  // Of the same log twice every quantile is the same.
  CHECK(both.at(0).at("measured_m").at("value") == one.at(0).at("measured_m").at("value"));
  CHECK(results.at("intervals_over_logs").at(0).at("intervals_s").size() == 2);
  if (!has_mpi()) return;
  CHECK(leeway(command, mpirun(2)).out == run.out);
}

TEST_CASE("replay: exit code 2 where a log has no solution, 1 where nothing can be computed") {
  const TempDir dir;
  auto fixes = lines_of(simulated().gnss);
  fixes.resize(2);
  dir.file("gnss.csv", text_of(fixes));
  const std::string logs = "replay --imu " + quoted(simulated().imu) + " --gnss ";
  const Outcome none = leeway(logs + quoted(dir / "gnss.csv"));
  CHECK(none.exit_code == 2);
  CHECK(contains(none.out, "no solution"));
  CHECK(contains(none.err, "no solution: "));  // and why
  const Outcome grows = leeway(logs + quoted(simulated().gnss) + " --limit 5m+5%");
  CHECK(grows.exit_code == 1);
  CHECK(contains(grows.err, "limits that do not grow with the way: give metres alone"));
  const Outcome nothing = leeway("replay");
  CHECK(nothing.exit_code == 1);
  CHECK(contains(nothing.err, "wanted: --imu and --gnss, or --drive"));
}

}  // namespace leeway::test
