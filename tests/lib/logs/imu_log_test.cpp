#include "leeway/logs/imu_log.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/logs/line_reader.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::contains;
using test::near;
using test::TempDir;

const std::string kRatesHeader = "t_s,gx_radps,gy_radps,gz_radps,ax_mps2,ay_mps2,az_mps2\n";

std::vector<ImuIncrement> all(ImuLogReader& reader) {
  std::vector<ImuIncrement> increments;
  while (const auto inc = reader.next()) increments.push_back(*inc);
  return increments;
}

// Rates with the given lines in the middle of good ones at 0, 1 and 8 s: what the reader reports.
LogSummary report_around(const std::string& lines) {
  const TempDir dir;
  ImuLogReader reader(dir.file(
      "imu.csv", kRatesHeader + "0,1,2,3,4,5,6\n1,1,2,3,4,5,6\n" + lines + "\n8,1,2,3,4,5,6\n"));
  const auto increments = all(reader);
  REQUIRE(!increments.empty());
  CHECK(increments.back().time == time_from_seconds(8.0));
  CHECK(reader.summary().records == static_cast<std::int64_t>(increments.size()));
  return reader.summary();
}

TEST_CASE("rates become increments over the time from the line before") {
  const TempDir dir;
  const auto path = dir.file("imu.csv", kRatesHeader + "0.5,1,2,3,4,5,6\n0.75,3,2,1,-4,-5,-6\n");
  const auto first = [&](RateMeaning meaning) {
    ImuLogReader reader(path, {.meaning = meaning});
    const auto increments = all(reader);
    REQUIRE(increments.size() == 1);  // the first line only starts the clock
    CHECK(reader.layout() == "CSV, rates");
    CHECK(reader.summary().lines == 2);
    CHECK(increments[0].time == time_from_seconds(0.75));
    CHECK(increments[0].dt_s == 0.25);
    return increments[0];
  };
  // All numbers are dyadic: the products are exact.
  CHECK(first(RateMeaning::kMean).dtheta_b_rad == Eigen::Vector3d(0.75, 0.5, 0.25));
  CHECK(first(RateMeaning::kMean).dv_b_mps == Eigen::Vector3d(-1.0, -1.25, -1.5));
  CHECK(first(RateMeaning::kPoint).dtheta_b_rad == Eigen::Vector3d(0.5, 0.5, 0.5));
  CHECK(first(RateMeaning::kPoint).dv_b_mps == Eigen::Vector3d::Zero());
}

TEST_CASE("a second session in the file is told, and not taken for the end of the first") {
  const TempDir dir;
  const auto session = [](int from_s, int to_s) {
    std::string rows;
    for (int t = from_s; t <= to_s; ++t) rows += std::to_string(t) + ",1,2,3,4,5,6\n";
    return rows;
  };
  ImuLogReader reader(
      dir.file("imu.csv", kRatesHeader + session(0, 100) + kRatesHeader + session(50, 200)));
  CHECK(all(reader).back().time == time_from_seconds(100.0));
  CHECK(contains(reader.summary().incomplete, "a second session begins at line 104"));
  // A late batch of samples is none.
  ImuLogReader late(
      dir.file("late.csv", kRatesHeader + session(0, 100) + session(90, 99) + session(101, 200)));
  CHECK(all(late).back().time == time_from_seconds(200.0));
  CHECK(late.summary().incomplete.empty());
}

TEST_CASE("columns are found by name, in any order, among others") {
  const TempDir dir;
  ImuLogReader reader(
      dir.file("imu.csv",
               "# a comment\n"
               "note, az_mps2 ,ay_mps2,temp,ax_mps2,gz_radps,gy_radps,gx_radps,t_s\r\n"
               "a b,6,5,,4,3,2,1,0\r\n"
               "\r\n"
               "x,12,10,9,8,6,4,+2,1\r\n"
               "# end\n"
               "x,6,5,hot,4,3,2,1,2"),  // no newline at the end
      {.meaning = RateMeaning::kMean});
  const auto increments = all(reader);
  REQUIRE(increments.size() == 2);
  CHECK(increments[0].dtheta_b_rad == Eigen::Vector3d(2, 4, 6));
  CHECK(increments[0].dv_b_mps == Eigen::Vector3d(8, 10, 12));
  CHECK(increments[1].dv_b_mps == Eigen::Vector3d(4, 5, 6));
  CHECK(reader.summary().lines == 3);
  CHECK(reader.summary().clean());
}

TEST_CASE("values repeated under new times are passed on") {
  const TempDir dir;
  ImuLogReader reader(
      dir.file("imu.csv", kRatesHeader + "0,1,2,3,4,5,6\n1,1,2,3,4,5,6\n2,1,2,3,4,5,6\n"));
  CHECK(all(reader).size() == 2);
  CHECK(reader.summary().clean());
}

