#include "leeway/sim/inspect/log_inspector.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "leeway/earth/rotation.hpp"
#include "leeway/earth/units.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "tests/filters/navigator/recording.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

constexpr double kDriveS = 300.0;
constexpr double kDriveRateHz = 50.0;
constexpr std::uint64_t kDriveSeeds = 10;

/// A drive through town, as its sensors saw it.
struct Seen {
  std::vector<ImuIncrement> imu{};
  std::vector<GnssFix> fixes{};
  std::vector<OdometerSpeed> speeds{};
};

const Trajectory& town_drive() {
  static const Trajectory kTownDrive =
      car_drive({.origin = {56.0 * kRadPerDeg, 37.0 * kRadPerDeg, 150.0},
                 .initial_rest_s = 10.0,
                 .duration_s = kDriveS});
  return kTownDrive;
}

Seen seen(const ImuErrorModel& imu, double position_sigma_m, std::uint64_t seed) {
  static const std::vector<ImuIncrement> kTruth =
      true_increments(town_drive(), kDriveRateHz, kDriveS);
  GnssErrorModel gnss;
  gnss.position_sigma_n_m.setConstant(position_sigma_m);
  gnss.velocity_sigma_n_mps.setConstant(0.05);
  test::Recording log = test::record(town_drive(), kTruth, imu, gnss, 1.0, 1.0, seed);
  Seen s{std::move(log.imu), std::move(log.fixes), {}};
  for (const GnssFix& fix : s.fixes) {
    s.speeds.push_back({fix.time - duration_from_seconds(0.1), fix.velocity->v_e_mps.norm()});
  }
  return s;
}

LogLook look_at(const Seen& s) {
  LogInspector inspector;
  auto fix = s.fixes.begin();
  auto speed = s.speeds.begin();
  const auto take_until = [&](Time t) {
    for (; speed != s.speeds.end() && speed->time <= t; ++speed) inspector.add(*speed);
    for (; fix != s.fixes.end() && fix->time <= t; ++fix) inspector.add(*fix);
  };
  for (const ImuIncrement& inc : s.imu) {
    take_until(inc.time);
    inspector.add(inc);
  }
  take_until(Time::max());
  return inspector.look();
}

void each_increment(Seen& s, const std::function<void(ImuIncrement&)>& change) {
  for (ImuIncrement& inc : s.imu) change(inc);
}

void each_velocity(Seen& s, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& change) {
  for (GnssFix& fix : s.fixes) {
    const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(fix.position->r_e_m));
    fix.velocity->v_e_mps = C_en * change(C_en.transpose() * fix.velocity->v_e_mps);
  }
}

void each_place(Seen& s, const std::function<Geodetic(const Geodetic&)>& change) {
  for (GnssFix& fix : s.fixes) {
    const Geodetic place = geodetic_from_ecef(fix.position->r_e_m);
    const Eigen::Vector3d v_n_mps = ned_to_ecef(place).transpose() * fix.velocity->v_e_mps;
    const Geodetic other = change(place);
    fix.position->r_e_m = ecef_from_geodetic(other);
    fix.velocity->v_e_mps = ned_to_ecef(other) * v_n_mps;
  }
}

const Finding* find(const LogLook& look, const std::string& about) {
  const auto found = std::find_if(look.findings.begin(), look.findings.end(),
                                  [&](const Finding& f) { return f.about == about; });
  return found == look.findings.end() ? nullptr : &*found;
}

struct LogFault {
  std::string name{};
  std::string about{};
  std::string remedy{};  ///< or how it begins
  std::function<void(Seen&)> make{};
};

Eigen::Vector3d ned(double n, double e, double d) { return {n, e, d}; }

std::vector<LogFault> imu_log_faults() {
  const auto force = [](double factor) {
    return [factor](Seen& s) {
      each_increment(s, [&](ImuIncrement& inc) { inc.dv_b_mps *= factor; });
    };
  };
  const auto rate = [](double factor) {
    return [factor](Seen& s) {
      each_increment(s, [&](ImuIncrement& inc) { inc.dtheta_b_rad *= factor; });
    };
  };
  return {
      {"in g", "accelerometer-unit", "--accel-unit g", force(1.0 / 9.80665)},
      {"in mg", "accelerometer-unit", "--accel-unit mg", force(1000.0 / 9.80665)},
      {"increments as rates", "accelerometer-unit", "name the columns", force(1.0 / kDriveRateHz)},
      {"half", "accelerometer-unit", "check the times", force(0.5)},
      {"gravity removed", "accelerometer-unit", "record the total",
       [](Seen& s) {
         each_increment(s, [](ImuIncrement& inc) { inc.dv_b_mps.z() += 9.81 * inc.dt_s; });
       }},
      {"deg/s as rad/s", "gyro-unit", "--gyro-unit deg/s", rate(180.0 / std::numbers::pi)},
      {"rad/s as deg/s", "gyro-unit", "--gyro-unit rad/s", rate(std::numbers::pi / 180.0)},
      {"gyros of the opposite sign", "gyro-unit", "--column gx=-", rate(-1.0)},
      {"gravity for the force against it", "gyro-unit", "--column gx=-", force(-1.0)}};
}

