#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/sim/cli/program.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::test {
namespace {

std::string scene(const char* file) {
  return " --scene " + quoted(std::filesystem::path(LEEWAY_SCENES_DIR) / file) + " ";
}

}  // namespace

TEST_CASE("interval: five classes by five limits, as the contract says" *
          doctest::test_suite("heavy")) {
  const auto object =
      leeway("interval" + scene("square-loop.toml") + "--at 3600 --no-check --json").json();
  CHECK(object.at("command") == "interval");
  const auto& results = object.at("results");
  REQUIRE(results.size() == 25);
  for (const auto& row : results) {
    CHECK(row.at("range") == "mid");
    CHECK(row.at("motion") == "square loop");
    CHECK(row.at("bias_model") == "constant");
    CHECK(row.at("metric") == "drms");
    CHECK(row.at("interval_s") > 0.1);
    CHECK(row.at("confirm").is_null());
    CHECK(row.at("consistent").is_null());
    CHECK(row.at("mark") == "linear");
    CHECK(row.at("answer_s") == row.at("interval_s"));
    // The step of 1 s must cost less than 0.5 %.
    CHECK(row.at("covariance_step_effect") < 0.005);
    CHECK(row.at("error_m") <= row.at("limit_m"));
  }
  CHECK(results[0].at("imu") == "marine");
  CHECK(results[24].at("imu") == "automotive");
}

TEST_CASE("interval: one cell of the reference, by class, range, bias, metric, limit and mark" *
          doctest::test_suite("heavy")) {
  const auto cell = [](const std::string& options) {
    return leeway("interval" + scene("square-loop.toml") + options + " --no-check --json")
        .json()
        .at("results")
        .at(0);
  };
  const auto drms = cell("--imu tactical --range mid --bias gauss_markov --metric drms --limit 10");
  CHECK(std::abs(drms.at("interval_s").get<double>() / 42.0 - 1.0) < 0.06);
  CHECK(drms.at("bias_model") == "gauss_markov");
  const auto r95 = cell("--imu tactical --bias gauss_markov --metric r95 --limit 17.3");
  CHECK(r95.at("metric") == "r95");
  // R95 is about 1.73 DRMS; the axes differ a little.
  CHECK(std::abs(r95.at("interval_s").get<double>() / drms.at("interval_s").get<double>() - 1.0) <
        0.03);
  const auto earlier = cell("--imu tactical --limit 10 --at 3600");
  const auto later = cell("--imu tactical --limit 10 --at 86400");
  CHECK(earlier.at("interval_s") < later.at("interval_s"));
  const auto at_rest =
      leeway("interval" + scene("static-45.toml") + "--imu marine --limit 100 --no-check --json")
          .json()
          .at("results")
          .at(0);
  CHECK(std::abs(at_rest.at("free_inertial_s").get<double>() - 1237.0) < 3.0);
}

TEST_CASE("interval --confirm: the Monte Carlo stands beside the answer" *
          doctest::test_suite("heavy")) {
  const auto row = leeway("interval" + scene("square-loop.toml") +
                          "--imu tactical --limit 3 --at 900 --confirm 20 --json")
                       .json()
                       .at("results")
                       .at(0);
  CHECK(row.at("confirm").at("trials") == 20);
  // Four deviations of the RMS of 20 trials.
  CHECK(std::abs(row.at("confirm").at("rms_over_sigma").get<double>() - 1.0) < 0.45);
  CHECK(row.at("confirm").at("nees") > 10.0);
  CHECK(row.at("confirm").at("nees") < 22.0);
  CHECK(row.at("consistent") == true);
  CHECK(row.at("confirm").at("monte_carlo_interval_s").is_null());
}

TEST_CASE("interval: an EKF that is not consistent is said not to be" *
          doctest::test_suite("heavy")) {
  // The reference: automotive at rest claims 4.6 deg of heading where it errs by 66.
  const auto row = leeway("interval" + scene("static-45.toml") +
                          "--imu automotive --limit 3 --at 1800 --confirm 20 --json")
                       .json()
                       .at("results")
                       .at(0);
  CHECK(row.at("consistent") == false);
}

