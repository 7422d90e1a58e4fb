#include "leeway/logs/solution_writer.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "leeway/logs/line_reader.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::near;
using test::TempDir;

std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields.emplace_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return fields;
}

// The first row by column name.
std::map<std::string, double> first_row(const std::filesystem::path& path) {
  LineReader lines(path);
  const auto names = fields_of(*lines.next());
  const auto texts = fields_of(*lines.next());
  REQUIRE(names.size() == texts.size());
  std::map<std::string, double> row;
  for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = std::stod(texts[i]);
  return row;
}

TEST_CASE("a solution is written in the columns of its header, positions to 0.1 mm") {
  const TempDir dir;
  NavStateNed ned;
  ned.time = time_from_seconds(12.345678901);
  ned.position = {0.7590123456789, -1.3912345678912, 123.4567891};
  ned.v_n_mps = {1.234567, -2.345678, 0.345678};
  ned.attitude = {0.01, -0.02, 3.03};
  Solution solution;
  solution.nav = nav_state_from_ned(ned);
  solution.b_a_mps2 = {0.011, -0.012, 0.013};
  solution.b_g_radps = {1.1e-5, -1.2e-5, 1.3e-5};
  solution.sigma_position_n_m = {1.1, 1.2, 1.3};
  solution.sigma_velocity_n_mps = {0.11, 0.12, 0.13};
  solution.sigma_attitude_rad = {0.001, 0.002, 0.003};
  solution.sigma_b_a_mps2 = {2.1e-3, 2.2e-3, 2.3e-3};
  solution.sigma_b_g_radps = {2.1e-9, 2.2e-9, 2.3e-9};
  solution.nis = 5.5;
  solution.nis_dof = 6;
  SolutionWriter writer(dir / "solution.csv");
  writer.write(solution);
  writer.close();
  const auto row = first_row(dir / "solution.csv");
  REQUIRE(row.size() == 33);

  CHECK(row.at("t_s") == 12.345678901);
  const Geodetic read{row.at("lat_deg") * kRadPerDeg, row.at("lon_deg") * kRadPerDeg,
                      row.at("height_m")};
  // 1e-10 deg are 11 um and the height has 10 um: half of each, on three axes.
  CHECK(near(ecef_from_geodetic(read), solution.nav.r_e_m, 1e-5));
  const double v = 0.5e-5 + 1e-12;  // m/s: half the last digit
  CHECK(near(row.at("vn_mps"), 1.234567, v));
  CHECK(near(row.at("ve_mps"), -2.345678, v));
  CHECK(near(row.at("vd_mps"), 0.345678, v));
  const double a = 0.5e-7 + 1e-12;  // deg: half the last digit
  CHECK(near(row.at("roll_deg"), 0.01 / kRadPerDeg, a));
  CHECK(near(row.at("pitch_deg"), -0.02 / kRadPerDeg, a));
  CHECK(near(row.at("yaw_deg"), 3.03 / kRadPerDeg, a));
  const std::map<std::string, double> single{{"b_ax_mps2", 0.011},
                                             {"b_ay_mps2", -0.012},
                                             {"b_az_mps2", 0.013},
                                             {"b_gx_radps", 1.1e-5},
                                             {"b_gy_radps", -1.2e-5},
                                             {"b_gz_radps", 1.3e-5},
                                             {"sigma_n_m", 1.1},
                                             {"sigma_e_m", 1.2},
                                             {"sigma_d_m", 1.3},
                                             {"sigma_vn_mps", 0.11},
                                             {"sigma_ve_mps", 0.12},
                                             {"sigma_vd_mps", 0.13},
                                             {"sigma_roll_deg", 0.001 / kRadPerDeg},
                                             {"sigma_pitch_deg", 0.002 / kRadPerDeg},
                                             {"sigma_yaw_deg", 0.003 / kRadPerDeg},
                                             {"sigma_b_ax_mps2", 2.1e-3},
                                             {"sigma_b_ay_mps2", 2.2e-3},
                                             {"sigma_b_az_mps2", 2.3e-3},
                                             {"sigma_b_gx_radps", 2.1e-9},
                                             {"sigma_b_gy_radps", 2.2e-9},
                                             {"sigma_b_gz_radps", 2.3e-9},
                                             {"nis", 5.5},
                                             {"nis_dof", 6}};
  for (const auto& column : single) {
    CAPTURE(column.first);
    const double tolerance = 6e-8 * std::abs(column.second);  // single precision, relative
    CHECK(near(row.at(column.first), column.second, tolerance));
  }
}

TEST_CASE("a solution without a fix has no nis") {
  const TempDir dir;
  Solution solution;
  solution.nav.r_e_m = {6378137.0, 0.0, 0.0};
  SolutionWriter writer(dir / "solution.csv.gz");
  writer.write(solution);
  writer.close();
  const auto row = first_row(dir / "solution.csv.gz");
  CHECK(std::isnan(row.at("nis")));
  CHECK(row.at("nis_dof") == 0.0);
}

}  // namespace
}  // namespace leeway
