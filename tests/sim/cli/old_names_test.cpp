#include <doctest/doctest.h>

#include <string>

#include "tests/sim/cli/program.hpp"

namespace leeway::test {
namespace {

std::string tunnel() { return (std::filesystem::path(LEEWAY_SCENES_DIR) / "tunnel.toml").string(); }

/// The old words do what the new ones do, and say once that they are old.
void check_renamed(const std::string& old_words, const std::string& new_words,
                   const std::string& said) {
  CAPTURE(old_words);
  const Outcome old_run = leeway(old_words);
  const Outcome new_run = leeway(new_words);
  CHECK(new_run.exit_code == 0);
  CHECK(new_run.err.empty());
  CHECK(old_run.exit_code == 0);
  CHECK(old_run.out == new_run.out);
  CHECK(old_run.err == "leeway: note: " + said + "\n");
}

TEST_CASE("commands and options go by their old names too, with a note on standard error") {
  const TempDir dir;
  const std::string analyze = "analyze --scene " + test::quoted(tunnel()) + " --json";
  const std::string table = quoted(dir / "b.csv");
  check_renamed("budget --help", "reduce --help", "budget is now called reduce");
  check_renamed(analyze + " --budget " + table, analyze + " --error-budget " + table,
                "--budget is now called --error-budget");
  check_renamed(analyze + " --budget=" + table, analyze + " --error-budget=" + table,
                "--budget is now called --error-budget");
  CHECK(read_file(dir / "b.csv").starts_with("source,"));
}

TEST_CASE("the old name of a scene's [limit] works, with a note on standard error") {
  const TempDir dir;
  std::string text = read_file(tunnel());
  const auto named = [&dir](const std::string& folder) { return dir / folder / "tunnel.toml"; };
  for (const char* folder : {"new", "old"}) {
    std::filesystem::create_directory(dir / folder);
    dir.file(std::string(folder) + "/tunnel.toml", text);
    if (const auto at = text.find("[limit]"); at != std::string::npos) {
      text.replace(at, 7, "[budget]");
    }
  }
  const std::string command = "interval --json --imu tactical --limit 10 --at 300 --scene ";
  check_renamed(command + quoted(named("old")), command + quoted(named("new")),
                named("old").string() + ": [budget] is now called [limit]");
}

}  // namespace
}  // namespace leeway::test
