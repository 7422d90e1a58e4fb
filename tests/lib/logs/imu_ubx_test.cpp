#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "leeway/earth/units.hpp"
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
using test::ubx_message;

constexpr std::uint8_t kGyroZ = 5, kGyroY = 13, kGyroX = 14, kAccelX = 16;

std::uint32_t item(std::uint8_t type, int value) {
  return static_cast<std::uint32_t>(type) << 24 | (static_cast<std::uint32_t>(value) & 0xFFFFFF);
}

/// ESF-MEAS with a calibrated time tag, which holds over the other.
std::string measurement(std::uint32_t tag_ms, const std::vector<std::uint32_t>& items) {
  Bytes b;
  b.add<std::uint32_t>(1)
      .add(static_cast<std::uint16_t>(items.size() << 11 | 8))
      .add<std::uint16_t>(0);
  for (const std::uint32_t word : items) b.add(word);
  return ubx_message(0x10, 0x02, b.add(tag_ms).text());
}

std::string gyro(std::uint32_t tag_ms, int value) {
  return measurement(
      tag_ms, {item(kGyroX, value), item(kGyroY, -value), item(kGyroZ, 2 * value), item(12, 2825)});
}

std::string accel(std::uint32_t tag_ms, int value) {
  return measurement(tag_ms,
                     {item(kAccelX, value), item(kAccelX + 1, 0), item(kAccelX + 2, -10240)});
}

/// NAV-PVT of 2025-08-28 12:00:00 GPS time and later.
std::string epoch(std::uint32_t after_noon_ms) {
  Bytes p;
  p.add_zeros(92);
  p.set<std::uint32_t>(0, (4 * 86400 + 43200) * 1000 + after_noon_ms);
  const std::uint32_t utc_s = 43200 + after_noon_ms / 1000 - 18;
  p.set<std::uint16_t>(4, 2025).set<std::uint8_t>(6, 8).set<std::uint8_t>(7, 28);
  p.set<std::uint8_t>(8, static_cast<std::uint8_t>(utc_s / 3600));
  p.set<std::uint8_t>(9, static_cast<std::uint8_t>(utc_s / 60 % 60));
  p.set<std::uint8_t>(10, static_cast<std::uint8_t>(utc_s % 60)).set<std::uint8_t>(11, 7);
  p.set<std::int32_t>(16, static_cast<std::int32_t>(after_noon_ms % 1000) * 1'000'000);
  return ubx_message(0x01, 0x07, p.text());
}
const Time kNoon = time_from_gps(2381, 4 * 86400 + 43200);

struct UbxSamples {
  std::vector<ImuIncrement> increments{};
  LogSummary summary{};
};

UbxSamples samples_of_file(const std::filesystem::path& path) {
  ImuLogReader reader(path);
  CHECK(reader.layout() == "u-blox UBX");
  UbxSamples read;
  while (const auto inc = reader.next()) read.increments.push_back(*inc);
  read.summary = reader.summary();
  return read;
}

UbxSamples samples_of_bytes(const std::string& bytes) {
  const TempDir dir;
  return samples_of_file(dir.file("log.ubx", bytes));
}

TEST_CASE("UBX: rates and forces that come apart are joined at the times of the rates") {
  // Forces at 0, 100, 200 ms, rates at 5, 105 ms: both linear in time.
  const UbxSamples read = samples_of_bytes(accel(1000, 0) + gyro(1005, 4096) + accel(1100, 1024) +
                                           gyro(1105, 8192) + accel(1200, 2048));
  CHECK(read.summary.clean());
  REQUIRE(read.increments.size() == 1);  // the first sample starts the clock
  CHECK(read.increments[0].time == time_from_seconds(1.105));
  CHECK(read.increments[0].dt_s == 0.1);
  // Trapezoids of 1 and 2 deg/s, and of 0.05 and 1.05 m/s^2.
  const Eigen::Vector3d rate = 1.5 * kRadPerDeg * Eigen::Vector3d(1.0, -1.0, 2.0);
  CHECK(near(read.increments[0].dtheta_b_rad, Eigen::Vector3d(0.1 * rate), 1e-12));
  CHECK(near(read.increments[0].dv_b_mps, Eigen::Vector3d(0.055, 0.0, -1.0), 1e-12));
  CHECK(contains(read.summary.notes.at(0), "those of the sensor's clock"));
}

