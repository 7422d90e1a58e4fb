#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "tests/sim/cli/program.hpp"

namespace leeway::test {

TEST_CASE("atlas --list names every scene and runs none") {
  const Outcome outcome = leeway("atlas --list");
  CHECK(outcome.exit_code == 0);
  for (const char* key : {"positive-definiteness", "parked-rtk", "frozen-transition"}) {
    CAPTURE(key);
    CHECK(contains(outcome.out, key));
  }
}

TEST_CASE("atlas --json, --csv and --markdown: the contract") {
  const TempDir dir;
  const auto object = leeway("atlas --short --scene dead-row,frozen-transition --json --csv " +
                             quoted(dir / "cells.csv") + " --markdown " + quoted(dir / "page.md"))
                          .json();
  CHECK(object.at("command") == "atlas");
  CHECK(object.at("input").at("short") == true);
  CHECK(object.at("results").at("unexpected").empty());
  const auto& cells = object.at("results").at("cells");
  REQUIRE(cells.size() > 60);
  for (const auto& cell : cells) {
    CAPTURE(cell.dump());
    CHECK(cell.at("silent") == false);
    const std::string verdict = cell.at("verdict");
    CHECK((verdict == "survives" || verdict == "degrades" || verdict == "fails"));
    // In these two scenes nothing fails but what is not offered.
    CHECK((verdict == "fails") == (cell.at("group") == "not offered"));
  }
  const std::string csv = read_file(dir / "cells.csv");
  CHECK(csv.starts_with("form,scene,variant,condition,verdict,figure,reported\nshort,"));
  CHECK(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')) == cells.size() + 1);
  CHECK(contains(read_file(dir / "page.md"), "# The failure atlas"));
}

TEST_CASE("atlas --mismatch --json and --write: the contract") {
  const TempDir dir;
  const Outcome outcome =
      leeway("atlas --mismatch --short --trials 1 --json --write " + quoted(dir / "page.md"));
  const auto object = outcome.json();
  CHECK(object.at("input").at("trials") == 1);
  const auto& summary = object.at("results").at("summary");
  const auto& cells = object.at("results").at("cells");
  CHECK(summary.at("cells") == cells.size());
  CHECK(summary.at("trials") == cells.size());
  const bool holds = summary.at("lost") == 0 && summary.at("outside") == 0;
  CHECK(outcome.exit_code == (holds ? 0 : 2));
  for (const auto& cell : cells) {
    CAPTURE(cell.dump());
    CHECK(cell.at("horizontal_rms_m") > 0.0);
    CHECK(cell.at("ratio") > 0.0);
  }
  const std::string page = read_file(dir / "page.md");
  CHECK(contains(page, "# IMUs that the navigator does not know"));
  CHECK(contains(page, "| MPU-9250 |"));
}

TEST_CASE("atlas refuses what it cannot do, and says what to do") {
  const Outcome unknown = leeway("atlas --scene dead-rows");
  CHECK(unknown.exit_code == 1);
  CHECK(contains(unknown.err, "did you mean 'dead-row'?"));
  for (const char* options :
       {"--threads -1", "--trials 3", "--mismatch --faults", "--mismatch --trials 0",
        "--write x.md", "--short --write-expected x.csv", "--csv"}) {
    CAPTURE(options);
    const Outcome outcome = leeway(std::string("atlas ") + options);
    CHECK(outcome.exit_code == 1);
    CHECK(contains(outcome.err, "leeway: "));
    CHECK(outcome.out.empty());
  }
}

TEST_CASE("atlas: a file that cannot be written is no success") {
  const TempDir dir;
  const Outcome outcome =
      leeway("atlas --short --scene dead-row --csv " + quoted(dir / "none" / "cells.csv"));
  CHECK(outcome.exit_code == 3);
  CHECK(contains(outcome.err, "cannot be written: No such file or directory"));
}

}  // namespace leeway::test