std::vector<LogFault> fix_log_faults() {
  const auto velocity = [](const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& change) {
    return [change](Seen& s) { each_velocity(s, change); };
  };
  return {{"up for down", "vertical-velocity", "--column vd=-",
           velocity([](const auto& v) { return ned(v.x(), v.y(), -v.z()); })},
          {"east first", "horizontal-velocity", "--column vn=<its name of the east",
           velocity([](const auto& v) { return ned(v.y(), v.x(), v.z()); })},
          {"north negative", "horizontal-velocity", "--column vn=-",
           velocity([](const auto& v) { return ned(-v.x(), v.y(), v.z()); })},
          {"velocity in km/h", "horizontal-velocity", "name the column with its unit",
           velocity([](const auto& v) { return ned(3.6 * v.x(), 3.6 * v.y(), 3.6 * v.z()); })},
          {"longitude first", "horizontal-velocity", "--column lat=<its name of the longitude",
           [](Seen& s) {
             each_place(s, [](const Geodetic& g) {
               return Geodetic{g.lon_rad, g.lat_rad, g.height_m};
             });
           }},
          {"radians as degrees", "horizontal-velocity", "name the columns lat_rad",
           [](Seen& s) {
             each_place(s, [](const Geodetic& g) {
               return Geodetic{g.lat_rad * kRadPerDeg, g.lon_rad * kRadPerDeg, g.height_m};
             });
           }},
          {"18 s apart", "clock-offset", "--gnss-time-offset-s -18.00",
           [](Seen& s) {
             for (GnssFix& fix : s.fixes) fix.time += std::chrono::seconds{18};
           }},
          {"Unix time beside GPS time", "time-line", "--gnss-time-offset-s -315964782.",
           [](Seen& s) {
             for (GnssFix& fix : s.fixes) fix.time += std::chrono::seconds{315964782};
           }},
          {"odometer in km/h", "odometer-unit", "name the column", [](Seen& s) {
             for (OdometerSpeed& speed : s.speeds) speed.speed_mps *= 3.6;
           }}};
}

}  // namespace

TEST_CASE("right logs: no finding but notes, seeds 1 to 10" * doctest::test_suite("heavy")) {
  for (std::uint64_t seed = 1; seed <= kDriveSeeds; ++seed) {
    for (const ImuErrorModel& imu :
         {automotive_mems_model(), imu_class_model(ImuClass::kTactical, RangeEnd::kMid)}) {
      for (const double position_sigma_m : {0.02, 2.5}) {
        CAPTURE(seed);
        CAPTURE(position_sigma_m);
        const LogLook look = look_at(seen(imu, position_sigma_m, seed));
        for (const Finding& f : look.findings) {
          CAPTURE(f.text);
          CHECK(f.certainty == Certainty::kNote);
        }
        CHECK(look.imu.up_b.z() < -0.99);
        // Forward within 15 deg, by 290 pairs of speeds of 0.05 m/s.
        CHECK(look.imu.forward_b.x() > 0.96);
        CHECK(std::abs(look.shared.clock_offset_s) < 4.0 * look.shared.clock_offset_sigma_s);
      }
    }
  }
}

TEST_CASE("every fault of a kind is certain, and its remedy is the one that mends it" *
          doctest::test_suite("heavy")) {
  std::vector<LogFault> faults = imu_log_faults();
  for (LogFault& fault : fix_log_faults()) faults.push_back(std::move(fault));
  for (std::uint64_t seed = 1; seed <= kDriveSeeds; ++seed) {
    // A bias of the car-grade part, up to 0.9 m/s^2, would be the gravity that was removed.
    const Seen right = seen(imu_class_model(ImuClass::kTactical, RangeEnd::kMid), 2.5, seed);
    for (const LogFault& fault : faults) {
      CAPTURE(seed);
      CAPTURE(fault.name);
      Seen wrong = right;
      fault.make(wrong);
      const LogLook look = look_at(wrong);
      const Finding* found = find(look, fault.about);
      REQUIRE(found != nullptr);
      CAPTURE(found->text);
      CHECK(found->certainty == Certainty::kCertain);
      CAPTURE(found->remedy);
      CHECK(found->remedy.starts_with(fault.remedy));
    }
  }
}

