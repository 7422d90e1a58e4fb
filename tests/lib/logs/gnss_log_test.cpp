#include "leeway/logs/gnss_log.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/logs/line_reader.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::contains;
using test::near;
using test::TempDir;

// Two conversions of a position near the Earth's surface, and metres of 6e6 in double.
constexpr double kPositionTolerance = 1e-8;  // m
constexpr double kCovarianceTolerance =
    1e-12;                                    // m^2 for sigmas of metres: rounding of two rotations
constexpr double kVelocityTolerance = 1e-13;  // m/s for tens of m/s: rounding of a rotation

const std::string kPositionHeader =
    "t_s,lat_deg,lon_deg,height_m,pos_std_n_m,pos_std_e_m,pos_std_d_m";
const std::string kHeader =
    kPositionHeader + ",vn_mps,ve_mps,vd_mps,vel_std_n_mps,vel_std_e_mps,vel_std_d_mps\n";

std::vector<GnssFix> all(GnssLogReader& reader) {
  std::vector<GnssFix> fixes;
  while (const auto fix = reader.next()) fixes.push_back(*fix);
  return fixes;
}

Geodetic place(double lat_deg, double lon_deg, double height_m) {
  return {lat_deg * kRadPerDeg, lon_deg * kRadPerDeg, height_m};
}

// Covariances in north-east-down axes, independent of GnssPosition::from_geodetic.
Eigen::Matrix3d in_ned(const Eigen::Matrix3d& R_e, const Geodetic& at) {
  const double sin_lat = std::sin(at.lat_rad), cos_lat = std::cos(at.lat_rad);
  const double sin_lon = std::sin(at.lon_rad), cos_lon = std::cos(at.lon_rad);
  Eigen::Matrix3d C_ne;
  C_ne << -sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat, -sin_lon, cos_lon, 0.0,
      -cos_lat * cos_lon, -cos_lat * sin_lon, -sin_lat;
  return C_ne * R_e * C_ne.transpose();
}

Eigen::Matrix3d diagonal(double n, double e, double d) {
  return Eigen::Vector3d(n, e, d).asDiagonal();
}

TEST_CASE("a CSV row is a fix with covariances in ECEF, its sigmas scaled") {
  const TempDir dir;
  const auto path = dir.file("gnss.csv", kHeader + "1.5,45,-80,120,2,3,4,10,20,-1,0.1,0.2,0.3\n");
  GnssLogReader reader(path, {.position_sigma_scale = 3.0,
                              .velocity_sigma_scale = 2.0,
                              .time_offset = Duration{-500'000'000}});
  const auto fixes = all(reader);
  CHECK(reader.layout() == "CSV");
  REQUIRE(fixes.size() == 1);
  const Geodetic at = place(45, -80, 120);
  CHECK(fixes[0].time == time_from_seconds(1.0));
  CHECK(near(fixes[0].position->r_e_m, ecef_from_geodetic(at), kPositionTolerance));
  CHECK(near(in_ned(fixes[0].position->R_e_m2, at), diagonal(36, 81, 144), 1e-10));
  CHECK(near(ned_to_ecef(at).transpose() * fixes[0].velocity->v_e_mps, Eigen::Vector3d(10, 20, -1),
             kVelocityTolerance));
  CHECK(near(in_ned(fixes[0].velocity->R_e_m2ps2, at), diagonal(0.04, 0.16, 0.36),
             kCovarianceTolerance));
}

