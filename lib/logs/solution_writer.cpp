#include "leeway/logs/solution_writer.hpp"

#include <array>

namespace leeway {
namespace {

constexpr int kGeodeticDecimals = 10;
constexpr int kMetreDecimals = 5;
constexpr int kAngleDecimals = 7;
constexpr int kSingle = CsvColumn::kSingle;

}  // namespace

SolutionWriter::SolutionWriter(const std::filesystem::path& path)
    : csv_(path, {{"t_s"},
                  {"lat_deg", kGeodeticDecimals},
                  {"lon_deg", kGeodeticDecimals},
                  {"height_m", kMetreDecimals},
                  {"vn_mps", kMetreDecimals},
                  {"ve_mps", kMetreDecimals},
                  {"vd_mps", kMetreDecimals},
                  {"roll_deg", kAngleDecimals},
                  {"pitch_deg", kAngleDecimals},
                  {"yaw_deg", kAngleDecimals},
                  {"b_ax_mps2", kSingle},
                  {"b_ay_mps2", kSingle},
                  {"b_az_mps2", kSingle},
                  {"b_gx_radps", kSingle},
                  {"b_gy_radps", kSingle},
                  {"b_gz_radps", kSingle},
                  {"sigma_n_m", kSingle},
                  {"sigma_e_m", kSingle},
                  {"sigma_d_m", kSingle},
                  {"sigma_vn_mps", kSingle},
                  {"sigma_ve_mps", kSingle},
                  {"sigma_vd_mps", kSingle},
                  {"sigma_roll_deg", kSingle},
                  {"sigma_pitch_deg", kSingle},
                  {"sigma_yaw_deg", kSingle},
                  {"sigma_b_ax_mps2", kSingle},
                  {"sigma_b_ay_mps2", kSingle},
                  {"sigma_b_az_mps2", kSingle},
                  {"sigma_b_gx_radps", kSingle},
                  {"sigma_b_gy_radps", kSingle},
                  {"sigma_b_gz_radps", kSingle},
                  {"nis", kSingle},
                  {"nis_dof", 0}}) {}

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
