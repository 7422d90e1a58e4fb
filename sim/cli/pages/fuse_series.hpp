/// @file
/// What a report shows of a run of `leeway fuse`, gathered on its way in memory that does not grow
/// with the log.
#pragma once

#include "leeway/sim/replay/replay.hpp"
#include "sim/cli/pages/series_table.hpp"

namespace leeway::cli {

/// It is observed in place: not to be moved.
class FuseSeries {
 public:
  FuseSeries() = default;
  FuseSeries(const FuseSeries&) = delete;
  FuseSeries& operator=(const FuseSeries&) = delete;

  /// What fills this.
  sim::ReplayObserver observer();

  /// As tables solution/RUN, track/RUN, fixes/RUN, outages/RUN and verdict/RUN/NAME.
  void add_to(Json& series, const std::string& run) const;

 private:
  using Keep = SeriesTable::Keep;

  void add(const Solution& solution, const std::optional<TruthRecord>& truth);
  void add_to_track(const Solution& solution, const std::optional<Eigen::Vector3d>& true_r_e_m);

  SeriesTable solution_{{"t_s", "error_n_m", "error_e_m", "error_d_m", "sigma_n_m", "sigma_e_m",
                         "sigma_d_m", "b_a_mps2_forward", "b_a_mps2_right", "b_a_mps2_down",
                         "sigma_b_a_mps2_forward", "sigma_b_a_mps2_right", "sigma_b_a_mps2_down",
                         "b_g_radps_forward", "b_g_radps_right", "b_g_radps_down",
                         "sigma_b_g_radps_forward", "sigma_b_g_radps_right",
                         "sigma_b_g_radps_down"}};
  SeriesTable track_{{"t_s", "east_m", "north_m", "true_east_m", "true_north_m"}, Keep::kFirst};
  SeriesTable fixes_{{"t_s", "nis", "nis_low", "nis_high"}};
  SeriesTable outages_{{"since_s", "outage", "error_h_m", "sigma_h_m"}, Keep::kFirst};
  std::vector<SeriesTable> verdicts_{kVerdicts, SeriesTable({"t_s"}, Keep::kFirst)};
  std::optional<Geodetic> origin_{};  ///< of the track
};

}  // namespace leeway::cli