TEST_CASE(
    "interval: where trials are lost at the answer, a shorter one is found that keeps the limit" *
    doctest::test_suite("heavy")) {
  // 2026-11-28: the search drew secants through errors of lost filters, and found nothing. The
  // filter alone, from a cold start: the navigator is not lost here.
  const TempDir dir;
  std::ifstream file(std::filesystem::path(LEEWAY_SCENES_DIR) / "town-car.toml");
  std::string text(std::istreambuf_iterator<char>(file), {});
  const std::string vehicle = "[vehicle]\nkind = \"car\"\n";
  text.erase(text.find(vehicle), vehicle.size());
  const auto cold = dir.file("cold.toml", text);
  const auto row = leeway("interval --scene " + quoted(cold) +
                          " --imu automotive-mems --limit 10 --at 900 --confirm 6 --json")
                       .json()
                       .at("results")
                       .at(0);
  REQUIRE(row.at("confirm").at("diverged") > 0);
  CHECK(row.at("mark") == "by trials");
  const auto& found_s = row.at("answer_s");
  REQUIRE(found_s.is_number());
  CHECK(found_s > 1.0);  // fixes every second keep it by far
  CHECK(found_s < row.at("interval_s"));
}

TEST_CASE("interval: the scene's own question is checked, whatever else is asked" *
          doctest::test_suite("heavy")) {
  const auto rows =
      leeway("interval" + scene("town-car.toml") + "--imu automotive-mems --limit 10,30 --json")
          .json();
  const auto& own = rows.at("results").at(0);
  CHECK(own.at("mark") != "linear");
  CHECK(own.at("confirm").at("trials") >= 8);
  // The navigator errs as the linear analysis says, by so much as 8 to 32 trials can tell.
  CHECK(std::abs(own.at("confirm").at("error_over_true").get<double>() - 1.0) < 0.2);
  const auto alone = leeway("interval" + scene("town-car.toml") +
                            "--imu automotive-mems --limit 10 --no-check --json")
                         .json()
                         .at("results")
                         .at(0);
  CHECK(alone.at("interval_s") == own.at("interval_s"));
}

TEST_CASE("interval: a bias model is said of the classes, not of the scene's own part" *
          doctest::test_suite("heavy")) {
  // 2026-12-01: the own scene was refused, for an in-run drift that its part states.
  const auto rows = leeway("interval" + scene("town-car.toml") +
                           "--bias gauss_markov --limit 100 --at 600 --no-check --json")
                        .json()
                        .at("results");
  REQUIRE(rows.size() == 6);
  CHECK(rows[0].at("bias_model") == "gauss_markov");
  CHECK(rows[5].at("imu") == "automotive-mems");
}

TEST_CASE("interval: a scene with outages is asked for their ends and the coast time" *
          doctest::test_suite("heavy")) {
  const auto answer = leeway("interval" + scene("tunnel-60s.toml") + "--json").json();
  CHECK(answer.at("results").empty());
  for (const auto& row : answer.at("outages")) {
    CHECK(row.at("duration_s") == 60.0);
    const bool keeps = row.at("end_error_m") <= row.at("limit_m");
    CHECK(row.at("keeps_limit") == keeps);
    // The scene ends with the outage: a limit that is kept is not reached.
    if (keeps) CHECK(row.at("coast_s").is_null());
    if (!keeps) CHECK(row.at("coast_s") < 61.5);
  }
}

TEST_CASE("interval prints one table, the paper's conclusion and what the step costs" *
          doctest::test_suite("heavy")) {
  const Outcome outcome = leeway("interval" + scene("town-car.toml") + "--no-check");
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
  for (const char* text :
       {"marine/mid", "automotive/mid", "automotive-mems", "100 m", "How often a fix is needed",
        "covariance analysis in steps of 1 s", "more than once a minute"}) {
    CAPTURE(text);
    CHECK(contains(outcome.out, text));
  }
}

