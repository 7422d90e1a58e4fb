#include "leeway/logs/truth_log.hpp"

#include <doctest/doctest.h>

#include <string>

#include "leeway/earth/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::contains;
using test::near;
using test::TempDir;

constexpr double kAngleTolerance = 1e-15;  // rad: a few roundings of angles below 2 pi

TEST_CASE("position alone is enough; velocity and attitude are groups") {
  const TempDir dir;
  TruthLogReader bare(dir.file("a.csv", "height_m,lon_deg,lat_deg,t_s\n12,-80,45,1.5\n"));
  const auto position = bare.next();
  REQUIRE(position);
  CHECK(position->nav.time == time_from_seconds(1.5));
  CHECK(position->nav.position.lat_rad == 45.0 * kRadPerDeg);
  CHECK(position->nav.position.lon_rad == -80.0 * kRadPerDeg);
  CHECK(position->nav.position.height_m == 12.0);
  CHECK(!position->has_velocity);
  CHECK(!position->has_attitude);

  TruthLogReader full(dir.file("b.csv",
                               "t_s,lat_deg,lon_deg,height_m,vn_mps,ve_mps,vd_mps,roll_deg,"
                               "pitch_deg,yaw_deg,heading_rad\n"
                               "0,45,-80,12,1,2,3,10,20,30,7\n"
                               "1,45,-80,12,1,,3,10,20,30,7\n"
                               "2,45,-80,12,1,2,3,10,nan,30,\n"
                               "3,45,-80,12,1,2,3,10,x,30,7\n"
                               "4,91,-80,12,1,2,3,10,20,30,7\n"));
  const auto first = full.next();
  REQUIRE(first);
  CHECK(first->has_velocity);
  CHECK(first->has_attitude);
  CHECK(first->nav.v_n_mps == Eigen::Vector3d(1, 2, 3));
  CHECK(first->nav.attitude.yaw_rad == 30.0 * kRadPerDeg);
  const auto no_velocity = full.next();
  REQUIRE(no_velocity);
  CHECK(!no_velocity->has_velocity);
  CHECK(no_velocity->has_attitude);
  const auto no_attitude = full.next();
  REQUIRE(no_attitude);
  CHECK(no_attitude->has_velocity);
  CHECK(!no_attitude->has_attitude);
  CHECK(!full.next());
  CHECK(full.summary().records == 3);
  CHECK(full.summary().count(LineDamage::kNotANumber) == 1);
  CHECK(full.summary().count(LineDamage::kOutOfRange) == 1);
}

TEST_CASE("missing columns are named") {
  const TempDir dir;
  const auto message = [&](std::string_view content) {
    const auto path = dir.file("truth.csv", content);
    return test::message_of<Error>([&] { TruthLogReader reader(path); });
  };
  CHECK(contains(message("t_s,lat_deg,lon_deg\n"), "missing columns height_m; expected"));
  CHECK(contains(message("t_s,lat_deg,lon_deg,height_m,vn_mps,vd_mps\n"),
                 "missing columns ve_mps; vn_mps, ve_mps, vd_mps are used together"));
  CHECK(contains(message(""), "the file is empty"));
}

TEST_CASE("truth is interpolated between rows at most a second apart, in the order of time") {
  const TempDir dir;
  TruthTrack track(TruthLogReader(dir.file("truth.csv",
                                           "t_s,lat_deg,lon_deg,height_m,vn_mps,ve_mps,vd_mps,"
                                           "roll_deg,pitch_deg,yaw_deg\n"
                                           "10,45,179.5,100,1,2,3,-1,0,350\n"
                                           "11,46,-179.5,200,3,2,1,1,2,10\n"
                                           "13,46,-179.5,300,3,2,1,1,2,10\n")));
  const auto at = [&](double t_s) { return track.interpolate(time_from_seconds(t_s)); };
  CHECK(!at(9.5));
  CHECK(at(10.0)->nav.position.height_m == 100.0);
  const auto middle = at(10.25);
  REQUIRE(middle);
  CHECK(middle->nav.time == time_from_seconds(10.25));
  CHECK(near(middle->nav.position.lat_rad, 45.25 * kRadPerDeg, kAngleTolerance));
  CHECK(near(middle->nav.position.lon_rad, 179.75 * kRadPerDeg, kAngleTolerance));
  CHECK(middle->nav.position.height_m == 125.0);
  CHECK(middle->nav.v_n_mps == Eigen::Vector3d(1.5, 2, 2.5));
  CHECK(near(middle->nav.attitude.roll_rad, -0.5 * kRadPerDeg, kAngleTolerance));
  CHECK(near(wrap_pi(middle->nav.attitude.yaw_rad), -5.0 * kRadPerDeg, 2 * kAngleTolerance));
  CHECK(at(10.25)->nav.position.height_m == 125.0);  // the same time again
  CHECK(!at(12.0));                                  // 2 s between rows
  CHECK(at(13.0)->nav.position.height_m == 300.0);   // on a row
  CHECK(!at(13.001));
  CHECK_THROWS_AS(at(13.0), Error);
}

TEST_CASE("written truth reads back") {
  const TempDir dir;
  TruthRecord record;
  record.nav.time = time_from_seconds(0.123456789);
  record.nav.position = {0.7, -1.3, 87.654321};
  record.nav.v_n_mps = {0.1, -20.3, 1e-9};
  record.nav.attitude = {0.1, -0.2, 6.1};
  record.has_velocity = true;
  record.has_attitude = true;
  TruthRecord bare;
  bare.nav.time = time_from_seconds(1.0);
  TruthLogWriter writer(dir / "truth.csv");
  writer.write(record);
  writer.write(bare);
  writer.close();
  TruthLogReader reader(dir / "truth.csv");
  const auto read = reader.next();
  REQUIRE(read);
  CHECK(read->nav.time == record.nav.time);
  CHECK(near(read->nav.position.lat_rad, 0.7, kAngleTolerance));
  CHECK(near(read->nav.position.lon_rad, -1.3, kAngleTolerance));
  CHECK(read->nav.position.height_m == record.nav.position.height_m);
  CHECK(read->nav.v_n_mps == record.nav.v_n_mps);
  CHECK(near(read->nav.attitude.yaw_rad, 6.1, 2 * kAngleTolerance));
  const auto second = reader.next();
  REQUIRE(second);
  CHECK(!second->has_velocity);
  CHECK(!second->has_attitude);
  CHECK(reader.summary().clean());
}

}  // namespace
}  // namespace leeway
