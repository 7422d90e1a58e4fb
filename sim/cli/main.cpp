#include <spdlog/fmt/fmt.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <exception>
#include <iostream>

#include "leeway/sim/tools/ranks.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/pages/report.hpp"

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
void refuse_unknown_command(const CLI::App& program, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  const auto named = [argv](const CLI::App* command) { return command->check_name(argv[1]); };
  if (!program.get_subcommands(named).empty()) return;
  throw CLI::ParseError(fmt::format("unknown command '{}'", argv[1]), CLI::ExitCodes::ExtrasError);
}

int run(int argc, char** argv) {
  CLI::App program(kAbout, "leeway");
  program.set_version_flag("--version", "leeway " LEEWAY_VERSION);
  program.require_subcommand(1);
  program.footer(kExitCodes);
  int exit_code = kSuccess;
  remember_command_line(argc, argv);
  add_interval_command(program, exit_code);
  add_analyze_command(program, exit_code);
  add_budget_command(program, exit_code);
  add_campaign_command(program, exit_code);
  add_compare_command(program, exit_code);
  add_atlas_command(program, exit_code);
  add_drift_command(program, exit_code);
  add_simulate_command(program, exit_code);
  add_fuse_command(program, exit_code);
  add_imu_command(program, exit_code);
  try {
    refuse_unknown_command(program, argc, argv);
    program.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    program.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    // Under mpirun every rank was given the same wrong words.
    if (leeway::sim::Ranks::launched_first()) {
      fmt::print(stderr, "leeway: {} (see leeway --help, leeway COMMAND --help)\n", error.what());
    }
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
    return run(argc, argv);
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
