#include <doctest/doctest.h>

#include <string>

#include "tests/sim/cli/mpi.hpp"
#include "tests/sim/cli/program.hpp"

namespace leeway::test {
namespace {

/// Two IMUs at a limit, which trials check.
std::string interval(const std::string& options, int duration_s = 300) {
  return "interval --scene " +
         quoted(std::filesystem::path(LEEWAY_SCENES_DIR) / "square-loop.toml") +
         " --imu tactical,automotive --limit 10 --at " + std::to_string(duration_s) + " " + options;
}

}  // namespace

TEST_CASE("ranks share the trials of intervals, and give the same bytes" *
          doctest::test_suite("heavy")) {
  if (!has_mpi()) {
    MESSAGE("skipped: no mpirun, or built without MPI");
    return;
  }
  for (const char* options : {"--json", "--confirm 10 --confirm-limit 10 --json"}) {
    CAPTURE(options);
    const Outcome alone = leeway(interval(options));
    CHECK(alone.exit_code == 0);
    CHECK(contains(alone.out, "trials"));
    const Outcome shared = leeway(interval(options), mpirun(3));
    CHECK(shared.exit_code == 0);
    CHECK(shared.out == alone.out);
  }
}

TEST_CASE("ranks of intervals that differ end with one message" * doctest::test_suite("heavy")) {
  if (!has_mpi()) {
    MESSAGE("skipped: no mpirun, or built without MPI");
    return;
  }
  const Outcome outcome = leeway(
      interval("--json") + " : -n 1 " + quoted(LEEWAY_PROGRAM) + " " + interval("--json", 200),
      mpirun(1));
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.out.empty());
  CHECK(contains(outcome.err, "leeway: rank 1 has another scene than the first"));
}

}  // namespace leeway::test
