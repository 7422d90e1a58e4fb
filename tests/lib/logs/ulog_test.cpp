#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/logs/gnss_log.hpp"
#include "leeway/logs/imu_log.hpp"
#include "tests/lib/logs/bytes.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::Bytes;
using test::contains;
using test::near;
using test::TempDir;

std::string ulog_message(char type, const std::string& content) {
  return Bytes().add(static_cast<std::uint16_t>(content.size())).add(type).add_text(content).text();
}

std::string file_head() {
  return Bytes().add_text("ULog\x01\x12\x35\x01").add<std::uint64_t>(20'000'000).text();
}

std::string subscription(std::uint8_t instance, std::uint16_t id, const std::string& topic) {
  return ulog_message('A', Bytes().add(instance).add(id).add_text(topic).text());
}

/// As PX4 1.11 defines it, with what is of no use here in between.
const std::string kCombined =
    "sensor_combined:uint64_t timestamp;float[3] gyro_rad;uint32_t gyro_integral_dt;int32_t "
    "accelerometer_timestamp_relative;float[3] accelerometer_m_s2;uint32_t "
    "accelerometer_integral_dt;uint8_t accelerometer_clipping;uint8_t[3] _padding0;";

std::string combined(std::uint64_t time_us, float rate, float force, std::uint16_t id = 7) {
  Bytes b;
  b.add(id).add(time_us);
  for (const float axis : {1.0F, 2.0F, 3.0F}) b.add(rate * axis);
  b.add<std::uint32_t>(5000).add<std::int32_t>(0);
  for (const float axis : {1.0F, 2.0F, 3.0F}) b.add(force * axis);
  b.add<std::uint32_t>(5000).add<std::uint8_t>(0);
  return ulog_message('D', b.text());
}

std::string definitions() {
  return file_head() + ulog_message('B', std::string(40, '\0')) + ulog_message('F', kCombined) +
         ulog_message('I',
                      "\x0F"
                      "char[3] sys_namePX4") +
         subscription(0, 7, "sensor_combined");
}

template <class Reader>
struct Read {
  std::vector<typename std::decay_t<decltype(*std::declval<Reader>().next())>> records{};
  LogSummary summary{};
};

template <class Reader>
Read<Reader> read_log(const std::filesystem::path& path) {
  Reader reader(path);
  CHECK(reader.layout() == "PX4 ULog");
  Read<Reader> read;
  while (const auto record = reader.next()) read.records.push_back(*record);
  read.summary = reader.summary();
  return read;
}

template <class Reader>
Read<Reader> read_bytes(const std::string& bytes) {
  const TempDir dir;
  return read_log<Reader>(dir.gzip_file("log.ulg", bytes));
}

TEST_CASE("ULog: sensor_combined is means of rates since the sample before") {
  const auto read =
      read_bytes<ImuLogReader>(definitions() + combined(20'000'000, 0.1F, 1.0F) +
                               combined(20'005'000, 0.2F, 2.0F) + combined(20'010'000, 0.4F, 3.0F));
  CHECK(read.summary.clean());
  REQUIRE(read.records.size() == 2);
  CHECK(read.records[1].time == Time{std::chrono::microseconds{20'010'000}});
  CHECK(read.records[1].dt_s == 0.005);
  // Numbers of 24 bits in the log.
  CHECK(near(read.records[0].dtheta_b_rad, Eigen::Vector3d(0.001, 0.002, 0.003), 1e-9));
  CHECK(near(read.records[1].dv_b_mps, Eigen::Vector3d(0.015, 0.030, 0.045), 1e-9));
}

TEST_CASE(
    "ULog: fields stand where the log's own definition puts them; the first instance counts") {
  const std::string other = file_head() +
                            ulog_message('F',
                                         "sensor_combined:float[3] "
                                         "accelerometer_m_s2;bool[2] flags;"
                                         "float[3] gyro_rad;uint64_t timestamp;") +
                            subscription(1, 8, "sensor_combined") +
                            subscription(0, 3, "sensor_combined");
  const auto sample = [](std::uint16_t id, std::uint64_t time_us, float value) {
    Bytes b;
    b.add(id).add(value).add(0.0F).add(-9.8F).add<std::uint16_t>(0).add(0.0F).add(0.0F).add(0.0F);
    return ulog_message('D', b.add(time_us).text());
  };
  const auto read = read_bytes<ImuLogReader>(
      other + sample(3, 1'000'000, 1.0F) + sample(8, 1'002'000, 5.0F) + sample(3, 1'010'000, 2.0F));
  REQUIRE(read.records.size() == 1);
  CHECK(near(read.records[0].dv_b_mps, Eigen::Vector3d(0.02, 0.0, -0.098), 1e-8));
}