TEST_CASE("a heading is optional, as columns and in a row") {
  const TempDir dir;
  const std::string row = ",45,-80,120,2,3,4";
  GnssLogReader reader(dir.file("a.csv", kPositionHeader + ",heading_deg,heading_sigma_deg\n1" +
                                             row + ",270,0.5\n2" + row + ",-90,\n3" + row +
                                             ",,0.5\n4" + row + ",nan,nan\n5" + row + ",0,0\n"));
  const auto fixes = all(reader);
  REQUIRE(fixes.size() == 5);
  constexpr double kAngleTolerance = 1e-15;  // rad: rounding of a product
  CHECK(near(fixes[0].heading->heading_rad, 270.0 * kRadPerDeg, kAngleTolerance));
  CHECK(near(fixes[0].heading->sigma_rad, 0.5 * kRadPerDeg, kAngleTolerance));
  CHECK(near(fixes[1].heading->heading_rad, -90.0 * kRadPerDeg, kAngleTolerance));
  CHECK(fixes[1].heading->sigma_rad == GnssHeading{}.sigma_rad);
  for (std::size_t k = 2; k < 5; ++k) CHECK_FALSE(fixes[k].heading);
  CHECK(reader.summary().damaged_lines() == 0);

  // By itself the column may be anything, such as the course.
  GnssLogReader other(dir.file("b.csv", kPositionHeader + ",heading_deg\n1" + row + ",270\n"));
  CHECK_FALSE(all(other)[0].heading);
  GnssLogReader damaged(dir.file(
      "c.csv", kPositionHeader + ",heading_deg,heading_sigma_deg\n1" + row + ",361,0.5\n"));
  CHECK(all(damaged).empty());
}

TEST_CASE("velocity is optional, as columns and in a row") {
  const TempDir dir;
  GnssLogReader bare(dir.file("a.csv", kPositionHeader + "\n1,45,-80,120,2,3,4\n"));
  const auto fix = bare.next();
  REQUIRE(fix);
  CHECK(!fix->velocity);

  GnssLogReader rows(dir.file("b.csv", kHeader + "1,45,-80,120,2,3,4,10,20,-1,0.1,0.2,0.3\n"
                                                 "2,45,-80,120,2,3,4,10,,-1,0.1,0.2,0.3\n"
                                                 "3,45,-80,120,2,3,4,10,20,-1,0.1,nan,0.3\n"
                                                 "4,45,-80,120,2,3,4,,,,,,\n"
                                                 "5,45,-80,120,2,3,4\n"
                                                 "6,45,-80,120,2,3,4,10,20,-1,0.1,0.2,0.3\n"));
  std::vector<bool> has_velocity;
  for (const GnssFix& row : all(rows)) has_velocity.push_back(row.velocity.has_value());
  CHECK(has_velocity == std::vector<bool>{true, false, false, false, false, true});
  CHECK(rows.summary().clean());

  const auto half = dir.file("c.csv", kPositionHeader + ",vn_mps,ve_mps,vd_mps\n");
  CHECK(contains(test::message_of<Error>([&] { GnssLogReader reader(half); }),
                 "missing columns vel_std_n_mps, vel_std_e_mps, vel_std_d_mps; vn_mps"));
}

TEST_CASE("columns are found by name in any order") {
  const TempDir dir;
  GnssLogReader reader(dir.file("gnss.csv",
                                "pos_std_d_m,fix,pos_std_e_m,pos_std_n_m,height_m,lon_deg,lat_deg,"
                                "t_s\r\n4,RTK,3,2,120,-80,45,1\r\n"));
  const auto fix = reader.next();
  REQUIRE(fix);
  CHECK(near(in_ned(fix->position->R_e_m2, place(45, -80, 120)), diagonal(4, 9, 16), 1e-11));
}