TEST_CASE("UBX: NAV-PVT of the same log tell the time of the sensors, whose clock is off") {
  // An epoch each second is told 50 ms late; the clock of ms is 100 ppm fast and starts at 5000 s.
  std::string bytes;
  const auto tag = [](double t_s) {
    return static_cast<std::uint32_t>(std::lround(5e6 + 1e3 * t_s * (1.0 + 1e-4)));
  };
  constexpr int kSeconds = 300;
  for (int k = 0; k < 100 * kSeconds; ++k) {
    const double t_s = 0.01 * k;
    bytes += gyro(tag(t_s), 4096) + accel(tag(t_s), k);
    if (k % 100 == 5) bytes += epoch(static_cast<std::uint32_t>(10 * (k - 5)));
  }
  const UbxSamples read = samples_of_bytes(bytes);
  CHECK(read.summary.clean());
  REQUIRE(read.increments.size() > 29'000);
  // A sample of ours from its specific force, which counts: where it is, and where it is said to
  // be.
  double worst_s = 0.0;
  for (const ImuIncrement& inc : read.increments) {
    if (inc.time < kNoon + std::chrono::seconds{60}) continue;
    const double force_mps2 = inc.dv_b_mps.x() / inc.dt_s;
    const double t_s = 0.01 * (1024.0 * force_mps2 + 0.5);
    worst_s = std::max(worst_s, std::abs(to_seconds(inc.time - kNoon) - (t_s - 0.05)));
  }
  // The tags are whole ms, and so are the lines through them.
  CHECK(worst_s < 2e-3);
}

TEST_CASE("UBX: ESF-RAW has many samples in a message, and a clock of 24 bits") {
  std::string bytes;
  std::uint32_t count = (1U << 24) - 256 * 250;  // 256 counts of 1/25600 s are 10 ms
  for (int k = 0; k < 100; ++k) {
    Bytes b;
    b.add_zeros(4);
    for (int j = 0; j < 10; ++j, count = (count + 256) & 0xFFFFFF) {
      for (const std::uint8_t type : {kGyroX, kGyroY, kGyroZ}) b.add(item(type, -4096)).add(count);
      for (int axis = 0; axis < 3; ++axis) {
        b.add(item(static_cast<std::uint8_t>(kAccelX + axis), 1024)).add(count);
      }
    }
    bytes += ubx_message(0x10, 0x03, b.text());
    if (k % 10 == 0) bytes += epoch(static_cast<std::uint32_t>(100 * k));
  }
  const UbxSamples read = samples_of_bytes(bytes);
  CHECK(read.summary.clean());
  // All but those before the first epoch, and the one that starts the clock.
  CHECK(read.increments.size() == 1000 - 10 - 1);
  for (const ImuIncrement& inc : read.increments) {
    CHECK(near(inc.dt_s, 0.01, 1e-5));
    CHECK(near(inc.dtheta_b_rad.x(), -inc.dt_s * kRadPerDeg, 1e-12));
    CHECK(near(inc.dv_b_mps.y(), inc.dt_s, 1e-12));
  }
}

TEST_CASE("UBX: a receiver's sensors at rest") {
  const std::filesystem::path path =
      std::filesystem::path(LEEWAY_SHARED_DIR) / "data" / "formats" / "esf-meas.ubx";
  if (!std::filesystem::exists(path)) return;
  const UbxSamples read = samples_of_file(path);
  // Eight rates, of which the last forces surround seven and one starts the clock; what follows is
  // of another log, whose times go back.
  CHECK(read.increments.size() == 6);
  for (const ImuIncrement& inc : read.increments) {
    CHECK(near(inc.dt_s, 0.0995, 0.001));
    CHECK(near((inc.dv_b_mps / inc.dt_s).norm(), 9.81, 0.3));  // gravity, to the bias
  }
}

TEST_CASE("UBX: a log without sensors says what must be recorded") {
  const UbxSamples read = samples_of_bytes(epoch(0) + epoch(1000));
  CHECK(contains(read.summary.messages.at(0), "ESF-RAW or ESF-MEAS of the IMU"));
}

}  // namespace
}  // namespace leeway
