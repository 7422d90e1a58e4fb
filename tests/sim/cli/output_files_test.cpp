#include <doctest/doctest.h>
#include <sys/stat.h>

#include <string>
#include <vector>

#include "tests/sim/cli/program.hpp"
#include "tests/sim/cli/simulated.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::test {

TEST_CASE("2026-12-01: no output replaces an input, another output, or what is no file") {
  const TempDir dir;
  const auto scene = dir.file("scene.toml", read_file(LEEWAY_SCENES_DIR "/tunnel.toml"));
  const auto fifo = dir / "fifo";
  REQUIRE(mkfifo(fifo.c_str(), 0600) == 0);
  const auto page = quoted(dir / "page.html");
  const std::string before = read_file(simulated().gnss);
  for (const std::string& words :
       {simulated().fuse() + " --out " + quoted(simulated().gnss),
        "analyze --scene " + quoted(scene) + " --out " + page + " --error-budget " + page,
        simulated().fuse() + " --out " + quoted(fifo), simulated().fuse() + " --out /dev/null",
        simulated().fuse() + " --out " + quoted(dir / ""),
        "analyze --scene " + quoted(scene) + " --out " + quoted(scene),
        std::string("drift --trials 2 --imu-rate-hz 1 --curves /dev/null")}) {
    CAPTURE(words);
    const Outcome outcome = leeway(words);
    CHECK(outcome.exit_code == 1);
    CHECK(contains(outcome.err, "choose another"));
    CHECK(outcome.out.empty());
  }
  CHECK(read_file(simulated().gnss) == before);
  CHECK(std::filesystem::is_fifo(fifo));
  CHECK(std::filesystem::is_character_file("/dev/null"));
  CHECK_FALSE(std::filesystem::exists(dir / "page.html"));
}

TEST_CASE("simulate asks before it replaces logs") {
  const TempDir dir;
  const std::string words = "simulate --trajectory static --duration-s 2 --out " + quoted(dir / "");
  CHECK(leeway(words).exit_code == 0);
  const Outcome again = leeway(words);
  CHECK(again.exit_code == 1);
  CHECK(contains(again.err, "--force"));
  CHECK(leeway(words + " --gzip").exit_code == 1);
  CHECK(leeway(words + " --force").exit_code == 0);
}

TEST_CASE("a signal leaves no part of a file") {
  const TempDir dir;
  const std::string words =
      "simulate --trajectory car --duration-s 100000 --out " + quoted(dir / "");
  // The shell's timeout sends SIGINT, as Ctrl-C does, and SIGTERM.
  for (const char* signal : {"INT", "TERM"}) {
    const Outcome outcome = leeway(words, std::string("timeout -s ") + signal + " 1 ");
    CHECK(outcome.exit_code != 0);
    CHECK(std::filesystem::is_empty(dir / ""));
  }
}

TEST_CASE("a solution is written in the form that its ending, or --out-format, names") {
  const TempDir dir;
  struct Case {
    std::string words, begins;
  };
  const std::vector<Case> cases{
      {"a.pos", "% program"},
      {"a.kml", "<?xml"},
      {"a.geojson", "{\"type\""},
      {"a.txt --out-format gpx", "<?xml"},
      {"a.csv --out-columns yaw_deg,up_m --origin 56,92.8,0", "t_s,yaw_deg,up_m\n"}};
  for (const Case& c : cases) {
    CAPTURE(c.words);
    const std::string file = c.words.substr(0, c.words.find(' '));
    CHECK(leeway(simulated().fuse() + " --out " + (dir / c.words).string()).exit_code == 0);
    CHECK(read_file(dir / file).starts_with(c.begins));
  }
  const std::string out = simulated().fuse() + " --out " + (dir / "b.csv").string();
  for (const char* wrong : {" --out-format kmz", " --out-columns yaw", " --origin 91,0,0"}) {
    const Outcome outcome = leeway(out + wrong);
    CHECK(outcome.exit_code == 1);
    CHECK_FALSE(std::filesystem::exists(dir / "b.csv"));
  }
}

}  // namespace leeway::test
