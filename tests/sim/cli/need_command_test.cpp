#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/sim/cli/program.hpp"

namespace leeway::test {
namespace {

std::string scene_option(const char* file) {
  return " --scene " + quoted(std::filesystem::path(LEEWAY_SCENES_DIR) / file) + " ";
}

void refused(const std::string& options, const std::string& because) {
  CAPTURE(options);
  const Outcome outcome =
      leeway("interval" + scene_option("static-45.toml") + "--at 1800 " + options);
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.out.empty());
  CAPTURE(outcome.err);
  CHECK(outcome.err.find(because) != std::string::npos);
}

}  // namespace

TEST_CASE("interval --need: factors, candidates and elasticities, as the contract says") {
  const std::string command =
      "interval" + scene_option("static-45.toml") + "--at 1800 --imu tactical ";
  const auto object = leeway(command + "--need 100s --limit 10m --json").json();
  CHECK(object.at("command") == "interval");
  REQUIRE(object.at("results").size() == 1);
  const auto& row = object.at("results")[0];
  CHECK(row.at("imu") == "tactical/mid");
  CHECK(row.at("need_s") == 100.0);
  CHECK(row.at("limit_m") == 10.0);
  CHECK(row.at("keeps_limit") == false);
  for (const auto& factor : row.at("factors")) {
    CHECK(factor.at("factor").is_null() == (factor.at("outcome") != "factor"));
    CHECK(factor.at("error_m") > 0.0);
  }
  CHECK(row.at("factors").back().at("specification") == "receiver");
  CHECK(row.at("candidates").size() == 35);
  CHECK(row.at("growth") > 1.0);
  CHECK(row.at("elasticities")[0].at("of_interval") < 0.0);
  const auto minutes = leeway(command + "--need 1.6666666666666667min --limit 10m --json").json();
  CHECK(std::abs(minutes.at("results")[0].at("need_s").get<double>() - 100.0) < 1e-9);
  CHECK(minutes.at("results")[0].at("limit_m") == 10.0);
}

TEST_CASE("interval --need: says which IMUs to buy, and when none will do") {
  const std::string command =
      "interval" + scene_option("static-45.toml") + "--at 1800 --need 100s ";
  const Outcome some = leeway(command + "--limit 10m");
  CHECK(some.exit_code == 0);
  CHECK(some.out.find("parts and classes keep the limit") != std::string::npos);
  CHECK(some.out.find("iNAV-RQH") != std::string::npos);
  const Outcome none = leeway(command + "--limit 0.1m");
  CHECK(none.exit_code == 0);
  CHECK(none.out.find("0 of 35") != std::string::npos);
  CHECK(none.out.find("a better receiver, a shorter interval") != std::string::npos);
}

TEST_CASE("interval --need: wrong needs are refused with what to write instead") {
  refused("--need 0", "0 is not above 0");
  refused("--need '60 kg'", "'kg' is no unit of it: wanted a time between fixes, such as 60s");
  refused("--need sixty", "'sixty' is no number");
  refused("--need 1h", "must be at most 900 s, the longest that this scene can be asked for");
  refused("--need 1h", "--at 7200");
  refused("--need 60 --limit 5kg", "5kg");
  refused("--need 60 --confirm 3", "excludes");
}

}  // namespace leeway::test
