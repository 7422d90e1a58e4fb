/// @file
/// What `leeway fuse` says about its runs: as tables, as JSON, and as warnings.
#pragma once

#include "sim/cli/commands/fuse_jobs.hpp"

namespace leeway::cli {

/// A log that a run has read.
struct FuseLog {
  std::string key{};
  std::string title{};
  std::string format{};
  const std::filesystem::path& path;
  const LogSummary& summary;
};

std::vector<FuseLog> logs_of(const FuseJob& job);

/// How an outage, and outages of one length, are shown.
Row outage_row(const FuseJob& job, const sim::OutageResult& outage);
Row outage_row(const sim::OutageSummary& summary);

/// All runs together. Means are weighted by their counts.
struct FuseTotals {
  std::array<std::uint64_t, kVerdicts> verdicts{};
  double nis_mean{};
  double nis_dof_mean{};
  sim::RmsErrors rms{};
  std::vector<sim::OutageResult> outages{};
};

FuseTotals totals_of(const std::vector<FuseJob>& jobs);

/// On stdout. @param imu_name  of the error model used
void print_tables(const FuseOptions& options, const std::string& imu_name,
                  const std::vector<FuseJob>& jobs);

Json fuse_json(const FuseOptions& options, const std::string& imu_name,
               const std::vector<FuseJob>& jobs);

/// On stderr: damaged or incomplete logs, gaps, refused fixes, a mount that looks upside down.
void warn(const FuseJob& job);

}  // namespace leeway::cli
