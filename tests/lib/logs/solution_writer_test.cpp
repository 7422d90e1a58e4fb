#include "leeway/logs/solution_writer.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/logs/gnss_log.hpp"
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

/// A place on the equator with the vehicle's nose to the east, in week 2395 of GPS.
Solution on_the_equator(double lon_deg) {
  NavStateNed ned;
  ned.time = time_from_gps(2395, 172800.25);
  ned.position = {0.0, lon_deg * kRadPerDeg, 100.0};
  ned.v_n_mps = {0.0, 10.0, -1.0};
  ned.attitude = {0.0, 0.0, 90.0 * kRadPerDeg};
  Solution solution;
  solution.nav = nav_state_from_ned(ned);
  solution.sigma_position_n_m = {1.0, 2.0, 3.0};
  solution.sigma_velocity_n_mps = {0.1, 0.2, 0.3};
  return solution;
}

std::string written(const std::string& name, const SolutionForm& form = {}) {
  const TempDir dir;
  SolutionWriter writer(dir / name, form);
  writer.write(on_the_equator(7.0));
  writer.write(on_the_equator(7.001));
  writer.close();
  std::string text;
  LineReader lines(dir / name);
  while (const auto line = lines.next()) text.append(*line).append("\n");
  return text;
}

TEST_CASE("a solution as RTKLIB .pos is read back as fixes") {
  const TempDir dir;
  const Solution solution = on_the_equator(7.0);
  SolutionWriter writer(dir / "a.pos.gz");
  writer.write(solution);
  writer.close();
  GnssLogReader log(dir / "a.pos.gz");
  const auto fix = log.next();
  REQUIRE(fix);
  CHECK(fix->time == solution.nav.time);
  CHECK(near(fix->position->r_e_m, solution.nav.r_e_m, 1e-5));      // 11 um a digit
  CHECK(near(fix->velocity->v_e_mps, solution.nav.v_e_mps, 1e-5));  // 10 um/s a digit
}

TEST_CASE("a solution as TUM is about its first position, body axes to east, north, up") {
  // Forward is east, right is south, down is against up: half a turn about the first axis.
  const std::string text = written("a.tum");
  CHECK(text.find(" 0.00000 0.00000 0.00000 ") != std::string::npos);
  double t = 0.0, x = 0.0, y = 0.0, z = 0.0, qx = 0.0, qy = 0.0, qz = 0.0, qw = 0.0;
  const std::size_t second = text.find('\n') + 1;
  REQUIRE(std::sscanf(text.c_str() + second, "%lf %lf %lf %lf %lf %lf %lf %lf", &t, &x, &y, &z, &qx,
                      &qy, &qz, &qw) == 8);
  const double angle = 0.001 * kRadPerDeg;  // along a circle of the equator's radius and height
  const double radius_m = wgs84::kSemiMajorAxisM + 100.0;
  CHECK(near(x, radius_m * std::sin(angle), 1e-5));  // m: a digit
  CHECK(near(y, 0.0, 1e-5));
  CHECK(near(z, radius_m * (std::cos(angle) - 1.0), 1e-5));
  // The axes of the first place have turned by the angle, half of which is 8.7e-6 in the
  // quaternion.
  CHECK(near(std::abs(qx), 1.0, 1e-5));
  CHECK(near(std::hypot(qy, qz, qw), 0.0, 1e-5));
}

TEST_CASE("maps get longitude, latitude and height; GPX the time in UTC") {
  const std::string place = "7.0000000000,0.0000000000,100.000";
  CHECK(written("a.kml").find(place) != std::string::npos);
  CHECK(written("a.geojson").find("[" + place + "],\n[7.001") != std::string::npos);
  const std::string gpx = written("a.gpx");
  CHECK(gpx.find("lat=\"0.0000000000\" lon=\"7.0000000000\"><ele>100.000<") != std::string::npos);
  // date -u -d '1980-01-06 + 2395 weeks + 172800 s - 18 s'
  CHECK(gpx.find("<time>2025-12-01T23:59:42.250Z</time>") != std::string::npos);
}

TEST_CASE("columns of a solution are chosen, east, north and up about a place given") {
  const Geodetic origin{0.0, 7.0 * kRadPerDeg, 90.0};
  const std::string text = written("a.txt", {"csv", {"up_m", "t_s", "yaw_deg"}, origin});
  CHECK(text.starts_with("t_s,up_m,yaw_deg\n1448668800.25,10.00000,90.0000000\n"));
}

TEST_CASE("forms of a solution that are none are refused, with what there is") {
  const auto refusal = [](const char* name, const SolutionForm& form) {
    return test::message_of<Error>([&] { require_solution_form(name, form); });
  };
  CHECK(test::contains(refusal("a.csv", {"kmz", {}, {}}), "'kmz'; choose one of csv, pos, tum"));
  CHECK(test::contains(refusal("a.csv", {{}, {"yaw"}, {}}), "'yaw'; choose from t_s, lat_deg"));
  CHECK(test::contains(refusal("a.kml.gz", {{}, {"yaw_deg"}, {}}), "this is kml; leave"));
  CHECK(refusal("a.kml", {"csv", {"yaw_deg"}, {}}).empty());
}

}  // namespace
}  // namespace leeway