TEST_CASE("each kind of damaged row costs that row and is counted with its place") {
  struct Case {
    std::string row;
    LineDamage reason;
    std::string message;
  };
  const std::string rest = ",10,20,-1,0.1,0.2,0.3";
  const std::vector<Case> cases{
      {"2,90.1,-80,120,2,3,4" + rest, LineDamage::kOutOfRange, ":3:3: out of range: '90.1'"},
      {"2,45,-361,120,2,3,4" + rest, LineDamage::kOutOfRange, ":3:6: out of range: '-361'"},
      {"2,45,-80,2e5,2,3,4" + rest, LineDamage::kOutOfRange, ":3:10: out of range: '2e5'"},
      {"2,45,-80,120,0,3,4" + rest, LineDamage::kOutOfRange, ":3:14: out of range: '0'"},
      {"2,45,-80,120,2,-3,4" + rest, LineDamage::kOutOfRange, ":3:16: out of range: '-3'"},
      {"2,45,-80,120,2,3,1.1e5" + rest, LineDamage::kOutOfRange, ":3:18: out of range: '1.1e5'"},
      {"2,45,-80,120,2,3,4,10,20,-1,0.1,0,0.3", LineDamage::kOutOfRange, ": '0'"},
      {"2,45,-80,120,2,3,4,inf,20,-1,0.1,0.2,0.3", LineDamage::kNotFinite, ": 'inf'"},
      {"2,45,nan,120,2,3,4" + rest, LineDamage::kNotFinite, ":3:6: not finite: 'nan'"},
      {"2,45,,120,2,3,4" + rest, LineDamage::kMissingField, ":3:6: missing field: ''"},
      {"2,45,80W,120,2,3,4" + rest, LineDamage::kNotANumber, ":3:6: not a number: '80W'"},
      {"2,45,-80", LineDamage::kMissingField, ":3:9: missing field: ''"},
      {"1,45,-80,120,2,3,4" + rest, LineDamage::kDuplicateTime, ":3:1: time repeated: '1,45,-"},
      {"0,45,-80,120,2,3,4" + rest, LineDamage::kTimeGoesBack, ":3:1: time goes back: '0,45,-"},
      {"2,45,-80,120,1e-30,3,4" + rest, LineDamage::kOutOfRange, ":3:14: out of range: '1e-30'"},
      // Each sigma is allowed, but their squares are not a numerically definite covariance.
      {"2,45,-80,120,1e-9,1e5,1e5" + rest, LineDamage::kOutOfRange, ":3:1: out of range: '2,45,"},
  };
  const TempDir dir;
  const std::string good = ",45,-80,120,2,3,4" + rest + "\n";
  for (const Case& c : cases) {
    CAPTURE(c.row);
    GnssLogReader reader(dir.file("gnss.csv", kHeader + "1" + good + c.row + "\n3" + good));
    CHECK(all(reader).size() == 2);
    const LogSummary& summary = reader.summary();
    CHECK(summary.lines == 3);
    CHECK(summary.records == 2);
    CHECK(summary.damaged_lines() == 1);
    CHECK(summary.count(c.reason) == 1);
    REQUIRE(summary.messages.size() == 1);
    CAPTURE(summary.messages[0]);
    CHECK(contains(summary.messages[0], c.message));
  }
}

TEST_CASE("files without usable content and wrong options are refused") {
  const TempDir dir;
  const auto message = [&](std::string_view content, const GnssLogOptions& options = {}) {
    const auto path = dir.file("gnss.csv", content);
    return test::message_of<Error>([&] { GnssLogReader reader(path, options); });
  };
  CHECK(contains(message(""), "gnss.csv: the file is empty; expected a CSV header with t_s"));
  CHECK(contains(message("t_s,lat_deg,lon_deg\n"),
                 "missing columns height_m, pos_std_n_m, pos_std_e_m, pos_std_d_m; expected"));
  CHECK(contains(message("1 45 -80 120 1\n"), "5 fields in a line without a header"));
  CHECK(contains(message("% program : RTKLIB\n"), "set the RTKLIB option out-outhead to on"));
  CHECK(contains(message("2023/08/28 17:30:40.000 40 -105 1600 1 9 1 1 1\n"), "missing columns"));
  CHECK(contains(message("% GPST e-baseline(m) n-baseline(m) u-baseline(m) Q ns\n"),
                 "set the RTKLIB option out-solformat to llh or xyz"));
  CHECK(contains(message("% (lat/lon/height=WGS84/geodetic,Q=1:fix)\n"),
                 "set the RTKLIB option out-height to ellipsoidal"));
  CHECK(contains(message("%  GPST latitude(deg) longitude(deg) height(m) Q ns sdn(m)\n"),
                 "missing columns sde, sdu; expected an RTKLIB header with latitude"));
  CHECK(contains(message(kHeader, {.position_sigma_scale = 0.0}), "position_sigma_scale"));
  CHECK(contains(message(kHeader, {.velocity_sigma_scale = std::nan("")}), "velocity_sigma_scale"));
  CHECK_THROWS_AS(GnssLogReader{dir / "absent"}, Error);
  CHECK_THROWS_AS(GnssLogReader{dir / ""}, Error);
}

