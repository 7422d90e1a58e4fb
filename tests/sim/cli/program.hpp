/// @file
/// Runs the built program as a child process.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/temp_dir.hpp"

namespace leeway::test {

struct Outcome {
  int exit_code{-1};  ///< or minus the signal that ended it
  std::string out{};
  std::string err{};

  /// Standard output as one JSON value. Throws when there is anything else.
  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

/// A path, or other text, as one word of a command line.
inline std::string quoted(const std::filesystem::path& text) { return "'" + text.string() + "'"; }

/// @param before  shell text in front of the program: a pipe into it, a limit
inline Outcome leeway(const std::string& arguments, const std::string& before = "") {
  const TempDir dir;
  const std::string command = before + quoted(LEEWAY_PROGRAM) + " " + arguments + " >" +
                              quoted(dir / "out") + " 2>" + quoted(dir / "err");
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), read_file(dir / "out"),
          read_file(dir / "err")};
}

}  // namespace leeway::test
