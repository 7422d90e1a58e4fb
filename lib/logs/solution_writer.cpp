#include "leeway/logs/solution_writer.hpp"

#include <initializer_list>
#include <vector>

namespace leeway {
namespace {

std::vector<CsvColumn> solution_columns() {
  std::vector<CsvColumn> columns;
  const auto add = [&columns](int decimals, std::initializer_list<const char*> names) {
    for (const char* name : names) columns.emplace_back(name, decimals);
  };
  add(10, {"t_s", "lat_deg", "lon_deg"});
  add(5, {"height_m", "vn_mps", "ve_mps", "vd_mps"});
  add(7, {"roll_deg", "pitch_deg", "yaw_deg"});
  add(CsvColumn::kSingle, {"b_ax_mps2",        "b_ay_mps2",
                           "b_az_mps2",        "b_gx_radps",
                           "b_gy_radps",       "b_gz_radps",
                           "sigma_n_m",        "sigma_e_m",
                           "sigma_d_m",        "sigma_vn_mps",
                           "sigma_ve_mps",     "sigma_vd_mps",
                           "sigma_roll_deg",   "sigma_pitch_deg",
                           "sigma_yaw_deg",    "sigma_b_ax_mps2",
                           "sigma_b_ay_mps2",  "sigma_b_az_mps2",
                           "sigma_b_gx_radps", "sigma_b_gy_radps",
                           "sigma_b_gz_radps", "nis"});
  add(0, {"nis_dof"});
  return columns;
}

}  // namespace

SolutionWriter::SolutionWriter(const std::filesystem::path& path)
    : csv_(path, solution_columns()) {}

void SolutionWriter::write(const Solution& solution) {
  const NavStateNed nav = ned_from_nav_state(solution.nav);
  Eigen::Matrix<double, 32, 1> row;
  row << nav.position.lat_rad / kRadPerDeg, nav.position.lon_rad / kRadPerDeg,
      nav.position.height_m, nav.v_n_mps, nav.attitude.roll_rad / kRadPerDeg,
      nav.attitude.pitch_rad / kRadPerDeg, nav.attitude.yaw_rad / kRadPerDeg, solution.b_a_mps2,
      solution.b_g_radps, solution.sigma_position_n_m, solution.sigma_velocity_n_mps,
      solution.sigma_attitude_rad / kRadPerDeg, solution.sigma_b_a_mps2, solution.sigma_b_g_radps,
      solution.nis, static_cast<double>(solution.nis_dof);
  csv_.write(nav.time, {row.data(), static_cast<std::size_t>(row.size())});
}

}  // namespace leeway