TEST_CASE("a header alone is a log without records") {
  const TempDir dir;
  GnssLogReader csv(dir.file("gnss.csv", kHeader));
  CHECK(!csv.next());
  CHECK(csv.summary().clean());
  GnssLogReader pos(dir.file(
      "gnss.pos", "%  GPST latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m) sdu(m)\n"));
  CHECK(!pos.next());
  CHECK(pos.summary().lines == 0);
}

TEST_CASE("KF-GINS text has 7 or 13 numbers and continues over the end of the week") {
  const TempDir dir;
  GnssLogReader positions(dir.file("gnss.txt",
                                   "604799.000 45.0 -80.0 120.0  2.0 3.0 4.0\n"
                                   "     0.000 45.0 -80.0 121.0  2.0 3.0 4.0\n"));
  const auto fixes = all(positions);
  CHECK(positions.layout() == "KF-GINS text");
  REQUIRE(fixes.size() == 2);
  CHECK(fixes[1].time == time_from_gps(1, 0.0));
  const Geodetic at = place(45, -80, 121);
  CHECK(near(fixes[1].position->r_e_m, ecef_from_geodetic(at), kPositionTolerance));
  CHECK(near(in_ned(fixes[1].position->R_e_m2, at), diagonal(4, 9, 16), 1e-11));
  CHECK(!fixes[1].velocity);

  GnssLogReader both(
      dir.file("both.txt", "1 45 -80 120 2 3 4 10 20 -1 0.1 0.2 0.3\n2 45 -80 120 2 3 4\n"));
  const auto with_velocity = all(both);
  REQUIRE(with_velocity.size() == 2);
  CHECK(near(in_ned(with_velocity[0].velocity->R_e_m2ps2, at), diagonal(0.01, 0.04, 0.09),
             kCovarianceTolerance));
  CHECK(!with_velocity[1].velocity);
}

TEST_CASE("RTKLIB in degrees, with signed-root covariances and velocity") {
  const TempDir dir;
  GnssLogReader reader(dir.file(
      "gnss.pos",
      "% program   : RTKPOST\r\n"
      "% (lat/lon/height=WGS84/ellipsoidal,Q=1:fix,2:float,3:sbas,4:dgps,5:single,6:ppp)\r\n"
      "%  GPST                  latitude(deg) longitude(deg)  height(m)   Q  ns   sdn(m)   sde(m)  "
      " "
      "sdu(m)  sdne(m)  sdeu(m)  sdun(m) age(s)  ratio    vn(m/s)    ve(m/s)    vu(m/s)      sdvn  "
      " "
      "  sdve     sdvu    sdvne    sdveu    sdvun\r\n"
      "2025/08/28 17:30:40.250   45.000000000  -80.000000000   120.0000   1  14   2.0000   3.0000  "
      " "
      "4.0000  -1.0000   0.5000   0.2500   0.00   12.3   10.00000   20.00000    1.00000   0.10000  "
      "0.20000  0.30000  0.05000 -0.06000  0.07000\r\n"
      "2025/08/28 17:30:40.500   45.000000000  -80.000000000   120.0000   5  14   2.0000   3.0000  "
      " "
      "4.0000   0.0000   0.0000   0.0000   0.00   12.3   10.00000   20.00000    1.00000   0.00000  "
      "0.00000  0.00000  0.00000  0.00000  0.00000\r\n"));
  const auto fixes = all(reader);
  CHECK(reader.layout() == "RTKLIB .pos");
  CHECK(reader.summary().clean());
  REQUIRE(fixes.size() == 2);
  // 2025-08-28 is the Thursday of GPS week 2381.
  CHECK(fixes[0].time == time_from_gps(2381, 4 * 86400 + 17 * 3600 + 30 * 60 + 40.25));
  const Geodetic at = place(45, -80, 120);
  CHECK(near(fixes[0].position->r_e_m, ecef_from_geodetic(at), kPositionTolerance));
  Eigen::Matrix3d R_n;  // down is -up: the signs of the covariances with it turn
  R_n << 4.0, -1.0, -0.0625, -1.0, 9.0, -0.25, -0.0625, -0.25, 16.0;
  CHECK(near(in_ned(fixes[0].position->R_e_m2, at), R_n, 1e-11));
  REQUIRE(fixes[0].velocity);
  CHECK(near(ned_to_ecef(at).transpose() * fixes[0].velocity->v_e_mps, Eigen::Vector3d(10, 20, -1),
             kVelocityTolerance));
  Eigen::Matrix3d R_v_n;
  R_v_n << 0.01, 0.0025, -0.0049, 0.0025, 0.04, 0.0036, -0.0049, 0.0036, 0.09;
  CHECK(near(in_ned(fixes[0].velocity->R_e_m2ps2, at), R_v_n, kCovarianceTolerance));
  CHECK(!fixes[1].velocity);  // zero deviations say nothing
}

