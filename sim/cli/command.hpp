/// @file
/// The commands of the program. A file in commands/ that defines a Command is all that one takes.
#pragma once

// The whole of <CLI/CLI.hpp> is in command.cpp alone: it compiles the help and the configuration
// files of CLI11 into each source that includes it.
#include <CLI/App.hpp>
#include <functional>
#include <map>
#include <memory>

#include "sim/cli/answer.hpp"

namespace leeway::cli {

/// What the program exits with. kept in step with docs/guide/cli.md
enum ExitCode : int {
  kSuccess = 0,
  kUnusable = 1,  ///< wrong usage or unusable input: nothing was computed
  kNoAnswer = 2,  ///< finished, but no solution, or nothing to score it against
  kFailure = 3,   ///< a result could not be written, or a defect of the program
};

/// Adds a command to the program. When run, it sets the exit code or throws.
using AddCommand = std::function<void(CLI::App& program, int& exit_code)>;

/// Every command by its name.
std::map<std::string, AddCommand>& commands();

/// Puts a command among commands().
/// @param prepare  adds the options to the command and gives what runs it
void define_command(const char* name, const char* about, const char* footer,
                    std::function<std::function<int()>(CLI::App&)> prepare);

/// A command, defined once at namespace scope: that puts it among commands().
/// @tparam Options  the type of what run() takes
template <class Options>
struct Command {
  /// @param about        a line in the help of the program
  /// @param footer       the end of the command's own help: remarks and examples
  /// @param add_options  tells what the options are and where they go
  /// @param run          gives the exit code, or throws
  Command(const char* name, const char* about, const char* footer,
          void (*add_options)(CLI::App&, Options&), int (*run)(const Options&)) {
    define_command(name, about, footer, [=](CLI::App& app) {
      const auto options = std::make_shared<Options>();
      add_options(app, *options);
      return [run, options] { return run(*options); };
    });
  }
};

/// The words of a command line, with the names of today in place of those that commands and options
/// had in earlier versions. A note on stderr tells of each old one.
std::vector<std::string> with_new_names(std::vector<std::string> words);

}  // namespace leeway::cli
