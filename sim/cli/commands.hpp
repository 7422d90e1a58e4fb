/// @file
/// The commands of the program and what they agree on.
#pragma once

#include <CLI/CLI.hpp>

#include "leeway/earth/error.hpp"

namespace leeway::cli {

/// What the program exits with. kept in step with docs/guide/cli.md
enum ExitCode : int {
  kSuccess = 0,
  kUnusable = 1,  ///< wrong usage or unusable input: nothing was computed
  kNoAnswer = 2,  ///< finished, but no solution, or nothing to score it against
  kFailure = 3,   ///< a result could not be written, or a defect of the program
};

/// A result could not be written.
struct WriteFailure : Error {
  using Error::Error;
};

/// Runs what writes results. @throws WriteFailure in place of Error.
template <class F>
auto writing(F&& write) {
  try {
    return write();
  } catch (const Error& error) {
    throw WriteFailure(error.what());
  }
}

/// Each adds its command to the program; when run, it sets the exit code or throws.
void add_atlas_command(CLI::App& program, int& exit_code);
void add_budget_command(CLI::App& program, int& exit_code);
void add_campaign_command(CLI::App& program, int& exit_code);
void add_compare_command(CLI::App& program, int& exit_code);
void add_drift_command(CLI::App& program, int& exit_code);
void add_imu_command(CLI::App& program, int& exit_code);
void add_simulate_command(CLI::App& program, int& exit_code);
void add_fuse_command(CLI::App& program, int& exit_code);
void add_interval_command(CLI::App& program, int& exit_code);
void add_analyze_command(CLI::App& program, int& exit_code);

}  // namespace leeway::cli
