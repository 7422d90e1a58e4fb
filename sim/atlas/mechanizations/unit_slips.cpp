#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

void scale(ImuIncrement& inc, double gyro, double accelerometer) {
  inc.dtheta_b_rad *= gyro;
  inc.dv_b_mps *= accelerometer;
}

void renamed(ImuIncrement& inc, const Eigen::Matrix3d& axes) {
  inc.dtheta_b_rad = (axes * inc.dtheta_b_rad).eval();
  inc.dv_b_mps = (axes * inc.dv_b_mps).eval();
}

Eigen::Matrix3d swapped_xy() {
  Eigen::Matrix3d axes;
  axes << 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  return axes;
}

void swap_latitude_and_longitude(GnssFix& fix) {
  const Geodetic g = geodetic_from_ecef(fix.position->r_e_m);
  fix.position->r_e_m = ecef_from_geodetic({g.lon_rad, g.lat_rad, g.height_m});
}

void take_ned_for_enu(GnssFix& fix) {
  const Geodetic place = geodetic_from_ecef(fix.position->r_e_m);
  const Eigen::Matrix3d C_en = ned_to_ecef(place);
  const Eigen::Vector3d v_n = C_en.transpose() * fix.velocity->v_e_mps;
  fix.velocity->v_e_mps = C_en * Eigen::Vector3d(v_n.y(), v_n.x(), -v_n.z());
}

/// Of the IMU's times; the receiver's are right.
void take_ms_for_s(RecordedTrial& trial) {
  for (ImuIncrement& inc : trial.imu) {
    inc.time = Time{} + 1000 * inc.time.time_since_epoch();
    inc.dt_s *= 1000.0;
  }
}

std::vector<SpoiledCondition> slips() {
  constexpr double kInterval = 0.01;
  const auto imu = each_increment;
  return {
      {"none", [](RecordedTrial&) {}},
      {"deg/s read as rad/s", imu([](auto& i) { scale(i, 1.0 / kRadPerDeg, 1.0); })},
      {"rad/s read as deg/s", imu([](auto& i) { scale(i, kRadPerDeg, 1.0); })},
      {"g read as m/s^2", imu([](auto& i) { scale(i, 1.0, 1.0 / kStandardGravityMps2); })},
      {"m/s^2 read as g", imu([](auto& i) { scale(i, 1.0, kStandardGravityMps2); })},
      {"increments read as rates", imu([](auto& i) { scale(i, kInterval, kInterval); })},
      {"ms read as s", take_ms_for_s},
      {"accelerometer's sign", imu([](auto& i) { scale(i, 1.0, -1.0); })},
      {"gyro's sign", imu([](auto& i) { scale(i, -1.0, 1.0); })},
      {"axes x and y swapped", imu([](auto& i) { renamed(i, swapped_xy()); })},
      {"left and up for right and down",
       imu([](auto& i) { renamed(i, Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal()); })},
      {"latitude and longitude swapped", each_fix(swap_latitude_and_longitude)},
      {"velocity north-east-down read as east-north-up", each_fix(take_ned_for_enu)},
      {"velocity in km/h", each_fix([](GnssFix& fix) { fix.velocity->v_e_mps *= 3.6; })},
  };
}

std::vector<AtlasCell> run_unit_slips(const AtlasOptions& options) {
  const Scene scene = town_drive(120.0);
  const auto trials = recorded_trials(scene, options.brief ? 1 : 3);
  return cells_over(slips(), [&](const SpoiledCondition& slip) {
    return scored(few_atlas_columns(), scene.filter, spoiled(trials, slip.spoil), slip.condition,
                  score_after(90.0, &ErrorSums::horizontal_rms_m));
  });
}

}  // namespace

AtlasScene unit_slips() {
  return {.place = 310,
          .key = "unit-slips",
          .title = "Slips of units, signs and axes",
          .figure = "RMS horizontal error before fixes, from 90 s on",
          .unit = "m",
          .limits = {5.0, 50.0,
                     "fixes of 2.5 m alone, one second old, leave five; beyond fifty the solution "
                     "is worse than a receiver that has lost half of its satellites"},
          .run = run_unit_slips};
}

}  // namespace leeway::sim::scenes
