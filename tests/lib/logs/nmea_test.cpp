#include <doctest/doctest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/logs/gnss_log.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::contains;
using test::near;
using test::TempDir;

// A sentence with its checksum, the exclusive or of what stands between $ and *.
std::string sentence(const std::string& content) {
  unsigned char sum = 0;
  for (const char c : content) sum ^= static_cast<unsigned char>(c);
  char tail[8];
  std::snprintf(tail, sizeof tail, "*%02X\r\n", sum);
  return "$" + content + tail;
}

std::string nmea_epoch(const std::string& time, const std::string& date,
                       const std::string& talker = "GN") {
  return sentence(talker + "GGA," + time + ",4730.0000,N,00815.0000,W,1,12,0.8,400.5,M,48.0,M,,") +
         sentence("GNRMC," + time + ",A,4730.0000,N,00815.0000,W,10.0,90.0," + date + ",,,A") +
         sentence("GLGSA,A,3,65,66,,,,,,,,,,,1.2,0.8,0.9") +
         sentence("GNGST," + time + ",1.0,,,,2.0,3.0,4.0");
}

struct ReadFixes {
  std::vector<GnssFix> fixes{};
  LogSummary summary{};
};

ReadFixes fixes_of_text(const std::string& text, const LogFormat& format = {}) {
  const TempDir dir;
  GnssLogReader reader(dir.file("log.txt", text), {.format = format});
  CHECK(reader.layout() == "NMEA 0183");
  ReadFixes read;
  while (const auto fix = reader.next()) read.fixes.push_back(*fix);
  read.summary = reader.summary();
  return read;
}

TEST_CASE("NMEA: an epoch of several talkers is a fix, also the last one") {
  const ReadFixes read =
      fixes_of_text(nmea_epoch("120000.00", "280825") + nmea_epoch("120001.50", "280825", "GP"),
                    {.gnss_sigma = {2.0, 4.0, 0.1, 0.5}});
  CHECK(read.summary.clean());
  REQUIRE(read.fixes.size() == 2);
  // 2025-08-28 is the Thursday of GPS week 2381; UTC is 18 s behind GPS time.
  CHECK(read.fixes[0].time == time_from_gps(2381, 4 * 86400 + 12 * 3600 + 18));
  CHECK(read.fixes[1].time - read.fixes[0].time == Duration{1'500'000'000});
  const Geodetic place{47.5 * kRadPerDeg, -8.25 * kRadPerDeg, 448.5};
  // Degrees and minutes to degrees, and metres of 6e6 in double.
  CHECK(near(read.fixes[0].position->r_e_m, ecef_from_geodetic(place), 1e-8));
  REQUIRE(read.fixes[0].velocity);
  const Eigen::Matrix3d C_en = ned_to_ecef(place);
  const double v_mps = 10.0 * 1852.0 / 3600.0;  // 10 knots eastward
  CHECK(near((C_en.transpose() * read.fixes[0].velocity->v_e_mps).eval(),
             Eigen::Vector3d(0, v_mps, 0), 1e-12));
}

TEST_CASE("NMEA: standard deviations of GST; without them or a date it is refused") {
  const ReadFixes read = fixes_of_text(nmea_epoch("120000.00", "280825"));
  REQUIRE(read.fixes.size() == 1);
  CHECK(!read.fixes[0].velocity);
  const Eigen::Matrix3d C_en = ned_to_ecef(Geodetic{47.5 * kRadPerDeg, -8.25 * kRadPerDeg, 448.5});
  // Rounding of two rotations.
  CHECK(near((C_en.transpose() * read.fixes[0].position->R_e_m2 * C_en).diagonal().eval(),
             Eigen::Vector3d(4, 9, 16), 1e-12));
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      fixes_of_text(text);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  const std::string gga = sentence("GPGGA,120000,4730.0,N,00815.0,W,1,12,0.8,400.5,M,48.0,M,,");
  CHECK(contains(refusal(gga), "has no standard deviations: say --gnss-sigma"));
  CHECK(contains(refusal(gga + sentence("GPGST,120000,1,,,,2,3,4")), "has no date"));
}

TEST_CASE("NMEA: a wrong checksum costs its sentence, and the day goes on at midnight") {
  std::string damaged = nmea_epoch("235959.00", "280825");
  damaged[40] = damaged[40] == '1' ? '2' : '1';
  const std::string next_day =
      sentence("GNGGA,000001.00,4730.0000,N,00815.0000,W,1,12,0.8,400.5,M,48.0,M,,") +
      sentence("GNGST,000001.00,1.0,,,,2.0,3.0,4.0");
  const ReadFixes read = fixes_of_text(nmea_epoch("235958.00", "280825") + damaged + next_day);
  CHECK(read.summary.count(LineDamage::kChecksum) == 1);
  REQUIRE(read.fixes.size() == 2);
  CHECK(read.fixes[1].time - read.fixes[0].time == Duration{3'000'000'000});
}

}  // namespace
}  // namespace leeway
