#include <doctest/doctest.h>

#include <cstdlib>
#include <string>

#include "tests/sim/cli/program.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::test {
namespace {

/// What a command shows on a pseudo-terminal, standard error included: script(1) is one.
std::string on_terminal(const std::string& arguments, const std::string& environment) {
  const TempDir dir;
  const std::string command = environment + " script -qec \"" + quoted(LEEWAY_PROGRAM) + " " +
                              arguments + "\" /dev/null </dev/null >" + quoted(dir / "seen");
  REQUIRE(std::system(command.c_str()) == 0);
  return read_file(dir / "seen");
}

constexpr char kEscape = '\033';

bool has_colour(const std::string& text) { return contains(text, std::string{kEscape} + "["); }

TEST_CASE("headings are bold on a terminal, and nowhere else") {
  CHECK(has_colour(on_terminal("imu", "env -u NO_COLOR TERM=xterm")));
  CHECK_FALSE(has_colour(on_terminal("imu", "env NO_COLOR=1 TERM=xterm")));
  CHECK_FALSE(has_colour(on_terminal("imu", "env -u NO_COLOR TERM=dumb")));
  CHECK_FALSE(has_colour(leeway("imu", "env -u NO_COLOR TERM=xterm ").out));
}

}  // namespace
}  // namespace leeway::test