TEST_CASE("axes that point elsewhere are told by gravity and by speed changes" *
          doctest::test_suite("heavy")) {
  struct Case {
    std::string letters;
    Eigen::Matrix3d vehicle_to_log;
  };
  Eigen::Matrix3d flu = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  Eigen::Matrix3d rfu;
  rfu << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  Eigen::Matrix3d dfr;
  dfr << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  for (const Case& c : {Case{"flu", flu}, Case{"rfu", rfu}, Case{"dfr", dfr}}) {
    CAPTURE(c.letters);
    Seen s = seen(automotive_mems_model(), 2.5, 1);
    each_increment(s, [&](ImuIncrement& inc) {
      inc.dtheta_b_rad = c.vehicle_to_log * inc.dtheta_b_rad;
      inc.dv_b_mps = c.vehicle_to_log * inc.dv_b_mps;
    });
    const LogLook look = look_at(s);
    const Finding* axes = find(look, "axes");
    REQUIRE(axes != nullptr);
    CHECK(axes->remedy == "--axes " + c.letters);
  }
}

TEST_CASE("clocks 0.3 s apart and velocities 0.2 s late: both are measured, within 4 sigma") {
  Seen s = seen(automotive_mems_model(), 0.02, 1);
  constexpr double kLateS = 0.2;
  constexpr double kClockS = 0.3;
  for (GnssFix& fix : s.fixes) {
    const double t_s = to_seconds(fix.time);
    fix.velocity->v_e_mps +=
        truth_at(town_drive(), t_s - kLateS).nav.v_e_mps - truth_at(town_drive(), t_s).nav.v_e_mps;
    fix.time += duration_from_seconds(kClockS);
  }
  const LogLook look = look_at(s);
  CAPTURE(look.gnss.velocity_lag_sigma_s);
  CHECK(std::abs(look.gnss.velocity_lag_s - kLateS) < 4.0 * look.gnss.velocity_lag_sigma_s);
  CHECK(look.gnss.velocity_lag_sigma_s < 0.03);
  CAPTURE(look.shared.clock_offset_s);
  CHECK(std::abs(look.shared.clock_offset_s + kClockS) < 4.0 * look.shared.clock_offset_sigma_s);
  CHECK(look.shared.clock_offset_sigma_s < 0.2);
}

TEST_CASE("an antenna ahead of the axle leads the turns, and is no clock that is off") {
  GnssErrorModel gnss;
  gnss.position_sigma_n_m.setConstant(0.02);
  gnss.velocity_sigma_n_mps.setConstant(0.05);
  gnss.lever_arm_b_m = {2.0, 0.0, -1.0};
  const auto truth = true_increments(town_drive(), kDriveRateHz, kDriveS);
  test::Recording log =
      test::record(town_drive(), truth, automotive_mems_model(), gnss, 1.0, 1.0, 1);
  const LogLook look = look_at({std::move(log.imu), std::move(log.fixes), {}});
  CAPTURE(look.shared.antenna_lead_m);
  CAPTURE(look.shared.clock_offset_s);
  // An offset of the clocks looks alike but for changes of speed: 0.15 s, 10 m/s.
  CHECK(test::near(look.shared.antenna_lead_m, 2.0, 1.5));
  CHECK(std::abs(look.shared.clock_offset_s) < 4.0 * look.shared.clock_offset_sigma_s);
}

TEST_CASE("gaps, bursts, sessions, stuck channels and full scale are counted") {
  Seen s = seen(automotive_mems_model(), 2.5, 1);
  s.imu.erase(s.imu.begin() + 2000, s.imu.begin() + 2100);
  for (std::size_t k = 5000; k < s.imu.size(); ++k) s.imu[k].time += std::chrono::minutes{5};
  s.imu[3000].time -= std::chrono::milliseconds{15};
  each_increment(s, [](ImuIncrement& inc) {
    inc.dtheta_b_rad.x() = 0.0;
    inc.dv_b_mps.z() = std::max(inc.dv_b_mps.z(), -2.0 * 9.80665 * inc.dt_s);
  });
  for (std::size_t k = 100; k < 120; ++k) s.imu[k].dv_b_mps.z() = -2.0 * 9.80665 * s.imu[k].dt_s;
  const LogLook look = look_at(s);
  CHECK(look.imu.time.gaps == 3);  // the hole, the session, and the step after the early sample
  CHECK(test::near(look.imu.time.longest_gap_s, 300.02, 1e-6));
  CHECK(look.imu.time.bursts == 1);
  CHECK(look.imu.time.sessions == 2);
  CHECK(look.imu.is_stuck == std::array{true, false, false, false, false, false});
  CHECK(look.imu.saturated >= 20);
  CHECK(test::near(look.imu.time.step_s, 1.0 / kDriveRateHz, 1e-9));
}

TEST_CASE("of nothing there is nothing to say") {
  const LogLook look = LogInspector().look();
  CHECK(look.findings.empty());
  CHECK(look.imu.time.records == 0);
}

}  // namespace leeway::sim
