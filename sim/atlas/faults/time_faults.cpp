#include <cmath>

#include "leeway/sim/tools/random.hpp"
#include "sim/atlas/faults/fault.hpp"

namespace leeway::sim {
namespace {

Fault timing(std::string name, double duration_s, Damage damage) {
  return {.name = std::move(name), .group = FaultGroup::kTime, .duration_s = duration_s,
          .damage = std::move(damage)};
}

/// Fixes that arrive and are stamped later than they are valid.
Damage late_fixes(double arrival_s, double stamp_s) {
  return [=](FaultInputs& inputs, const FaultWindow& window) {
    for (Arrival<GnssFix>& a : inputs.fixes) {
      if (!window.has(a.at_s)) continue;
      a.at_s += arrival_s;
      a.input.time += duration_from_seconds(stamp_s);
    }
  };
}

Damage unmarked_latency(double by_s) { return late_fixes(by_s, by_s); }
Damage late_arrival(double by_s) { return late_fixes(by_s, 0.0); }
Damage fix_clock_off(double by_s) { return late_fixes(0.0, by_s); }

/// Only the velocity is of an earlier epoch.
Damage old_velocity(double epochs) {
  return [=](FaultInputs& inputs, const FaultWindow& window) {
    const std::vector<Arrival<GnssFix>> before = inputs.fixes;
    for (std::size_t k = 1; k < before.size(); ++k) {
      if (!window.has(before[k].at_s)) continue;
      inputs.fixes[k].input.velocity->v_e_mps =
          epochs * before[k - 1].input.velocity->v_e_mps +
          (1.0 - epochs) * before[k].input.velocity->v_e_mps;
    }
  };
}

/// Each second fix after the one that follows it.
void swap_pairs(FaultInputs& inputs, const FaultWindow& window) {
  for (Arrival<GnssFix>& a : inputs.fixes) {
    if (window.has(a.at_s) && is_every(2, a.at_s - window.from_s)) a.at_s += 1.2;
  }
}

Damage imu_clock_off(double by_s) {
  return on_imu([=](ImuIncrement& inc, double) { inc.time += duration_from_seconds(by_s); });
}

Damage both_clocks_off(double by_s) {
  return [=](FaultInputs& inputs, const FaultWindow& window) {
    imu_clock_off(by_s)(inputs, window);
    fix_clock_off(by_s)(inputs, window);
  };
}

/// The clock of the IMU runs fast, and is set right again at the end.
void run_fast(ImuIncrement& inc, double since_s) {
  constexpr double kFast = 1e-3;
  inc.time += duration_from_seconds(kFast * since_s);
  inc.dt_s *= 1.0 + kFast;
}

void jitter(FaultInputs& inputs, const FaultWindow& window) {
  Random random(1, 0, kFirstFreeStream);
  for_each_in(inputs.imu, window, [&](ImuIncrement& inc, double) {
    inc.time += duration_from_seconds(0.005 * (2.0 * random.uniform() - 1.0));
  });
}

/// Each increment of the window with the stamp of the one before, two by two.
void repeat_stamps(FaultInputs& inputs, const FaultWindow& window) {
  Time even{};
  bool is_even = true;
  for_each_in(inputs.imu, window, [&](ImuIncrement& inc, double) {
    if (is_even) even = inc.time;
    inc.time = even;
    is_even = !is_even;
  });
}

}  // namespace

std::vector<Fault> time_faults() {
  return {
      timing("fixes older than stamped by 0.2 s", 30.0, unmarked_latency(0.2)),
      timing("fixes older than stamped by 0.5 s", 30.0, unmarked_latency(0.5)),
      timing("fixes older than stamped by 1 s", 30.0, unmarked_latency(1.0)),
      timing("velocities older by half a second", 30.0, old_velocity(0.5)),
      timing("fixes arrive after 1.5 s", 30.0, late_arrival(1.5)),
      timing("fixes arrive after 3 s", 30.0, late_arrival(3.0)),
      timing("fixes out of order", 30.0, swap_pairs),
      timing("receiver's clock off by 0.05 s", 30.0, fix_clock_off(0.05)),
      timing("receiver's clock off by 0.2 s", 30.0, fix_clock_off(0.2)),
      timing("receiver's clock off by 1 s", 30.0, fix_clock_off(1.0)),
      timing("receiver's clock back by 1 s, a leap", 30.0, fix_clock_off(-1.0)),
      timing("receiver's clock off by 18 s", 30.0, fix_clock_off(18.0)),
      timing("receiver's clock off by -18 s", 30.0, fix_clock_off(-18.0)),
      timing("IMU's clock fast by 1e-3", 60.0, on_imu(run_fast)),
      timing("IMU's clock off by 1 s", 30.0, imu_clock_off(1.0)),
      timing("IMU's clock off by 1 h", 30.0, imu_clock_off(3600.0)),
      timing("both clocks off by 1 h", 30.0, both_clocks_off(3600.0)),
      timing("stamps jitter by 5 ms", 30.0, jitter),
      timing("stamps twice", 30.0, repeat_stamps),
  };
}

}  // namespace leeway::sim
