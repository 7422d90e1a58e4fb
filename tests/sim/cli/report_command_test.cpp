#include <doctest/doctest.h>

#include <string>

#include "tests/sim/cli/simulated.hpp"

namespace leeway::test {
namespace {

std::string analysis() {
  return "analyze --scene " + quoted(std::filesystem::path(LEEWAY_SCENES_DIR) / "tunnel.toml");
}

/// The program may be built without Node.js.
bool has_page() {
  const TempDir dir;
  const Outcome run = leeway(analysis() + " --report " + quoted(dir / "report.html"));
  if (run.exit_code == 0) return true;
  CHECK(run.exit_code == 1);
  CHECK(run.err.find("npm") != std::string::npos);
  CHECK(run.out.empty());
  return false;
}

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++count;
  return count;
}

}  // namespace

TEST_CASE("report: one file that names command, version and input, beside the usual output") {
  if (!has_page()) return;
  const TempDir dir;
  const Outcome plain = leeway(analysis() + " --json");
  const Outcome both = leeway(analysis() + " --json --report " + quoted(dir / "report.html"));
  CHECK(both.exit_code == 0);
  CHECK(both.out == plain.out);
  const std::string page = read_file(dir / "report.html");
  CHECK(page.starts_with("<!doctype html>"));
  CHECK(page.find("leeway analyze --scene") != std::string::npos);
  CHECK(page.find("\"scene\":\"tunnel\"") != std::string::npos);
  CHECK(page.find("/* report */") == std::string::npos);
  CHECK(page.size() < 400'000);  // the page, and little data
}

TEST_CASE("report: nothing that is written into it can end its script") {
  if (!has_page()) return;
  const TempDir dir;
  const std::filesystem::path hostile = dir / "<script>alert('1');<";
  std::filesystem::create_directories(hostile);
  std::filesystem::copy_file(std::filesystem::path(LEEWAY_SCENES_DIR) / "tunnel.toml",
                             hostile / "scene.toml");
  const auto report_of = [&dir](const std::string& scene_path) {
    const auto report = dir / "report.html";
    std::string shell_word = scene_path;
    for (std::size_t at = 0; (at = shell_word.find('\'', at)) != std::string::npos; at += 4) {
      shell_word.replace(at, 1, "'\\''");
    }
    REQUIRE(leeway("analyze --scene '" + shell_word + "' --report " + quoted(report)).exit_code ==
            0);
    return read_file(report);
  };
  const std::string usual =
      report_of((std::filesystem::path(LEEWAY_SCENES_DIR) / "tunnel.toml").string());
  CHECK(count_of(report_of((hostile / "scene.toml").string()), "<script") ==
        count_of(usual, "<script"));
}

TEST_CASE("report: where it cannot be written, exit code 3 and no part of it") {
  if (!has_page()) return;
  const TempDir dir;
  const Outcome run = leeway(analysis() + " --report " + quoted(dir / "missing/report.html"));
  CHECK(run.exit_code == 3);
  CHECK(run.err.find("cannot be written: No such file or directory") != std::string::npos);
  CHECK(!std::filesystem::exists(dir / "missing"));
}

}  // namespace leeway::test
