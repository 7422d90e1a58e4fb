#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/logs/gnss_log.hpp"
#include "leeway/logs/imu_log.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::contains;
using test::near;
using test::TempDir;

constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;
const std::string kSensorLoggerHeader = "time,seconds_elapsed,z,y,x\n";

/// A file of Sensor Logger at 100 Hz from a start on; z, y, x as functions of the time since
/// kStartNs.
std::string sensor_logger(double from_s, int rows,
                          const std::function<Eigen::Vector3d(double)>& xyz_at) {
  std::string text = kSensorLoggerHeader;
  for (int k = 0; k < rows; ++k) {
    const double t_s = from_s + 0.01 * k;
    const Eigen::Vector3d v = xyz_at(t_s);
    char line[160];
    std::snprintf(line, sizeof line, "%lld,%.6f,%.9f,%.9f,%.9f\n",
                  static_cast<long long>(kStartNs + std::llround(1e9 * t_s)), t_s, v.z(), v.y(),
                  v.x());
    text += line;
  }
  return text;
}

Eigen::Vector3d rate_at(double t_s) { return {0.1 * t_s, 0.2, -0.3}; }
Eigen::Vector3d force_at(double t_s) { return {1.0, -t_s, 9.8}; }

struct PhoneImu {
  std::vector<ImuIncrement> increments{};
  LogSummary summary{};
};

PhoneImu read_folder(const TempDir& dir) {
  ImuLogReader reader(dir / "");
  CHECK(reader.layout() == "phone folder");
  PhoneImu read;
  while (const auto inc = reader.next()) read.increments.push_back(*inc);
  read.summary = reader.summary();
  return read;
}

std::string refusal_of(const TempDir& dir) {
  return test::message_of<Error>([&] { ImuLogReader reader(dir / ""); });
}

void check_samples(const PhoneImu& read) {
  CHECK(read.summary.clean());
  REQUIRE(read.increments.size() > 90);
  for (const ImuIncrement& inc : read.increments) {
    const double middle_s =
        static_cast<double>(inc.time.time_since_epoch().count() - kStartNs) / 1e9 - inc.dt_s / 2.0;
    CHECK(near(inc.dt_s, 0.01, 1e-9));
    // Nine decimals in the log; linear in time, which trapezoids are exact for.
    CHECK(near(inc.dtheta_b_rad, Eigen::Vector3d(inc.dt_s * rate_at(middle_s)), 1e-9));
    CHECK(near(inc.dv_b_mps, Eigen::Vector3d(inc.dt_s * force_at(middle_s)), 1e-9));
  }
}

TEST_CASE("Sensor Logger: a folder of a file for each sensor, their times apart") {
  const TempDir dir;
  dir.file("Gyroscope.csv", sensor_logger(0.003, 100, rate_at));
  dir.file("TotalAcceleration.csv", sensor_logger(0.0, 100, force_at));
  dir.file("Accelerometer.csv", sensor_logger(0.0, 100, [](double) -> Eigen::Vector3d {
             return Eigen::Vector3d::Zero();
           }));
  dir.file("GyroscopeUncalibrated.csv", kSensorLoggerHeader);
  const PhoneImu read = read_folder(dir);
  CHECK(read.increments.size() == 98);  // the last rate is behind all forces, the first starts
  check_samples(read);
}

TEST_CASE("Sensor Logger: acceleration without gravity, and gravity, are added") {
  const TempDir dir;
  const auto gravity_at = [](double t_s) { return Eigen::Vector3d(0.5, t_s, 9.0); };
  dir.file("Gyroscope.csv", sensor_logger(0.003, 100, rate_at));
  dir.gzip_file("Gravity.csv.gz", sensor_logger(-0.004, 120, gravity_at));
  dir.file("Accelerometer.csv", sensor_logger(0.0, 100, [&](double t_s) -> Eigen::Vector3d {
             return force_at(t_s) - gravity_at(t_s);
           }));
  const PhoneImu read = read_folder(dir);
  check_samples(read);
  CHECK(contains(read.summary.notes.at(0), "Standardise Units & Frames"));
}

