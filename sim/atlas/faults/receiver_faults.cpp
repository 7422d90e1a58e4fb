#include <cmath>
#include <limits>
#include <optional>

#include "leeway/earth/earth.hpp"
#include "leeway/sim/tools/random.hpp"
#include "sim/atlas/faults/fault.hpp"

namespace leeway::sim {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kAgreeingFixes =
    "fixes that agree with each other for longer than an IMU can be trusted are right, by all that "
    "can be seen";

Fault receiver(std::string name, double duration_s, Damage damage) {
  return {.name = std::move(name), .group = FaultGroup::kReceiver, .duration_s = duration_s,
          .damage = std::move(damage)};
}

Fault unknowable(Fault fault, std::string why, double knowable_below_m = 0.0) {
  fault.unknowable = std::move(why);
  fault.knowable_below_m = knowable_below_m;
  return fault;
}

Fault lasting(Fault fault) {
  fault.lasts = true;
  return fault;
}

void move(GnssFix& fix, const Eigen::Vector3d& by_n_m) {
  fix.position->r_e_m += ned_to_ecef_at(fix) * by_n_m;
}

void speed_up(GnssFix& fix, const Eigen::Vector3d& by_n_mps) {
  fix.velocity->v_e_mps += ned_to_ecef_at(fix) * by_n_mps;
}

Damage moved_east(double by_m) {
  return on_fixes([by_m](GnssFix& fix, double) { move(fix, {0.0, by_m, 0.0}); });
}

Damage silent_receiver() {
  return [](FaultInputs& inputs, const FaultWindow& window) {
    drop_in(inputs.fixes, window, [](double) { return true; });
  };
}

/// The first fix of the window again and again.
/// @param sigma_m, sigma_mps  white noise on it
Damage frozen(double sigma_m, double sigma_mps) {
  return [=](FaultInputs& inputs, const FaultWindow& window) {
    std::optional<GnssFix> first;
    Random random(1, 0, kFirstFreeStream);
    for_each_in(inputs.fixes, window, [&](GnssFix& fix, double) {
      if (!first) first = fix;
      fix.position->r_e_m = first->position->r_e_m + sigma_m * random.normal3();
      fix.velocity->v_e_mps = first->velocity->v_e_mps + sigma_mps * random.normal3();
    });
  };
}

void put_on_null_island(GnssFix& fix, double) {
  fix.position->r_e_m = ecef_from_geodetic({});
  fix.velocity->v_e_mps.setZero();
}

Damage six_far_fixes() {
  return on_fixes([](GnssFix& fix, double since_s) {
    if (since_s > 6.0) return;
    move(fix, {800.0, 600.0, 0.0});
    fix.position->R_e_m2 = 0.01 * Eigen::Matrix3d::Identity();
  });
}

Damage ramp_east(double rate_mps) {
  return on_fixes([rate_mps](GnssFix& fix, double since_s) {
    move(fix, {0.0, rate_mps * since_s, 0.0});
  });
}

/// An acceleration that no accelerometer of this class can tell from its bias, in all the receiver
/// says.
Damage gentle_spoof() {
  constexpr double kRateMps2 = 0.02;
  return on_fixes([](GnssFix& fix, double since_s) {
    move(fix, {0.0, 0.5 * kRateMps2 * since_s * since_s, 0.0});
    speed_up(fix, {0.0, kRateMps2 * since_s, 0.0});
  });
}

Damage outliers_of(double off_m, double off_mps) {
  return on_fixes([=](GnssFix& fix, double since_s) {
    if (!is_every(10, since_s)) return;
    move(fix, {0.0, off_m, 0.0});
    speed_up(fix, {0.0, off_mps, 0.0});
  });
}

/// The velocity in north, east, down, multiplied from the left.
Damage velocity_times(const Eigen::Matrix3d& factor) {
  return on_fixes([factor](GnssFix& fix, double) {
    const Eigen::Matrix3d C_en = ned_to_ecef_at(fix);
    fix.velocity->v_e_mps = C_en * factor * C_en.transpose() * fix.velocity->v_e_mps;
  });
}

Eigen::Matrix3d swapping_north_and_east() {
  Eigen::Matrix3d swap;
  swap << 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  return swap;
}

/// Positions that wander together.
Damage multipath(double sigma_m, double time_s) {
  return [=](FaultInputs& inputs, const FaultWindow& window) {
    Random random(1, 0, kFirstFreeStream);
    Eigen::Vector3d error_n_m = sigma_m * random.normal3();
    const GaussMarkovStep step = discretize({.sigma = sigma_m, .tau_s = time_s}, 1.0);
    for_each_in(inputs.fixes, window, [&](GnssFix& fix, double) {
      move(fix, error_n_m);
      error_n_m = step.phi * error_n_m + step.sigma_end * random.normal3();
    });
  };
}

/// The position of another town, its errors and velocity right, until the receiver knows better.
Damage wrong_first_fixes() {
  return on_fixes([](GnssFix& fix, double) { move(fix, {3000.0, -4000.0, 50.0}); });
}

std::vector<Fault> of_position() {
  return {
      receiver("off by 100 m for 60 s", 60.0, moved_east(100.0)),
      receiver("off by 20 m for 30 s", 30.0, moved_east(20.0)),
      unknowable(lasting(receiver("jump of 20 m that stays", 30.0, moved_east(20.0))),
                 kAgreeingFixes),
      unknowable(lasting(receiver("jump of 50 m that stays", 30.0, moved_east(50.0))),
                 kAgreeingFixes),
      unknowable(lasting(receiver("jump of 500 m that stays", 30.0, moved_east(500.0))),
                 kAgreeingFixes),
      unknowable(receiver("spoofed ramp of 0.2 m/s", 60.0, ramp_east(0.2)),
                 "a position that drifts by 0.2 m/s is one of a receiver's own slow errors", 0.5),
      receiver("spoofed ramp of 1 m/s", 60.0, ramp_east(1.0)),
      receiver("spoofed ramp of 5 m/s", 60.0, ramp_east(5.0)),
      unknowable(receiver("spoofed gently, velocity too", 60.0, gentle_spoof()),
                 "positions and velocities agree, and their 0.02 m/s^2 is less than what an "
                 "accelerometer of this class may be off"),
      receiver("every 10th fix off by 30 m", 60.0, outliers_of(30.0, 0.0)),
      receiver("every 10th fix off by 300 m", 60.0, outliers_of(300.0, 0.0)),
      receiver("multipath of 5 m over 60 s", 60.0, multipath(5.0, 60.0)),
      receiver("multipath of 20 m over 10 s", 60.0, multipath(20.0, 10.0)),
      receiver("height off by 50 m", 30.0,
               on_fixes([](GnssFix& fix, double) { move(fix, {0.0, 0.0, -50.0}); })),
  };
}

std::vector<Fault> of_velocity() {
  return {
      receiver("every 10th velocity off by 5 m/s", 60.0, outliers_of(0.0, 5.0)),
      receiver("velocity off by 2 m/s", 30.0,
               on_fixes([](GnssFix& fix, double) { speed_up(fix, {0.0, 2.0, 0.0}); })),
      receiver("sign of velocity down", 30.0,
               velocity_times(Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal())),
      receiver("sign of all velocities", 30.0, velocity_times(-Eigen::Matrix3d::Identity())),
      receiver("velocity north and east swapped", 30.0, velocity_times(swapping_north_and_east())),
      receiver("velocity zero while moving", 30.0, velocity_times(Eigen::Matrix3d::Zero())),
      receiver("velocity in km/h", 30.0, velocity_times(3.6 * Eigen::Matrix3d::Identity())),
  };
}

}  // namespace

std::vector<Fault> receiver_faults() {
  Fault cold = unknowable(receiver("first 10 fixes in another town", 10.0, wrong_first_fixes()),
                          "the first fixes of a start agree with each other, and nothing else is "
                          "known of where it is");
  cold.from_start = true;
  std::vector<Fault> all{
      receiver("dead for 30 s", 30.0, silent_receiver()),
      receiver("dead for 120 s", 120.0, silent_receiver()),
      receiver("frozen to the bit", 30.0, frozen(0.0, 0.0)),
      receiver("frozen with noise", 30.0, frozen(0.05, 0.01)),
      receiver("null island", 30.0, on_fixes(put_on_null_island)),
      receiver("not a number", 30.0,
               on_fixes([](GnssFix& fix, double) { fix.position->r_e_m.x() = kNone; })),
      receiver("six fixes off by 1000 m, sigma 0.1 m", 30.0, six_far_fixes()),
      cold,
  };
  for (const auto& more : {of_position(), of_velocity()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

}  // namespace leeway::sim