TEST_CASE("RTKLIB in degrees, minutes, seconds, with commas, week and UTC") {
  const TempDir dir;
  GnssLogReader dms(dir.file(
      "dms.pos",
      "%  GPST  "
      ",latitude(d'\"),longitude(d'\"),height(m),Q,ns,sdn(m),sde(m),sdu(m),sdne(m),sdeu(m),"
      "sdue(m),age(s),ratio\n"
      "2381, 408640.250,  -0,30,36.00000, -80,15,00.00000,  120.0000,  1, 14,   2,   3,   4, 1, 0, "
      "-1, 0.00, 12.3\n"
      "2381, 408640.500,  -0,60.5,36.00000, -80,15,00.00000,  120.0000,  1, 14,   2,   3,   4, 1, "
      "0, "
      "-1, 0.00, 12.3\n"));
  const auto fixes = all(dms);
  REQUIRE(fixes.size() == 1);
  CHECK(dms.summary().count(LineDamage::kOutOfRange) == 1);  // 60.5 minutes
  CHECK(fixes[0].time == time_from_gps(2381, 408640.25));
  const Geodetic at = place(-0.51, -80.25, 120);
  CHECK(near(fixes[0].position->r_e_m, ecef_from_geodetic(at), kPositionTolerance));
  Eigen::Matrix3d R_n;
  R_n << 4, 1, 1, 1, 9, 0, 1, 0, 16;
  CHECK(near(in_ned(fixes[0].position->R_e_m2, at), R_n, 1e-11));

  const auto one_line = [&](const std::string& system, const std::string& epoch) {
    GnssLogReader reader(
        dir.file("a.pos", "%  " + system +
                              " latitude(deg) longitude(deg) height(m) Q ns sdn(m) "
                              "sde(m) sdu(m)\n" +
                              epoch + " 45 -80 120 1 14 2 3 4\n"));
    const auto read = all(reader);
    CHECK(read.size() + static_cast<std::size_t>(reader.summary().damaged_lines()) == 1);
    return read.empty() ? std::optional<Time>{} : read[0].time;
  };
  const Time gpst = time_from_gps(2381, 4 * 86400 + 12 * 3600);
  CHECK(one_line("GPST", "2025/08/28 12:00:00.000") == gpst);
  CHECK(one_line("UTC", "2025/08/28 11:59:42.000") == gpst);  // 18 leap seconds behind GPS
  CHECK(one_line("JST", "2025/08/28 20:59:42.000") == gpst);
  CHECK(one_line("UTC", "2381 388782.0") == gpst);
  CHECK(one_line("UTC", "2016/12/31 23:59:59.0") == one_line("GPST", "2017/01/01 00:00:16.0"));
  CHECK(one_line("UTC", "1998/06/01 00:00:00.0") == one_line("GPST", "1998/06/01 00:00:12.0"));
  CHECK(!one_line("GPST", "2025/02/29 12:00:00.0"));
  CHECK(!one_line("GPST", "2025/264/28 12:00:00.0"));  // 264 = 8 modulo 256
  CHECK(!one_line("GPST", "2025/08/28 24:00:00.0"));
  CHECK(!one_line("GPST", "2025/08/28 12:00"));
  CHECK(!one_line("GPST", "2025-08-28 12:00:00.0"));
  CHECK(!one_line("GPST", "20001 12.0"));
}