TEST_CASE("phones: what has no gravity, or is not there, is refused with the remedy") {
  const auto zero = [](double) -> Eigen::Vector3d { return {0.1, 0.2, -0.3}; };
  {
    const TempDir dir;
    dir.file("Accelerometer.csv", sensor_logger(0.0, 100, zero));
    CHECK(contains(refusal_of(dir), "has no Gyroscope.csv; record Gyroscope and the total"));
    dir.file("Gyroscope.csv", sensor_logger(0.0, 100, rate_at));
    CHECK(contains(refusal_of(dir), "has gravity removed, and there is no Gravity.csv beside it"));
    dir.file("TotalAcceleration.csv", sensor_logger(0.0, 100, zero));
    CHECK(contains(refusal_of(dir), "so that gravity is removed"));
  }
  const TempDir dir;
  dir.file("Gyroscope.csv",
           "\"Time (s)\",\"Gyroscope x (rad/s)\",\"Gyroscope y "
           "(rad/s)\",\"Gyroscope z (rad/s)\"\n0,1,2,3\n");
  dir.file("Linear Acceleration.csv",
           "\"Time (s)\",\"Linear Acceleration x (m/s^2)\",\"Linear Acceleration y "
           "(m/s^2)\",\"Linear Acceleration z (m/s^2)\"\n0,1,2,3\n");
  CHECK(contains(refusal_of(dir), "has gravity removed"));
  CHECK(contains(test::message_of<Error>([&] { GnssLogReader reader(dir / ""); }),
                 "has no Location.csv"));
}

TEST_CASE("phyphox: titles with units, and any separator of its exports") {
  const TempDir dir;
  std::string rates =
      "\"Time (s)\";\"Gyroscope x (rad/s)\";\"Gyroscope y (rad/s)\";\"Gyroscope z "
      "(rad/s)\";\"Absolute (rad/s)\"\n";
  std::string forces = "\"Time (s)\"\t\"X (m/s^2)\"\t\"Y (m/s^2)\"\t\"Z (m/s^2)\"\n";
  for (int k = 0; k < 50; ++k) {
    const std::string time = std::to_string(0.01 * k);
    rates += time + ";0.5;-0.25;0.125;0.6\n";
    forces += time + "\t1.5\t-2.5\t9.75\n";
  }
  dir.file("Gyroscope.csv", rates);
  dir.file("Accelerometer.csv", forces);
  const PhoneImu read = read_folder(dir);
  REQUIRE(read.increments.size() == 49);
  for (const ImuIncrement& inc : read.increments) {
    CHECK(near(inc.dtheta_b_rad, Eigen::Vector3d(inc.dt_s * Eigen::Vector3d(0.5, -0.25, 0.125)),
               1e-15));
    CHECK(near(inc.dv_b_mps, Eigen::Vector3d(inc.dt_s * Eigen::Vector3d(1.5, -2.5, 9.75)), 1e-15));
  }
}

std::vector<GnssFix> fixes_of(const std::filesystem::path& path, const LogFormat& format = {}) {
  GnssLogReader reader(path, {.format = format});
  CHECK(reader.layout() == "phone location");
  std::vector<GnssFix> fixes;
  while (const auto fix = reader.next()) fixes.push_back(*fix);
  CHECK(reader.summary().clean());
  return fixes;
}

