/// @file
/// The curves behind solved intervals, for a report.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "leeway/sim/analysis/interval.hpp"
#include "sim/cli/pages/series_table.hpp"

namespace leeway::cli {

/// What solving for one IMU passes on its way. It is observed in place: not to be moved.
class IntervalSeries {
 public:
  IntervalSeries() = default;
  IntervalSeries(const IntervalSeries&) = delete;
  IntervalSeries& operator=(const IntervalSeries&) = delete;

  /// The configuration, with observers that fill this.
  sim::IntervalConfig observed(sim::IntervalConfig config);

  /// As tables curve/IMU (interval_s, true_m, claimed_m) and free_inertial/IMU (t_s, true_m).
  void add_to(Json& series, const std::string& imu) const;

 private:
  std::map<double, std::pair<double, double>> errors_m_{};  ///< true, claimed, by interval in s
  SeriesTable free_inertial_{{"t_s", "true_m"}};
};

}  // namespace leeway::cli