std::string gps_format(const std::string& topic, bool is_old) {
  const std::string place = is_old ? "int32_t lat;int32_t lon;int32_t alt;int32_t alt_ellipsoid;"
                                   : "double latitude_deg;double longitude_deg;double "
                                     "altitude_msl_m;double altitude_ellipsoid_m;";
  return topic + ":uint64_t timestamp;" + place +
         "float s_variance_m_s;float eph;float epv;float vel_n_m_s;float vel_e_m_s;float "
         "vel_d_m_s;uint8_t fix_type;bool vel_ned_valid;";
}

std::string gps(std::uint16_t id, std::uint64_t time_us, bool is_old, std::uint8_t fix_type = 3) {
  Bytes b;
  b.add(id).add(time_us);
  if (is_old) {
    b.add<std::int32_t>(475'000'000).add<std::int32_t>(-82'500'000).add<std::int32_t>(400'000);
    b.add<std::int32_t>(448'500);
  } else {
    b.add(47.5).add(-8.25).add(400.0).add(448.5);
  }
  b.add(0.3F).add(2.0F).add(3.0F).add(1.0F).add(-2.0F).add(0.5F).add(fix_type);
  return ulog_message('D', b.add<std::uint8_t>(1).text());
}

TEST_CASE("ULog: fixes of either topic, in whole numbers or in degrees") {
  const Geodetic place{47.5 * kRadPerDeg, -8.25 * kRadPerDeg, 448.5};
  const Eigen::Matrix3d C_en = ned_to_ecef(place);
  for (const bool is_old : {true, false}) {
    for (const std::string topic : {"vehicle_gps_position", "sensor_gps"}) {
      const auto read = read_bytes<GnssLogReader>(
          file_head() + ulog_message('F', gps_format(topic, is_old)) + subscription(0, 5, topic) +
          gps(5, 1'000'000, is_old) + gps(5, 1'200'000, is_old, 2) + gps(5, 1'400'000, is_old, 8) +
          gps(5, 1'600'000, is_old, 6));
      CHECK(read.summary.clean());
      REQUIRE(read.records.size() == 2);
      const GnssFix& fix = read.records[1];
      CHECK(fix.time == Time{std::chrono::microseconds{1'600'000}});
      // Metres of 6e6 in double.
      CHECK(near(fix.position->r_e_m, ecef_from_geodetic(place), 1e-8));
      CHECK(near((C_en.transpose() * fix.position->R_e_m2 * C_en).diagonal().eval(),
                 Eigen::Vector3d(2, 2, 9), 1e-12));
      REQUIRE(fix.velocity);
      CHECK(near((C_en.transpose() * fix.velocity->v_e_mps).eval(), Eigen::Vector3d(1, -2, 0.5),
                 1e-12));
      // A number of 24 bits, squared.
      CHECK(
          near(fix.velocity->R_e_m2ps2, Eigen::Matrix3d(0.03 * Eigen::Matrix3d::Identity()), 1e-8));
    }
  }
}

TEST_CASE("ULog: of a log with both topics the one that the vehicle uses is read") {
  const auto read = read_bytes<GnssLogReader>(
      file_head() + ulog_message('F', gps_format("sensor_gps", true)) +
      ulog_message('F', gps_format("vehicle_gps_position", true)) +
      subscription(0, 5, "sensor_gps") + subscription(0, 6, "vehicle_gps_position") +
      gps(5, 1'000'000, true) + gps(6, 1'010'000, true));
  REQUIRE(read.records.size() == 1);
  CHECK(read.records[0].time == Time{std::chrono::microseconds{1'010'000}});
}

TEST_CASE("ULog: a damaged byte costs at most its message") {
  std::vector<std::string> samples;
  for (std::uint64_t k = 0; k < 40; ++k) {
    samples.push_back(combined(1'000'000 + 5000 * k, 0.1F, 1.0F));
  }
  for (std::size_t at = 0; at < samples[20].size(); ++at) {
    CAPTURE(at);
    std::string bytes = definitions();
    for (std::size_t k = 0; k < samples.size(); ++k) {
      std::string sample = samples[k];
      if (k == 20) sample[at] = static_cast<char>(sample[at] ^ 0x55);
      bytes += sample;
    }
    // The first sample starts the clock. A time that is ahead by less than ten samples is believed.
    const bool is_believed = at == 6;
    CHECK(read_bytes<ImuLogReader>(bytes).records.size() >= (is_believed ? 30 : 38));
  }
}

TEST_CASE("ULog: lost bytes and a cut end are told") {
  std::string bytes = definitions();
  for (std::uint64_t k = 0; k < 10; ++k) bytes += combined(1'000'000 + 5000 * k, 0.1F, 1.0F);
  const std::size_t size = combined(0, 0.0F, 0.0F).size();
  const auto cut = read_bytes<ImuLogReader>(bytes.substr(0, bytes.size() - 20));
  CHECK(cut.records.size() == 8);
  CHECK(cut.summary.count(LineDamage::kCutShort) == 1);
  std::string torn = bytes;
  torn.erase(bytes.size() - 5 * size + 10, 2 * size);
  const auto read = read_bytes<ImuLogReader>(torn);
  CHECK(read.records.size() + 1 >= 7);
  CHECK(read.summary.records == static_cast<std::int64_t>(read.records.size()));
}

TEST_CASE("ULog: a second log in the file is told") {
  std::string bytes = definitions();
  for (std::uint64_t k = 0; k < 100; ++k) bytes += combined(30'000'000 + 500'000 * k, 0.1F, 1.0F);
  const auto read = read_bytes<ImuLogReader>(bytes + bytes);
  CHECK(read.records.size() == 99);
  CHECK(contains(read.summary.incomplete, "a second session begins at byte"));
}

TEST_CASE("ULog: bytes without an end and without a message are given up") {
  const auto read =
      read_bytes<ImuLogReader>(definitions() + combined(1'000'000, 0.1F, 1.0F) +
                               combined(1'005'000, 0.1F, 1.0F) + std::string(80U << 20, '\0'));
  CHECK(read.records.size() == 1);
  CHECK(contains(read.summary.incomplete, "no message within 64 MiB"));
}

TEST_CASE("ULog: a log without the topic says which it must have") {
  const auto imu = read_bytes<ImuLogReader>(file_head() + ulog_message('B', std::string(40, '\0')));
  CHECK(imu.records.empty());
  CHECK(contains(imu.summary.messages.at(0), "topic sensor_combined, which must be logged"));
  const auto gnss = read_bytes<GnssLogReader>(definitions());
  CHECK(contains(gnss.summary.messages.at(0), "vehicle_gps_position or sensor_gps"));
}

TEST_CASE("ULog: a log of a Cube at rest") {
  const std::filesystem::path path =
      std::filesystem::path(LEEWAY_SHARED_DIR) / "data" / "formats" / "px4-at-rest.ulg";
  if (!std::filesystem::exists(path)) return;
  const auto imu = read_log<ImuLogReader>(path);
  CHECK(imu.summary.clean());
  CHECK(imu.records.size() == 1298 - 1);  // as an independent scanner counts; one starts the clock
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double duration_s = 0.0;
  for (const ImuIncrement& inc : imu.records) {
    sum += inc.dv_b_mps;
    duration_s += inc.dt_s;
  }
  CHECK(near(duration_s, to_seconds(imu.records.back().time) - 20.326716, 1e-9));
  // Gravity, to the bias of an accelerometer and what a hand does.
  CHECK(near(sum.norm() / duration_s, 9.81, 0.2));
  CHECK(sum.z() < 0.0);
  const auto gnss = read_log<GnssLogReader>(path);
  CHECK(gnss.summary.clean());
  CHECK(gnss.records.size() == 32);
  CHECK(gnss.records.front().time >= imu.records.front().time - std::chrono::seconds{1});
}

}  // namespace
}  // namespace leeway