TEST_CASE("each kind of damaged line costs that line and is counted with its place") {
  struct Case {
    std::string line;
    LineDamage reason;
    std::string message;
  };
  const std::vector<Case> cases{
      {"2,1,2,x3,4,5,6", LineDamage::kNotANumber, ":4:7: not a number: 'x3'"},
      {"2,1,2,3.1.2,4,5,6", LineDamage::kNotANumber, ":4:7: not a number: '3.1.2'"},
      {"2,1,2,3 3,4,5,6", LineDamage::kNotANumber, ":4:7: not a number: '3 3'"},
      {"2 s,1,2,3,4,5,6", LineDamage::kNotANumber, ":4:1: not a number: '2 s'"},
      {"2,1,2,3,4,5", LineDamage::kMissingField, ":4:12: missing field: ''"},
      {"2,1,,3,4,5,6", LineDamage::kMissingField, ":4:5: missing field: ''"},
      {",1,2,3,4,5,6", LineDamage::kMissingField, ":4:1: missing field: ''"},
      {"2,1,2,nan,4,5,6", LineDamage::kNotFinite, ":4:7: not finite: 'nan'"},
      {"2,1,2,3,-inf,5,6", LineDamage::kNotFinite, ":4:9: not finite: '-inf'"},
      {"nan,1,2,3,4,5,6", LineDamage::kNotFinite, ":4:1: not finite: 'nan'"},
      {"0.5,1,2,3,4,5,6", LineDamage::kTimeGoesBack, ":4:1: time goes back: '0.5,1,2,3,4,5,6'"},
      {"1,1,2,3,4,5,6", LineDamage::kDuplicateTime, ":4:1: time repeated: '1,1,2,3,4,5,6'"},
      {"4e3,1,2,3,4,5,6", LineDamage::kTimeJumpsAhead,
       ":4:1: time jumps ahead of the lines after it: '4e3,1,2,3,4,5,6'"},
      {"1e10,1,2,3,4,5,6", LineDamage::kOutOfRange, ":4:1: out of range: '1e10'"},
      {"99999999999,1,2,3,4,5,6", LineDamage::kOutOfRange, ":4:1: out of range: '99999999999'"},
      {"2,1,2,1001,4,5,6", LineDamage::kOutOfRange, ":4:7: out of range: '1001'"},
      {"2,1,2,3,4,5,1e999", LineDamage::kOutOfRange, ":4:13: out of range: '1e999'"},
      {"2,1,2,3,4,5,-1e6", LineDamage::kOutOfRange, ":4:13: out of range: '-1e6'"},
      {std::string("\x01\xFF\0,,", 5), LineDamage::kNotANumber, ":4:1: not a number: '\?\?\?'"},
      {std::string(LineReader::kMaxLineBytes + 1, '1'), LineDamage::kTooLong,
       ":4:1: line too long: '" + std::string(48, '1') + "...'"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.line.substr(0, 40));
    const LogSummary summary = report_around(c.line);
    CHECK(summary.lines == 4);
    CHECK(summary.records == 2);
    CHECK(summary.damaged_lines() == 1);
    CHECK(summary.count(c.reason) == 1);
    REQUIRE(summary.messages.size() == 1);
    CAPTURE(summary.messages[0].substr(0, 200));
    CHECK(summary.messages[0].ends_with("imu.csv" + c.message));
  }
}

TEST_CASE("the first ten damaged lines are quoted, all are counted") {
  std::string lines = "bad";
  for (int i = 1; i < 25; ++i) lines += "\nbad";
  const LogSummary summary = report_around(lines);
  CHECK(summary.count(LineDamage::kNotANumber) == 25);
  CHECK(summary.messages.size() == 10);
}

TEST_CASE("a gap is no damage, and a wrong time ahead does not cost the lines after it") {
  const TempDir dir;
  const std::string values = ",1,2,3,4,5,6\n";
  ImuLogReader gap(dir.file(
      "gap.csv", kRatesHeader + "0" + values + "1" + values + "500" + values + "501" + values));
  const auto increments = all(gap);
  REQUIRE(increments.size() == 3);
  CHECK(near(increments[1].dt_s, 499.0, 1e-12));  // its true length, for the consumer to judge
  CHECK(gap.summary().clean());

  ImuLogReader ahead(dir.file("ahead.csv", kRatesHeader + "9000" + values + "1" + values + "2" +
                                               values + "7000" + values + "7000" + values + "3" +
                                               values + "4" + values));
  const auto times = all(ahead);
  REQUIRE(times.size() == 3);
  CHECK(times[0].time == time_from_seconds(2.0));
  CHECK(times[2].time == time_from_seconds(4.0));
  CHECK(ahead.summary().count(LineDamage::kTimeJumpsAhead) == 2);
  CHECK(ahead.summary().count(LineDamage::kDuplicateTime) == 1);
  CHECK(ahead.summary().damaged_lines() == 3);
}

