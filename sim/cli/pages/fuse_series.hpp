/// @file
/// What a report shows of a run of `leeway fuse`, gathered on its way in memory that does not grow
/// with the log.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "leeway/sim/replay/replay.hpp"
#include "leeway/strapdown/nav_state.hpp"
#include "sim/cli/pages/series_table.hpp"

namespace leeway::cli {

/// It is observed in place: not to be moved.
class FuseSeries {
 public:
  FuseSeries();
  FuseSeries(const FuseSeries&) = delete;
  FuseSeries& operator=(const FuseSeries&) = delete;

  /// What fills this.
  sim::ReplayObserver observer();

  /// As tables solution/RUN, track/RUN, fixes/RUN, outages/RUN and verdict/RUN/NAME.
  void add_to(Json& series, const std::string& run) const;

 private:
  void add(const Solution& solution, const std::optional<TruthRecord>& truth);
  void add_to_track(const Solution& solution, const std::optional<Eigen::Vector3d>& true_r_e_m);
  void add(const UpdateOutcome& update);

  SeriesTable solution_;
  SeriesTable track_;
  SeriesTable fixes_;
  SeriesTable outages_;
  std::vector<SeriesTable> verdicts_;
  std::optional<Geodetic> origin_{};  ///< of the track
};

}  // namespace leeway::cli
