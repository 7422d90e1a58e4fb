#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>

#include "leeway/sim/tools/ranks.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/pages/report.hpp"
#include "sim/tools/closest_name.hpp"

namespace {

using namespace leeway::cli;

constexpr const char* kAbout =
    "Loosely coupled INS/GNSS fusion that knows how long it can go without a fix.\n";
constexpr const char* kExitCodes =
    "Exit codes: 0 success; 1 wrong usage or unusable input; 2 finished, but without a solution "
    "or\n"
    "without anything to score it against; 3 a result could not be written.\n"
    "Each command explains itself: leeway fuse --help";

/// CLI11 would only say that a command is missing.
void refuse_unknown_command(const std::vector<std::string>& words) {
  if (words.empty() || words[0].starts_with('-') || commands().contains(words[0])) return;
  std::vector<std::string_view> names;
  for (const auto& [name, add] : commands()) names.push_back(name);
  const std::string meant = leeway::sim::did_you_mean(words[0], names);
  throw CLI::ParseError(fmt::format("unknown command '{}': {}", words[0], meant),
                        CLI::ExitCodes::ExtrasError);
}

/// CLI11 would only list what it did not expect. Empty: every option is one of the command.
std::string unknown_option(const CLI::App& program, const std::vector<std::string>& words) {
  if (words.empty() || !commands().contains(words[0])) return {};
  std::vector<std::string> names;
  for (const CLI::Option* option : program.get_subcommand(words[0])->get_options()) {
    names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
  }
  for (const std::string& word : words) {
    if (!word.starts_with("--") || word.size() == 2) continue;
    const std::string name = word.substr(2, word.find('=') - 2);
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    const std::vector<std::string_view> accepted(names.begin(), names.end());
    const std::string_view meant = leeway::sim::meant_by(name, accepted);
    const std::string hint = meant.empty() ? "" : fmt::format(": did you mean '--{}'?", meant);
    return fmt::format("{} has no option '--{}'{}", words[0], name, hint);
  }
  return {};
}

void tell(const std::string& what) {
  // Under mpirun every rank was given the same wrong words.
  if (!leeway::sim::Ranks::launched_first()) return;
  fmt::print(stderr, "leeway: {} (see leeway --help, leeway COMMAND --help)\n", what);
}

int run(std::vector<std::string> words) {
  CLI::App program(kAbout, "leeway");
  program.set_version_flag("--version", "leeway " LEEWAY_VERSION);
  program.require_subcommand(1);
  program.footer(kExitCodes);
  int exit_code = kSuccess;
  for (const auto& [name, add] : commands()) add(program, exit_code);
  words = with_new_names(std::move(words));
  remember_command_line(words);
  try {
    refuse_unknown_command(words);
    // In reverse, as CLI11 wants them.
    std::vector<std::string> reversed(words.rbegin(), words.rend());
    program.parse(reversed);
  } catch (const CLI::Success& help_or_version) {
    program.exit(help_or_version);
  } catch (const CLI::ExtrasError& error) {
    const std::string option = unknown_option(program, words);
    tell(option.empty() ? error.what() : option);
    return kUnusable;
  } catch (const CLI::ParseError& error) {
    tell(error.what());
    return kUnusable;
  }
  if (!std::cout.flush() || std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw WriteFailure("standard output cannot be written");
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const auto log = spdlog::stderr_logger_st("leeway");
    log->set_pattern("leeway: %l: %v");
    spdlog::set_default_logger(log);
    return run({argv + 1, argv + argc});
  } catch (const WriteFailure& error) {
    fmt::print(stderr, "leeway: {}\n", error.what());
    return kFailure;
  } catch (const leeway::Error& error) {
    fmt::print(stderr, "leeway: {}\n", error.what());
    return kUnusable;
  } catch (const std::exception& error) {
    fmt::print(stderr, "leeway: internal error: {}\n", error.what());
    return kFailure;
  }
}