TEST_CASE("RTKLIB in ECEF") {
  const TempDir dir;
  GnssLogReader reader(dir.file(
      "ecef.pos",
      "%  GPST  x-ecef(m)  y-ecef(m) z-ecef(m) Q ns sdx(m) sdy(m) sdz(m) sdxy(m) sdyz(m) sdzx(m) "
      "age(s) ratio vx(m/s) vy(m/s) vz(m/s) sdvx sdvy sdvz sdvxy sdvyz sdvzx\n"
      "2381 1.0 1113194.9 -4345000.5 4520000.25 1 9 2 3 4 1 -2 0.5 0 1 1 2 3 0.1 0.2 0.3 0 0 0\n"
      "2381 2.0 1113194.9 -4345000.5 4520000.25 1 9 1 1 1 1.001 0 0 0 1 1 2 3 0.1 0.2 0.3 0 0 0\n"
      "2381 3.0 1113194.9 -4345000.5 1520000.25 1 9 1 1 1 0 0 0 0 1 1 2 3 0.1 0.2 0.3 0 0 0\n"));
  const auto fixes = all(reader);
  REQUIRE(fixes.size() == 2);
  CHECK(fixes[0].position->r_e_m == Eigen::Vector3d(1113194.9, -4345000.5, 4520000.25));
  Eigen::Matrix3d R_e;
  R_e << 4, 1, 0.25, 1, 9, -4, 0.25, -4, 16;
  CHECK(fixes[0].position->R_e_m2 == R_e);
  CHECK(fixes[0].velocity->v_e_mps == Eigen::Vector3d(1, 2, 3));
  CHECK(fixes[1].position->R_e_m2 == Eigen::Matrix3d::Identity());  // rounded past definite
  CHECK(reader.summary().count(LineDamage::kOutOfRange) == 1);      // 1500 km below the ground
}

TEST_CASE("a written fix reads back, without its correlations") {
  const TempDir dir;
  const Geodetic at = place(45, -80, 120);
  Eigen::Matrix3d R_n;
  R_n << 4, 1, 0, 1, 9, 0, 0, 0, 16;
  GnssFix fix{time_from_gps(2381, 408640.123456789), GnssPosition::from_geodetic(at, R_n),
              GnssVelocity::from_ned(at, {10, 20, -1}, diagonal(0.01, 0.04, 0.09))};
  GnssFix bare = fix;
  bare.time += Duration{1};
  bare.velocity.reset();
  GnssLogWriter writer(dir / "gnss.csv.gz");
  writer.write(fix);
  writer.write(bare);
  CHECK_THROWS_AS(writer.write({fix.time, std::nullopt, fix.velocity}), Error);
  writer.close();
  GnssLogReader reader(dir / "gnss.csv.gz");
  const auto fixes = all(reader);
  REQUIRE(fixes.size() == 2);
  CHECK(fixes[0].time == fix.time);
  CHECK(near(fixes[0].position->r_e_m, fix.position->r_e_m, kPositionTolerance));
  CHECK(near(in_ned(fixes[0].position->R_e_m2, at), diagonal(4, 9, 16), 1e-11));
  CHECK(near(fixes[0].velocity->v_e_mps, fix.velocity->v_e_mps, kVelocityTolerance));
  CHECK(near(fixes[0].velocity->R_e_m2ps2, fix.velocity->R_e_m2ps2, kCovarianceTolerance));
  CHECK(fixes[1].time == bare.time);
  CHECK(!fixes[1].velocity);
}

TEST_CASE("every recorded drive and the walk read whole and clean") {
  const std::filesystem::path data = std::filesystem::path(LEEWAY_SHARED_DIR) / "data";
  if (!std::filesystem::exists(data / "drives")) {
    MESSAGE("skipped: no " << (data / "drives").string());
    return;
  }
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    if (entry.path().filename() != "gnss.csv.gz") continue;
    CAPTURE(entry.path().string());
    LineReader lines(entry.path());
    while (lines.next()) {
    }
    GnssLogReader reader(entry.path());
    const auto fixes = all(reader);
    CHECK(reader.summary().clean());
    CHECK(reader.summary().records == lines.line_number() - 1);  // without the header
    for (const GnssFix& fix : fixes) REQUIRE(fix.velocity);
    ++count;
  }
  CHECK(count >= 8);
}

}  // namespace
}  // namespace leeway
