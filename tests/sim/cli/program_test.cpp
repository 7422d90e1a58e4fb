#include "tests/sim/cli/program.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <iterator>

#include "tests/sim/cli/simulated.hpp"

namespace leeway::test {
namespace {

TEST_CASE("help and version succeed, on standard output alone") {
  for (const char* arguments :
       {"--help", "--version", "analyze --help", "atlas --help", "campaign --help",
        "compare --help", "drift --help", "fuse --help", "imu --help", "interval --help",
        "reduce --help", "simulate --help"}) {
    CAPTURE(arguments);
    const Outcome outcome = leeway(arguments);
    CHECK(outcome.exit_code == 0);
    CHECK(!outcome.out.empty());
    CHECK(outcome.err.empty());
  }
}

TEST_CASE("help names every option with its unit and an example") {
  const struct {
    const char* command;
    std::vector<const char*> texts;
  } cases[] = {
      {"drift", {"--trials", "--seed", "--latitude DEG", "--imu-rate-hz HZ", "--curves", "--json"}},
      {"simulate",
       {"--trajectory", "square-loop", "--duration-s", "--imu-rate-hz", "--imu-class", "--range",
        "--imu-model", "--gnss-interval-s", "--gnss-sigma-h-m", "--gnss-sigma-v-m",
        "--gnss-sigma-velocity-mps", "--gnss-correlated-sigma-m", "--gnss-correlation-s", "--lever",
        "--seed", "--truth-rate-hz", "--out", "--gzip", "--json"}},
      {"fuse",
       {"--imu",
        "--gnss",
        "--truth",
        "--truth-window",
        "--mount",
        "--mount-axes",
        "--lever",
        "--imu-class",
        "--range",
        "--imu-model",
        "--outages",
        "--out",
        "--out-rate-hz",
        "--drive",
        "--json",
        "--gnss-correlation-s",
        "--gate",
        "--scheme",
        "--verbose",
        "--gnss-sigma-scale",
        "deg",
        "--rate-meaning",
        "--covariance-interval-s"}}};
  for (const auto& c : cases) {
    const std::string help = leeway(std::string(c.command) + " --help").out;
    CHECK(contains(help, "leeway " + std::string(c.command) + " --"));
    for (const char* text : c.texts) {
      CAPTURE(text);
      CHECK(contains(help, text));
    }
  }
}

TEST_CASE("wrong usage exits with 1 and one line that names what is wrong") {
  const std::string fuse = simulated().fuse();
  const struct {
    std::string arguments;
    const char* named;
  } cases[] = {
      {"", "subcommand"},
      {"flie", "did you mean 'fuse'?"},
      {"campaign --scene x --first-seed -1", "--first-seed: -1 is below 0"},
      {"campaign --scene x --limit -3", "must be 0.01 to 100000 m"},
      {"drift --trials many", "--trials"},
      {"drift --trials 1", "trials"},
      {"drift --latitude 91", "latitude"},
      {"simulate --out x", "--trajectory"},
      {"simulate --trajectory spiral --out x", "spiral"},
      {"simulate --trajectory car --duration-s=-1 --out x", "--duration-s"},
      {"simulate --trajectory car --gnss-sigma-h-m=-1 --out x", "sigma"},
      {"fuse", "--imu"},
      {"fuse --imu x.csv", "--gnss"},
      {fuse + " --mount 1,2", "1,2"},
      {fuse + " --mount 1,2,3,4", "ROLL,PITCH,YAW"},
      {fuse + " --mount 1,2,x", "1,2,x"},
      {fuse + " --mount 1,2,nan", "1,2,nan"},
      {fuse + " --mount-axes fru", "fru"},
      {fuse + " --lever 1", "X,Y,Z"},
      {fuse + " --truth-window 100,50 --truth x", "truth window"},
      {fuse + " --imu-model m.toml", "--imu-model"},
      {"fuse --imu-class nautical --imu x --gnss y", "nautical"},
      {"fuse --range low --imu x --gnss y", "--imu-class"},
      {fuse + " --scheme magic", "magic"},
      {fuse + " --rate-meaning median", "median"},
      {fuse + " --gate 2", "gate"},
      {fuse + " --align-speed-mps 0", "min_speed_mps"},
      {fuse + " --covariance-interval-s=-1", "covariance"},
      {fuse + " --gnss-sigma-scale 0,1", "scale"},
      {fuse + " --drive x", "--drive"},
      {fuse + " --vehicle truck", "truck"},
      {fuse + " --without non-holonomic", "--vehicle car"},
      {fuse + " --vehicle car --without wheels", "wheels"},
      {fuse + " --odometer x", "--vehicle car"},
      {fuse + " --vehicle car --start-heading-deg 10", "give --mount"},
      {fuse + " --start-heading-deg 400", "start-heading-deg"},
      {fuse + " --start-heading-sigma-deg 4", "start-heading-deg"},
      {fuse + " --estimate-mount --mount 0,0,0", "--mount"},
      {fuse + " --velocity-lag-s 100", "velocity_lag_s"},
  };
  for (const auto& c : cases) {
    CAPTURE(c.arguments);
    const Outcome outcome = leeway(c.arguments);
    CAPTURE(outcome.err);
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.starts_with("leeway: "));
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    CHECK(contains(outcome.err, c.named));
  }
}

TEST_CASE("a result that cannot be written exits with 3 and leaves nothing behind") {
  const TempDir dir;
  const auto a_file = dir.file("a_file", "");
  const std::string nowhere = quoted(dir / "no/such/folder/x.csv");
  for (const std::string& arguments :
       {"drift --trials 2 --imu-rate-hz 1 --curves " + nowhere,
        "simulate --trajectory static --duration-s 2 --out " + quoted(a_file),
        simulated().fuse() + " --out " + nowhere}) {
    CAPTURE(arguments);
    const Outcome outcome = leeway(arguments);
    CHECK(outcome.exit_code == 3);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.starts_with("leeway: "));
  }
  // A file size limit stands for a disk that fills up half-way.
  const Outcome full = leeway(simulated().fuse() + " --out " + quoted(dir / "solution.csv"),
                              "trap '' XFSZ; ulimit -f 100; ");
  CHECK(full.exit_code == 3);
  CHECK(contains(full.err, "solution.csv"));
  CHECK(std::distance(std::filesystem::directory_iterator(dir / ""), {}) == 1);
}

TEST_CASE("standard output that cannot be written exits with 3") {
  const int status =
      std::system((quoted(LEEWAY_PROGRAM) + " --version >/dev/full 2>/dev/null").c_str());
  CHECK(WEXITSTATUS(status) == 3);
}

}  // namespace
}  // namespace leeway::test
