#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/logs/gnss_log.hpp"
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

constexpr int kDaysToThursday = 4;
constexpr std::uint32_t kNoonMs = (kDaysToThursday * 86400 + 43200) * 1000;

/// NAV-PVT of 2025-08-28, a Thursday of GPS week 2381, some time after noon of GPS time.
Bytes pvt(std::uint32_t after_noon_ms) {
  Bytes p;
  p.add_zeros(92);
  p.set<std::uint32_t>(0, kNoonMs + after_noon_ms);
  const std::uint32_t utc_s = 43200 + after_noon_ms / 1000 - 18;
  p.set<std::uint16_t>(4, 2025).set<std::uint8_t>(6, 8).set<std::uint8_t>(7, 28);
  p.set<std::uint8_t>(8, static_cast<std::uint8_t>(utc_s / 3600));
  p.set<std::uint8_t>(9, static_cast<std::uint8_t>(utc_s / 60 % 60));
  p.set<std::uint8_t>(10, static_cast<std::uint8_t>(utc_s % 60));
  p.set<std::uint8_t>(11, 7);
  p.set<std::int32_t>(16, static_cast<std::int32_t>(after_noon_ms % 1000) * 1'000'000);
  p.set<std::uint8_t>(20, 3).set<std::uint8_t>(21, 1);
  p.set<std::int32_t>(24, -82'500'000).set<std::int32_t>(28, 475'000'000);
  p.set<std::int32_t>(32, 448'500).set<std::uint32_t>(40, 2000).set<std::uint32_t>(44, 3000);
  p.set<std::int32_t>(48, 1000).set<std::int32_t>(52, -2000).set<std::int32_t>(56, 500);
  p.set<std::uint32_t>(68, 300);
  return p;
}

std::string pvt_message(const Bytes& payload) { return ubx_message(0x01, 0x07, payload.text()); }

struct UbxFixes {
  std::vector<GnssFix> fixes{};
  LogSummary summary{};
};

UbxFixes fixes_of_file(const std::filesystem::path& path) {
  GnssLogReader reader(path);
  CHECK(reader.layout() == "u-blox UBX");
  UbxFixes read;
  while (const auto fix = reader.next()) read.fixes.push_back(*fix);
  read.summary = reader.summary();
  return read;
}

UbxFixes fixes_of_bytes(const std::string& bytes) {
  const TempDir dir;
  const UbxFixes read = fixes_of_file(dir.file("log.ubx", bytes));
  CHECK(fixes_of_file(dir.gzip_file("log.bin", bytes)).fixes.size() == read.fixes.size());
  return read;
}

TEST_CASE("UBX: place, velocity and accuracies of NAV-PVT") {
  const UbxFixes read = fixes_of_bytes(pvt_message(pvt(250)));
  CHECK(read.summary.clean());
  REQUIRE(read.fixes.size() == 1);
  const GnssFix& fix = read.fixes[0];
  CHECK(fix.time == time_from_gps(2381, kNoonMs / 1e3 + 0.25));
  const Geodetic place{47.5 * kRadPerDeg, -8.25 * kRadPerDeg, 448.5};
  // Metres of 6e6 in double.
  CHECK(near(fix.position->r_e_m, ecef_from_geodetic(place), 1e-8));
  const Eigen::Matrix3d C_en = ned_to_ecef(place);
  REQUIRE(fix.velocity);
  // Rounding of rotations.
  CHECK(
      near((C_en.transpose() * fix.velocity->v_e_mps).eval(), Eigen::Vector3d(1, -2, 0.5), 1e-12));
  // 2 m are of north and east together, 0.3 m/s of three axes.
  CHECK(near((C_en.transpose() * fix.position->R_e_m2 * C_en).diagonal().eval(),
             Eigen::Vector3d(2, 2, 9), 1e-12));
  CHECK(near(fix.velocity->R_e_m2ps2, Eigen::Matrix3d(0.03 * Eigen::Matrix3d::Identity()), 1e-15));
}

TEST_CASE("UBX: the time of day gives the nanoseconds, the time of week the leap seconds") {
  Bytes p = pvt(0);
  p.set<std::int32_t>(16, -123'456);  // the receiver rounds the time of week to ms
  CHECK(fixes_of_bytes(pvt_message(p)).fixes.at(0).time ==
        time_from_gps(2381, kNoonMs / 1e3) - Duration{123'456});
  p = pvt(1000);
  p.set<std::uint8_t>(10, 44);  // a receiver that has yet to hear of two leap seconds
  CHECK(fixes_of_bytes(pvt_message(p)).fixes.at(0).time ==
        time_from_gps(2381, kNoonMs / 1e3 + 1.0));
}

TEST_CASE("UBX: NAV-HPPOSLLH is the place of its epoch, NAV-PVT says when and how fast") {
  Bytes precise;
  precise.add_zeros(36);
  precise.set<std::uint32_t>(4, kNoonMs).set<std::int32_t>(8, -82'500'000);
  precise.set<std::int32_t>(12, 475'000'000).set<std::int32_t>(16, 448'500);
  precise.set<std::int8_t>(24, -12).set<std::int8_t>(25, 34).set<std::int8_t>(26, -5);
  precise.set<std::uint32_t>(28, 200).set<std::uint32_t>(32, 300);  // 0.1 mm
  const std::string message = ubx_message(0x01, 0x14, precise.text());
  const Geodetic place{(47.5 + 34e-9) * kRadPerDeg, (-8.25 - 12e-9) * kRadPerDeg, 448.4995};
  for (const std::string& bytes : {pvt_message(pvt(0)) + message, message + pvt_message(pvt(0))}) {
    const UbxFixes read = fixes_of_bytes(bytes + pvt_message(pvt(1000)));
    REQUIRE(read.fixes.size() == 2);
    CHECK(read.fixes[0].time == time_from_gps(2381, kNoonMs / 1e3));
    CHECK(near(read.fixes[0].position->r_e_m, ecef_from_geodetic(place), 1e-8));
    CHECK(read.fixes[0].velocity);
    const Eigen::Matrix3d C_en = ned_to_ecef(place);
    CHECK(near((C_en.transpose() * read.fixes[0].position->R_e_m2 * C_en).diagonal().eval(),
               Eigen::Vector3d(2e-4, 2e-4, 9e-4), 1e-15));
  }
}

TEST_CASE("UBX: what the receiver itself refuses is no fix") {
  struct Refusal {
    std::size_t at;
    std::uint8_t value;
  };
  // fixType none, dead reckoning, 2D, time only; not gnssFixOK; invalidLlh.
  for (const Refusal& r : {Refusal{20, 0}, Refusal{20, 1}, Refusal{20, 2}, Refusal{20, 5},
                           Refusal{21, 0}, Refusal{78, 1}}) {
    CAPTURE(r.at);
    Bytes refused = pvt(0);
    refused.set<std::uint8_t>(r.at, r.value);
    const UbxFixes read = fixes_of_bytes(pvt_message(refused) + pvt_message(pvt(1000)));
    CHECK(read.fixes.size() == 1);
    CHECK(read.summary.clean());
  }
}

TEST_CASE("UBX: a damaged byte costs its message, wherever it is") {
  const std::string first = pvt_message(pvt(0)), second = pvt_message(pvt(1000)),
                    third = pvt_message(pvt(2000));
  for (std::size_t at = 0; at < second.size(); ++at) {
    CAPTURE(at);
    std::string damaged = second;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    const UbxFixes read = fixes_of_bytes(first + damaged + third);
    CHECK(read.fixes.size() == 2);
    // Without its sync or with another class it is nobody's message.
    if (at > 2) CHECK(read.summary.damaged_lines() == 1);
  }
  const UbxFixes cut = fixes_of_bytes(first + second.substr(0, 50));
  CHECK(cut.fixes.size() == 1);
  CHECK(cut.summary.count(LineDamage::kCutShort) == 1);
  CHECK(contains(cut.summary.messages.at(0), "log.ubx: byte 100: cut short"));
}

TEST_CASE("UBX: NMEA, RTCM and whatever else between the messages is foreign") {
  const std::string rtcm("\xD3\x00\x04\xB5\x62\x02\xB5\x00", 8);
  const UbxFixes read =
      fixes_of_bytes("$GNGGA,120000.00,,,,,0,,,,,,,,*6E\r\n" + pvt_message(pvt(0)) + rtcm +
                     ubx_message(0x0A, 0x04, "v1") + pvt_message(pvt(1000)));
  CHECK(read.fixes.size() == 2);
  CHECK(read.summary.clean());
}

TEST_CASE("UBX: positions alone, without a week: times of the week, over its end") {
  const auto precise = [](std::uint32_t time_of_week_ms) {
    Bytes p;
    p.add_zeros(36);
    p.set<std::uint32_t>(4, time_of_week_ms).set<std::int32_t>(12, 475'000'000);
    p.set<std::uint32_t>(28, 200).set<std::uint32_t>(32, 300);
    return ubx_message(0x01, 0x14, p.text());
  };
  const std::string over_the_end = precise(604'799'000) + precise(0) + precise(1000);
  const UbxFixes read = fixes_of_bytes(over_the_end);
  REQUIRE(read.fixes.size() == 3);
  CHECK(read.fixes[2].time == time_from_seconds(604'801.0));
  REQUIRE(read.summary.notes.size() == 1);
  CHECK(contains(read.summary.notes[0], "times are those of the week"));
  Bytes time_gps;
  time_gps.add<std::uint32_t>(604'799'000).add<std::int32_t>(0).add<std::int16_t>(2381);
  time_gps.add<std::int8_t>(18).add<std::uint8_t>(7).add<std::uint32_t>(20);
  const UbxFixes of_week = fixes_of_bytes(ubx_message(0x01, 0x20, time_gps.text()) + over_the_end);
  REQUIRE(of_week.fixes.size() == 3);
  CHECK(of_week.fixes[0].time == time_from_gps(2381, 604'799.0));
  CHECK(of_week.fixes[2].time == time_from_gps(2382, 1.0));
}

TEST_CASE("UBX: bytes without an end and without a message are given up") {
  const TempDir dir;
  const std::string zeros(std::size_t{80} << 20, '\0');
  const UbxFixes read = fixes_of_file(dir.gzip_file("a", pvt_message(pvt(0)) + zeros));
  CHECK(read.fixes.size() == 1);
  CHECK(contains(read.summary.incomplete, "no message within 64 MiB"));
  CHECK(contains(test::message_of<Error>([] { GnssLogReader("/dev/zero"); }), "is a binary file"));
}

TEST_CASE("UBX: a receiver's file is read to its last fix") {
  const std::filesystem::path path =
      std::filesystem::path(LEEWAY_SHARED_DIR) / "data" / "formats" / "nav-pvt.ubx";
  if (!std::filesystem::exists(path)) return;
  const UbxFixes read = fixes_of_file(path);
  CHECK(read.summary.clean());
  REQUIRE(read.fixes.size() == 39);  // as an independent scanner counts
  CHECK(read.fixes.front().time == time_from_gps(2128, 473'613.0) + Duration{52'792});
  const Geodetic place{46.4506691 * kRadPerDeg, 10.1053825 * kRadPerDeg, 75.699};
  CHECK(near(read.fixes.front().position->r_e_m, ecef_from_geodetic(place), 1e-8));
}

}  // namespace
}  // namespace leeway
