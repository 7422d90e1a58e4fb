/// @file
/// The files that `leeway analyze` writes.
#pragma once

#include <filesystem>
#include <string>

#include "leeway/logs/csv_writer.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"

namespace leeway::cli {

/// Claimed and true standard deviations at every moment of a scene, in north, east, down. The
/// column moment: 0 on the way, 1 before a fix is used, 2 after.
class MomentWriter {
 public:
  explicit MomentWriter(const std::filesystem::path& path);
  void write(const sim::CovariancePoint& point);
  void close() { csv_.close(); }

 private:
  CsvWriter csv_;
};

/// A row for each source and one for the total, as CSV.
std::string error_budget_csv(const sim::ErrorBudget& budget);

/// Sum over north and east.
double horizontal_m2(const Eigen::Matrix3d& mean_sq_n_m2);

/// Of all sources.
Eigen::Matrix3d total(const sim::ErrorBudget& budget);

}  // namespace leeway::cli
