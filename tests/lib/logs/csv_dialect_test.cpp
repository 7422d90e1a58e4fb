#include <doctest/doctest.h>

#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/logs/gnss_log.hpp"
#include "leeway/logs/imu_log.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::contains;
using test::near;
using test::TempDir;

// One product of two doubles and its rounding.
constexpr double kRounding = 1e-15;

struct ReadLog {
  std::vector<ImuIncrement> increments{};
  LogSummary summary{};
};

ReadLog imu_of_text(const std::string& text, const LogFormat& format = {}) {
  const TempDir dir;
  ImuLogReader reader(dir.file("imu.csv", text), {.meaning = RateMeaning::kMean, .format = format});
  ReadLog log;
  while (const auto inc = reader.next()) log.increments.push_back(*inc);
  log.summary = reader.summary();
  return log;
}

std::string imu_refusal(const std::string& text, const LogFormat& format = {}) {
  try {
    imu_of_text(text, format);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

const std::string kTitles = "t_s,gx_radps,gy_radps,gz_radps,ax_mps2,ay_mps2,az_mps2\n";

void check_as_plain(const ReadLog& log) {
  REQUIRE(log.increments.size() == 1);
  const ImuIncrement& inc = log.increments.front();
  CHECK(inc.time == time_from_seconds(1.25));
  CHECK(inc.dt_s == 0.25);
  CHECK(inc.dtheta_b_rad == Eigen::Vector3d(0.125, -0.25, 0.5));
  CHECK(inc.dv_b_mps == Eigen::Vector3d(0.0625, 1.0, -2.0));
}

TEST_CASE("one log in every dialect of CSV is one log") {
  check_as_plain(imu_of_text(kTitles + "1,0,0,0,0,0,0\n1.25,0.5,-1,2,0.25,4,-8\n"));
  const std::string semicolons = "T_S;gx_radps;GY_radps;gz_radps;ax_mps2;ay_mps2;az_mps2\r\n";
  check_as_plain(imu_of_text(semicolons + "1;0;0;0;0;0;0\r\n1.25;0.5;-1;2;0.25;4;-8\r\n"));
  check_as_plain(imu_of_text(semicolons + "1;0;0;0;0;0;0\n1,25;0,5;-1;2;0,25;4;-8\n"));
  check_as_plain(imu_of_text(
      "\xEF\xBB\xBF\"t_s\"\t\"gx_radps\"\tgy_radps\tgz_radps\tax_mps2\tay_mps2\taz_mps2\n"
      "1\t0\t0\t0\t0\t0\t0\n\"1.25\"\t0.5\t-1\t2\t\"0.25\"\t4\t-8\n"));
  check_as_plain(
      imu_of_text("\"t_s\",\"gx_radps\",gy_radps,gz_radps,ax_mps2,ay_mps2,az_mps2\n"
                  "1,0,0,0,0,0,0\n\"1.25\",\"0,5\",-1,2,\"0.25\",4,-8\n"));
  check_as_plain(
      imu_of_text("t_s gx_radps gy_radps gz_radps ax_mps2 ay_mps2 az_mps2\n"
                  "1 0 0 0 0 0 0\n1.25 0.5 -1  2 0.25 4 -8\n"));
}

TEST_CASE("a damaged field of another dialect is named at its place") {
  const ReadLog log = imu_of_text(
      "t_s;gx_radps;gy_radps;gz_radps;ax_mps2;ay_mps2;az_mps2\n1;0;0;0;0;0;0\n2;0;x,5;0;0;0;0\n");
  REQUIRE(log.summary.messages.size() == 1);
  CHECK(contains(log.summary.messages.front(), "imu.csv:3:5: not a number: 'x,5'"));
}

TEST_CASE("other names and units are understood, and what is not used is named") {
  const ReadLog log = imu_of_text(
      "time_ms,gyro_x [deg/s],Gyro Y (rad/s),wz_dps,acc_x_g,accel_y [m/s^2],AccZ [mg],temp\n"
      "1000,0,0,0,0,0,0,20\n1250.5,180,1,90,1,2,-1000,20\n");
  REQUIRE(log.increments.size() == 1);
  const ImuIncrement& inc = log.increments.front();
  CHECK(inc.time == Time{Duration{1'250'500'000}});
  const double dt_s = 0.2505, g = 9.80665;  // standard gravity, by definition
  const double pi = std::numbers::pi;
  CHECK(near(inc.dtheta_b_rad, Eigen::Vector3d(pi, 1, pi / 2) * dt_s, kRounding));
  CHECK(near(inc.dv_b_mps, Eigen::Vector3d(g, 2, -g) * dt_s, 1e-14));
  REQUIRE(log.summary.notes.size() == 1);
  CHECK(contains(log.summary.notes.front(), "columns not used: temp"));
  CHECK(contains(imu_refusal("t_s,gyro_x [m],gy,gz,ax,ay,az\n1,0,0,0,0,0,0\n"),
                 "column gyro_x [m]: unit 'm' is not one of rad/s, deg/s, mdps"));
}

TEST_CASE("what the owner says goes before what the log says") {
  const LogFormat format{.time_unit = "us",
                         .gyro_unit = "deg/s",
                         .accel_unit = "g",
                         .columns = {{"t", "stamp"}, {"gx", "rotX"}, {"az_mps2", "up"}},
                         .axes = "flu"};
  const ReadLog log = imu_of_text(
      "stamp,rotX,gy,gz,ax,ay,up\n1000000,0,0,0,0,0,0\n1500000,90,0,180,1,1,9.5\n", format);
  REQUIRE(log.increments.size() == 1);
  const ImuIncrement& inc = log.increments.front();
  CHECK(inc.time == time_from_seconds(1.5));
  const double pi = std::numbers::pi;
  CHECK(near(inc.dtheta_b_rad, Eigen::Vector3d(pi / 4, 0, -pi / 2), kRounding));
  CHECK(near(inc.dv_b_mps, Eigen::Vector3d(9.80665 / 2, -9.80665 / 2, -4.75), 1e-14));
  CHECK(contains(imu_refusal(kTitles, {.layout = "ROS"}), "no layout is named 'ROS'; there are:"));
  CHECK(contains(imu_refusal(kTitles + "1,0,0,0,0,0,0\n", {.axes = "fru"}), "right-handed"));
}

std::string rows(std::int64_t first, std::int64_t step, int count) {
  std::string text;
  for (int k = 0; k < count; ++k) {
    text += std::to_string(first + k * step) + ",0,0,0,0,0,-9.8\n";
  }
  return text;
}

TEST_CASE("the unit of a time is told by its step, and a name that contradicts it is refused") {
  const std::string titles = "timestamp,gx,gy,gz,ax,ay,az\n";
  for (const std::int64_t counts_per_s : {1'000, 1'000'000, 1'000'000'000}) {
    const ReadLog log =
        imu_of_text(titles + rows(1'700'000'000 * counts_per_s, counts_per_s / 100, 20));
    REQUIRE(log.increments.size() == 19);
    CHECK(near(log.increments.back().dt_s, 0.01, 1e-12));
    CHECK(near(to_seconds(log.increments.back().time.time_since_epoch()), 1.7e9 + 0.19, 1e-6));
    CHECK(contains(log.summary.notes.front(), "times are taken to be in"));
  }
  CHECK(contains(imu_refusal(kTitles + rows(50, 100, 20)),
                 "a step of 100 s between rows by its column t_s; are its times in ms?"));
}

TEST_CASE("a binary file is refused as one") {
  CHECK(contains(imu_refusal(std::string("\x7F"
                                         "ELF\x02\x01\x01\0\0",
                                         9)),
                 "is a binary file"));
}

// 2026-12-01: a column of the owner's choice beside one with a name that means the same.
TEST_CASE("a column that its owner names counts before another of the same meaning") {
  const TempDir dir;
  const auto path = dir.file("imu.csv",
                             "time,stamp,gx,gy,gz,ax,ay,az\n0,10,0,0,0,0,0,1\n"
                             "1,11,0,0,0,0,0,1\n");
  ImuLogReader reader(path, {.format = {.time_unit = "s", .columns = {{"t", "stamp"}}}});
  CHECK(reader.next()->time == time_from_seconds(11.0));
}

TEST_CASE("linear acceleration, without gravity, is refused with the remedy") {
  CHECK(contains(imu_refusal("Time (s),Gyroscope x (rad/s),Gyroscope y (rad/s),Gyroscope z (rad/s),"
                             "Linear Acceleration x (m/s^2),Linear Acceleration y (m/s^2),"
                             "Linear Acceleration z (m/s^2)\n0,0,0,0,0,0,0\n"),
                 "has gravity removed, as phones give it, and cannot be used: record the total"));
}

TEST_CASE("seconds of week go on over the end of the week in CSV") {
  const ReadLog log =
      imu_of_text(kTitles + "604799.9,0,0,0,0,0,-9\n0,0,0,0,0,0,-9\n0.1,0,0,0,0,0,-9\n");
  REQUIRE(log.increments.size() == 2);
  CHECK(log.increments.back().time == time_from_seconds(604800.1));
  CHECK(log.summary.clean());
}

TEST_CASE("standard deviations that the log lacks are the owner's") {
  const TempDir dir;
  const auto path =
      dir.file("gnss.csv", "time,latitude,longitude,height,vel_n,vel_e,vel_d\n1,0,0,0,1,2,3\n");
  GnssLogReader reader(path, {.format = {.gnss_sigma = {2.0, 3.0, 0.5, 0.25}}});
  const auto fix = reader.next();
  REQUIRE(fix);
  REQUIRE(fix->velocity);
  // At 0, 0 up is x, east y, north z; rounding of two rotations.
  CHECK(near(fix->position->R_e_m2.diagonal().eval(), Eigen::Vector3d(9, 4, 4), 1e-12));
  CHECK(
      near(fix->velocity->R_e_m2ps2.diagonal().eval(), Eigen::Vector3d(0.0625, 0.25, 0.25), 1e-12));
  CHECK(near(fix->velocity->v_e_mps, Eigen::Vector3d(-3, 2, 1), 1e-12));
}

TEST_CASE("an RTKLIB solution is the same with and without its header") {
  const std::string header =
      "%  GPST latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m) sdu(m) sdne(m) sdeu(m) "
      "sdun(m) age(s) ratio vn(m/s) ve(m/s) vu(m/s) sdvn sdve sdvu sdvne sdveu sdvun\n";
  const std::string line =
      "2024/06/12 10:00:01.000   47.000010554    8.000031002   400.6642   5   9   1.0   1.0   2.0 "
      "0.5 0 0 0.00 0.0 -0.00390 -0.05474 0.03350 0.1 0.1 0.1 0 0 0\n";
  const TempDir dir;
  GnssLogReader with(dir.file("a.pos", header + line));
  GnssLogReader without(dir.file("a.LLH", line));
  CHECK(without.layout() == "RTKLIB .pos");
  const auto a = with.next(), b = without.next();
  REQUIRE((a && b && a->velocity && b->velocity));
  CHECK(a->time == b->time);
  CHECK(a->position->r_e_m == b->position->r_e_m);
  CHECK(a->position->R_e_m2 == b->position->R_e_m2);
  CHECK(a->velocity->v_e_mps == b->velocity->v_e_mps);
  REQUIRE(without.summary().notes.size() == 1);
  CHECK(contains(without.summary().notes.front(), "taken to be GPS time"));
}

}  // namespace
}  // namespace leeway