TEST_CASE("files without usable content are refused with what was expected") {
  const TempDir dir;
  const auto message = [&](std::string_view content) {
    const auto path = dir.file("imu.csv", content);
    return test::message_of<Error>([&] { ImuLogReader reader(path); });
  };
  CHECK(contains(message(""),
                 "imu.csv: the file is empty; expected a CSV header with t_s, gx_radps"));
  CHECK(contains(message("\n# nothing\n"), "the file is empty"));
  CHECK(contains(message("t_s,gx_radps,gy_radps,ax_mps2,ay_mps2,az_mps2\n"),
                 "imu.csv: missing columns gz_radps; expected a CSV header with t_s, gx_radps"));
  CHECK(contains(message("t_s,dt_s,dtheta_x_rad,dtheta_y_rad,dv_x_mps,dv_y_mps,dv_z_mps\n"),
                 "missing columns dtheta_z_rad; expected"));
  CHECK(contains(message("0,1,2,3,4,5,6\n"), "missing columns"));
  CHECK(contains(message("t_s,gx_radps,gy_radps,gz_radps,ax_mps2,ay_mps2,az_mps2,t_s\n"),
                 "column t_s stands twice"));
  CHECK(contains(test::message_of<Error>([&] { ImuLogReader reader(dir / "absent"); }), "absent"));
  CHECK_THROWS_AS(ImuLogReader{dir / ""}, Error);
}

TEST_CASE("a header alone is a log without records") {
  const TempDir dir;
  ImuLogReader reader(dir.file("imu.csv", kRatesHeader));
  CHECK(!reader.next());
  CHECK(!reader.next());
  CHECK(reader.summary().lines == 0);
  CHECK(reader.summary().clean());
}

TEST_CASE("a cut gzip log delivers what it has and is reported incomplete") {
  const TempDir dir;
  std::string text = kRatesHeader;
  for (int i = 0; i < 5000; ++i)
    text += std::to_string(i) + ",1,2,3,4,5," + std::to_string(i) + "\n";
  const std::string whole = test::read_file(dir.gzip_file("whole.csv.gz", text));
  ImuLogReader reader(dir.file("cut.csv.gz", whole.substr(0, whole.size() / 2)),
                      {.meaning = RateMeaning::kMean});
  const auto increments = all(reader);
  REQUIRE(!increments.empty());
  CHECK(increments.size() < 4999);
  CHECK(increments.back().dv_b_mps.z() == to_seconds(increments.back().time));
  CHECK(reader.summary().damaged_lines() == 0);
  CHECK(contains(reader.summary().incomplete, "gzip stream ends early"));
  CHECK(!reader.summary().clean());
}

TEST_CASE("increments of KF-GINS continue over the end of the week") {
  const TempDir dir;
  ImuLogReader reader(dir.file("imu.txt",
                               "604799.990  1e-5  -2e-5 3e-5   0.01 0.02 -0.0981\n"
                               "604799.995000000\t1e-5  -2e-5 3e-5   0.01 0.02 -0.0981\n"
                               "0.000 4e-5  -5e-5 6e-5   0.04 0.05 -0.06\n"
                               "  0.005 1e-5  -2e-5 3e-5   0.01 0.02 -0.0981 0.7\n"
                               "604799.999 1e-5  -2e-5 3e-5   0.01 0.02 -0.0981\n"
                               "0.010 1e-5  -2e-5 3e-5   0.01 0.02 -0.0981\n"));
  const auto increments = all(reader);
  CHECK(reader.layout() == "KF-GINS text");
  REQUIRE(increments.size() == 4);
  CHECK(increments[1].time == time_from_gps(1, 0.0));
  CHECK(increments[1].dt_s == 0.005);
  CHECK(increments[1].dtheta_b_rad == Eigen::Vector3d(4e-5, -5e-5, 6e-5));
  CHECK(increments[1].dv_b_mps == Eigen::Vector3d(0.04, 0.05, -0.06));
  CHECK(increments[3].time == time_from_gps(1, 0.010));
  CHECK(reader.summary().count(LineDamage::kTimeGoesBack) == 1);
}