TEST_CASE("interval: limits that grow, presets with their source, metrics") {
  const auto loop = [](const std::string& options) {
    return leeway("interval" + scene("square-loop.toml") + "--imu tactical --at 900 --no-check " +
                  options + " --json")
        .json();
  };
  const auto growing = loop("--metric along95 --limit 5m+5%,30");
  REQUIRE(growing.at("results").size() == 2);
  const auto& first = growing.at("results").at(0);
  CHECK(first.at("limit") == "5m+5%");
  CHECK(first.at("limit_m") == 5.0);
  CHECK(first.at("share") == 0.05);
  CHECK(first.at("metric") == "along95");
  CHECK(first.at("error_m") <= first.at("allowed_m"));
  CHECK(growing.at("results").at(1).at("limit") == "30m");
  CHECK(growing.at("results").at(1).at("share") == 0.0);
  CHECK(growing.at("input").at("preset").is_null());
  const auto preset = loop("--preset etcs-odometry");
  REQUIRE(preset.at("results").size() == 1);
  CHECK(preset.at("results").at(0).at("interval_s") == first.at("interval_s"));
  CHECK(preset.at("results").at(0).at("metric") == "along95");
  CHECK(preset.at("input").at("preset") == "etcs-odometry");
  CHECK(contains(preset.at("input").at("limit_source").get<std::string>(), "SUBSET-041"));
  const Outcome table = leeway("interval" + scene("square-loop.toml") +
                               "--imu tactical --at 900 --no-check --preset imo-b");
  CHECK(contains(table.out, "Limit imo-b: IMO MSC.1/Circ.1575"));
  CHECK(contains(table.out, "horizontal error (r95)"));
  const Outcome list = leeway("interval --preset list");
  CHECK(list.exit_code == 0);
  CHECK(contains(list.out, "rnp-0.3"));
  CHECK(contains(list.out, "5m+5%"));
}

TEST_CASE("interval: wrong input is refused with what to do") {
  const auto refused = [](const std::string& arguments, const char* why) {
    const Outcome outcome = leeway("interval " + arguments);
    CAPTURE(outcome.err);
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.out.empty());
    CHECK(contains(outcome.err, why));
  };
  refused("", "--scene is required");
  refused("--scene nowhere.toml", "nowhere.toml");
  refused(scene("square-loop.toml") + "--imu marin", "marine");
  refused(scene("square-loop.toml") + "--limit -3", "--limit");
  refused(scene("square-loop.toml") + "--limit 5ft", "'5ft' is no limit: write metres");
  refused(scene("square-loop.toml") + "--limit 5m+5", "as in 5m+5%");
  refused(scene("square-loop.toml") + "--preset rnp-7", "rnp-10");
  refused(scene("square-loop.toml") + "--preset rnp-1 --limit 5", "excludes");
  refused(scene("square-loop.toml") + "--limit 10 --confirm 2 --confirm-limit 3", "which are 10m");
  refused(scene("square-loop.toml") + "--range middle", "--range");
}

TEST_CASE("analyze: claimed, true and the error budget, which adds up") {
  const TempDir dir;
  const auto results =
      leeway("analyze" + scene("town-car.toml") + "--out " + quoted(dir / "moments.csv") +
             " --error-budget " + quoted(dir / "budget.csv") + " --json")
          .json()
          .at("results");
  double share = 0.0;
  for (const auto& line : results.at("budget")) share += line.at("horizontal_share").get<double>();
  CHECK(std::abs(share - 1.0) < 1e-12);
  CHECK(results.at("true_m") > 0.0);
  CHECK(std::abs(results.at("optimistic_by").get<double>() -
                 results.at("true_m").get<double>() / results.at("claimed_m").get<double>()) <
        1e-12);
  const std::string moments = read_file(dir / "moments.csv");
  CHECK(moments.starts_with("t_s,moment,claimed_n_m,"));
  // Every second of the scene, and twice more at every fix.
  CHECK(std::count(moments.begin(), moments.end(), '\n') > 1800);
  const std::string error_budget = read_file(dir / "budget.csv");
  CHECK(error_budget.starts_with("source,north_m,east_m,down_m,horizontal_m2,horizontal_share\n"));
  CHECK(contains(error_budget, "\ntotal,"));
}

TEST_CASE("analyze: the reference's table, by command line") {
  const auto drms_m = [](const std::string& options) {
    return leeway("analyze" + scene("square-loop.toml") + options + " --json")
        .json()
        .at("results")
        .at("true_m")
        .get<double>();
  };
  CHECK(std::abs(drms_m("--imu marine --interval-s 300") / 10.6 - 1.0) < 0.02);
  CHECK(std::abs(drms_m("--imu tactical --interval-s 60") / 10.3 - 1.0) < 0.02);
}

TEST_CASE("analyze: a file that cannot be written is refused and leaves nothing") {
  const Outcome outcome =
      leeway("analyze" + scene("square-loop.toml") + "--at 600 --out /nowhere/moments.csv");
  CHECK(outcome.exit_code == 3);
  CHECK(contains(outcome.err, "/nowhere/moments.csv"));
}

}  // namespace leeway::test
