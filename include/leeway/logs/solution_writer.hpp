/// @file
/// Solutions as text: CSV, and what maps and other programs read.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "leeway/logs/csv_writer.hpp"
#include "leeway/strapdown/solution.hpp"

namespace leeway {

/// How a solution is written.
struct SolutionForm {
  /// csv, pos (RTKLIB), tum, kml, gpx, geojson; empty: by the ending of the file, else csv.
  std::string format{};
  std::vector<std::string> columns{};  ///< of CSV, after t_s; empty: those of SolutionWriter
  std::optional<Geodetic> origin{};    ///< of east, north, up; absent: the first position
};

/// @throws Error when the format or a column is unknown, or columns are chosen of no CSV.
void require_solution_form(const std::filesystem::path& path, const SolutionForm& form);

/// Writer of solutions. Columns of CSV: t_s; lat_deg, lon_deg, height_m; vn_mps, ve_mps, vd_mps;
/// roll_deg, pitch_deg, yaw_deg; b_ax_mps2 .. b_gz_radps; sigma_n_m, .., sigma_vn_mps, ..,
/// sigma_roll_deg, .., sigma_b_ax_mps2 .. sigma_b_gz_radps; nis ("nan" without a fix), nis_dof;
/// where chosen, east_m, north_m, up_m. Latitude and longitude to 1e-10 deg (11 um), metres and m/s
/// to 1e-5, angles to 1e-7 deg, biases and sigmas to 7 digits. pos takes times as those of GPS, gpx
/// too from its second week on; before, its points have none. tum has the quaternion from body axes
/// to east, north, up. Heights are above the ellipsoid. Errors, the partial file and compression
/// are those of CsvWriter.
class SolutionWriter {
 public:
  /// @throws Error as require_solution_form() does, and when the file cannot be created.
  explicit SolutionWriter(const std::filesystem::path& path, const SolutionForm& form = {});
  ~SolutionWriter();
  SolutionWriter(SolutionWriter&&) noexcept;
  SolutionWriter& operator=(SolutionWriter&&) = delete;

  void write(const Solution& solution);
  void close();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace leeway
