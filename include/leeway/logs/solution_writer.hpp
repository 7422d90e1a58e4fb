/// @file
/// Solutions as CSV.
#pragma once

#include <filesystem>

#include "leeway/logs/csv_writer.hpp"
#include "leeway/strapdown/solution.hpp"

namespace leeway {

/// Writer of solutions. Columns: t_s; lat_deg, lon_deg, height_m; vn_mps, ve_mps, vd_mps; roll_deg,
/// pitch_deg, yaw_deg; b_ax_mps2 .. b_gz_radps; sigma_n_m, .., sigma_vn_mps, .., sigma_roll_deg,
/// .., sigma_b_ax_mps2 .. sigma_b_gz_radps; nis ("nan" without a fix), nis_dof. Latitude and
/// longitude to 1e-10 deg (11 um), metres and m/s to 1e-5, angles to 1e-7 deg, biases and sigmas to
/// 7 digits. Errors, the partial file and compression are those of CsvWriter.
class SolutionWriter {
 public:
  explicit SolutionWriter(const std::filesystem::path& path);
  void write(const Solution& solution);
  void close() { csv_.close(); }

 private:
  CsvWriter csv_;
};

}  // namespace leeway