TEST_CASE("the mount is applied on entry and must be a rotation") {
  const TempDir dir;
  const auto path = dir.file("imu.csv", kRatesHeader + "0,1,2,3,4,5,6\n1,1,2,3,4,5,6\n");
  Eigen::Matrix3d C_bs;  // forward = -y, right = -x, down = -z of the sensor
  C_bs << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  ImuLogReader reader(path, {.C_bs = C_bs});
  const auto inc = reader.next();
  REQUIRE(inc);
  CHECK(inc->dtheta_b_rad == Eigen::Vector3d(-2, -1, -3));
  CHECK(inc->dv_b_mps == Eigen::Vector3d(-5, -4, -6));
  CHECK_THROWS_AS(ImuLogReader(path, {.C_bs = -C_bs}), Error);
  CHECK_THROWS_AS(ImuLogReader(path, {.C_bs = 1.001 * C_bs}), Error);
  CHECK_THROWS_AS(ImuLogReader(path, {.C_bs = Eigen::Matrix3d::Constant(std::nan(""))}), Error);
}

TEST_CASE("written increments read back bit for bit, plain and gzip") {
  const TempDir dir;
  for (const char* name : {"imu.csv", "imu.csv.gz"}) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    std::vector<ImuIncrement> written;
    // Seconds since 1980 with nanoseconds: more digits than a double has.
    Time time = time_from_gps(2381, 408639.999) + Duration{123'456'789};
    ImuLogWriter writer(dir / name);
    for (int i = 0; i < 2000; ++i) {
      const double scale = std::pow(10.0, -(i % 12));
      const auto vector = [&]() -> Eigen::Vector3d {
        return Eigen::Vector3d(normal(random), normal(random), normal(random)) * scale;
      };
      written.push_back({time, std::numbers::pi * 1e-3, vector(), vector()});
      writer.write(written.back());
      time += Duration{4'999'999};
    }
    writer.close();
    ImuLogReader reader(dir / name);
    const auto read = all(reader);
    CHECK(reader.layout() == "CSV, increments");
    CHECK(reader.summary().clean());
    REQUIRE(read.size() == written.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
      REQUIRE(read[i].time == written[i].time);
      REQUIRE(read[i].dt_s == written[i].dt_s);
      REQUIRE(read[i].dtheta_b_rad == written[i].dtheta_b_rad);
      REQUIRE(read[i].dv_b_mps == written[i].dv_b_mps);
    }
  }
}

TEST_CASE("times of either sign are read to the nanosecond") {
  const TempDir dir;
  const std::string values = ",1,2,3,4,5,6\n";
  ImuLogReader reader(dir.file("imu.csv", kRatesHeader + "-1" + values + "-0.03166989529132843" +
                                              values + "-5e-9" + values + ".25" + values +
                                              "1.0000000005" + values));
  const auto increments = all(reader);
  REQUIRE(increments.size() == 4);
  CHECK(increments[0].time.time_since_epoch().count() == -31'669'895);
  CHECK(increments[1].time.time_since_epoch().count() == -5);
  CHECK(increments[2].time.time_since_epoch().count() == 250'000'000);
  CHECK(increments[3].time.time_since_epoch().count() == 1'000'000'001);
}

TEST_CASE("an increment needs a positive length") {
  const TempDir dir;
  ImuLogReader reader(dir.file("imu.csv",
                               "t_s,dt_s,dtheta_x_rad,dtheta_y_rad,dtheta_z_rad,dv_x_mps,dv_y_mps,"
                               "dv_z_mps\n1,1,0,0,0,0,0,0\n2,0,0,0,0,0,0,0\n3,-1,0,0,0,0,0,0\n"
                               "4,1,0,0,0,0,0,0\n"));
  CHECK(all(reader).size() == 2);
  CHECK(reader.summary().count(LineDamage::kOutOfRange) == 2);
}

TEST_CASE("every recorded drive reads whole and clean" * doctest::test_suite("heavy")) {
  const std::filesystem::path drives = std::filesystem::path(LEEWAY_SHARED_DIR) / "data/drives";
  if (!std::filesystem::exists(drives)) {
    MESSAGE("skipped: no " << drives.string());
    return;
  }
  int count = 0;
  for (const auto& drive : std::filesystem::directory_iterator(drives)) {
    if (!drive.is_directory()) continue;
    CAPTURE(drive.path().string());
    LineReader lines(drive.path() / "imu.csv.gz");
    while (lines.next()) {
    }
    ImuLogReader reader(drive.path() / "imu.csv.gz");
    const auto increments = all(reader);
    CHECK(reader.summary().clean());
    CHECK(reader.summary().lines == lines.line_number() - 1);  // without the header
    CHECK(reader.summary().records == lines.line_number() - 2);
    for (const ImuIncrement& inc : increments) {
      REQUIRE(near(inc.dt_s, 0.01005, 0.00005));  // 10.05 ms, straight-line fit of the counter
    }
    ++count;
  }
  CHECK(count == 8);
}

}  // namespace
}  // namespace leeway