TEST_CASE("Sensor Logger: fixes with speed and course, accuracies as of Android") {
  const TempDir dir;
  dir.file("Location.csv",
           "time,seconds_elapsed,bearingAccuracy,speedAccuracy,verticalAccuracy,horizontalAccuracy,"
           "speed,bearing,altitude,longitude,latitude\n"
           "1700000000000000000,0.0,2.0,0.5,3.0,4.0,10.0,90.0,448.5,-8.25,47.5\n"
           "1700000001000000000,1.0,-1,-1,3.0,4.0,-1,-1,448.5,-8.25,47.5\n"
           "1700000002000000000,2.0,2.0,0.5,3.0,-1,10.0,90.0,448.5,-8.25,47.5\n"
           "1700000003000000000,3.0,2.0,0.5,3.0,4.0,10.0,90.0,448.5,-8.25,47.5\n"
           "1700000004000000000,4.0,2.0,0.5,3.0,4.0,10.0,90.0,448.5,-8.25,47.5\n"
           "1700000005000000000,5.0,2.0,0.5,3.0,4.0,10.0,90.0,448.5,-8.25,47.5\n"
           "1700000006000000000,6.0,2.0,0.5,3.0,4.0,10.0,90.0,448.5,-8.25,47.5\n"
           "1700000007000000000,7.0,2.0,0.5,3.0,4.0,10.0,90.0,448.5,-8.25,47.5\n"
           "1700000008000000000,8.0,2.0,0.5,3.0,4.0,10.0,90.0,448.5,-8.25,47.5\n"
           "1700000009000000000,9.0,2.0,0.5,3.0,4.0,10.0,90.0,448.5,-8.25,47.5\n");
  const auto fixes = fixes_of(dir / "");
  REQUIRE(fixes.size() == 9);  // one has no accuracy
  CHECK(fixes[0].time == Time{Duration{kStartNs}});
  const Geodetic place{47.5 * kRadPerDeg, -8.25 * kRadPerDeg, 448.5};
  CHECK(near(fixes[0].position->r_e_m, ecef_from_geodetic(place), 1e-8));
  const Eigen::Matrix3d C_en = ned_to_ecef(place);
  const auto in_ned = [&](const Eigen::Matrix3d& R_e) -> Eigen::Vector3d {
    return (C_en.transpose() * R_e * C_en).diagonal();
  };
  // 68 of 100 within 4 m: 1 - exp(-r^2 / 2 sigma^2) = 0.68.
  const double variance_m2 = 16.0 / (-2.0 * std::log(0.32));
  CHECK(near(in_ned(fixes[0].position->R_e_m2), Eigen::Vector3d(variance_m2, variance_m2, 9.0),
             1e-12));
  REQUIRE(fixes[0].velocity);
  CHECK(near((C_en.transpose() * fixes[0].velocity->v_e_mps).eval(), Eigen::Vector3d(0, 10, 0),
             1e-12));
  const double across = 0.25 + std::pow(10.0 * 2.0 * kRadPerDeg, 2);
  // Eastwards: along is east, across is north; nothing is known of down.
  CHECK(near(in_ned(fixes[0].velocity->R_e_m2ps2), Eigen::Vector3d(across, 0.25, 1e4), 1e-9));
  CHECK(!fixes[1].velocity);
}

TEST_CASE("phyphox: fixes, whose vertical accuracy is headed in degrees") {
  const TempDir dir;
  const auto path = dir.file(
      "Location.csv",
      "\"Time (s)\",\"Latitude (\xC2\xB0)\",\"Longitude (\xC2\xB0)\",\"Height (m)\",\"Velocity "
      "(m/s)\",\"Direction (\xC2\xB0)\",\"Horizontal Accuracy (m)\",\"Vertical Accuracy "
      "(\xC2\xB0)\"\n0.5,47.5,-8.25,448.5,10,90,4,3\n1.5,47.5,-8.25,448.5,10,90,4,3\n");
  const auto fixes = fixes_of(path);
  REQUIRE(fixes.size() == 2);
  CHECK(fixes[1].time == time_from_seconds(1.5));
  CHECK(!fixes[0].velocity);
  const auto told = fixes_of(path, {.gnss_sigma = {1.0, 2.0, 0.1, 0.5}});
  REQUIRE(told.size() == 2);
  const Eigen::Matrix3d C_en = ned_to_ecef({47.5 * kRadPerDeg, -8.25 * kRadPerDeg, 448.5});
  REQUIRE(told[0].velocity);
  CHECK(near((C_en.transpose() * told[0].velocity->R_e_m2ps2 * C_en).diagonal().eval(),
             Eigen::Vector3d(0.01, 0.01, 0.25), 1e-12));
}

}  // namespace
}  // namespace leeway
