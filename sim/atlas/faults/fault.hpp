/// @file
/// The faults that a navigator is tried by: what a receiver, an IMU, a clock or a start does to its
/// inputs.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "leeway/earth/names.hpp"
#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sensors/imu.hpp"
#include "sim/atlas/faults/regime.hpp"

namespace leeway::sim {

/// An input and when it arrives, in true time.
template <class T>
struct Arrival {
  double at_s{};
  T input{};
};

struct FaultInputs {
  std::vector<Arrival<ImuIncrement>> imu{};
  std::vector<Arrival<GnssFix>> fixes{};
};

struct FaultWindow {
  double from_s{};
  double to_s{};

  bool has(double t_s) const { return t_s > from_s && t_s <= to_s; }
};

/// What a fault does to the inputs within a window. They need not stay in order. Pure: the same
/// inputs become the same, on any thread.
using Damage = std::function<void(FaultInputs&, const FaultWindow&)>;

enum class FaultGroup { kReceiver, kImu, kTime, kStart };
constexpr auto names(FaultGroup) { return std::array{"receiver", "IMU", "time", "start"}; }

struct Fault {
  std::string name{};
  FaultGroup group{};
  double duration_s{30.0};
  bool from_start{false};  ///< else from when the navigator has settled
  bool lasts{false};       ///< does not end: nothing to recover to is asked for
  /// Why no navigator could tell; empty: it could.
  std::string unknowable{};
  double knowable_below_m{0.0};  ///< ... unless the receiver's 1 sigma is below this
  Damage damage{};
  std::function<Trajectory(const Regime&)> motion{};  ///< in place of the regime's
  /// Started at the truth with a heading that is off by so much, in place of aligning; 0: aligns.
  double heading_error_rad{0.0};
  std::vector<VehicleKind> cannot_befall{};  ///< vehicles that do not move like that

  bool can_befall(VehicleKind kind) const {
    return std::find(cannot_befall.begin(), cannot_befall.end(), kind) == cannot_befall.end();
  }
};

/// Calls f(input, seconds since the fault began) on the inputs that arrive in the window.
template <class T, class F>
void for_each_in(std::vector<Arrival<T>>& arrivals, const FaultWindow& window, F&& f) {
  for (Arrival<T>& a : arrivals) {
    if (window.has(a.at_s)) f(a.input, a.at_s - window.from_s);
  }
}

/// Drops the inputs of the window for which drop(seconds since the fault began).
template <class T, class Drop>
void drop_in(std::vector<Arrival<T>>& arrivals, const FaultWindow& window, Drop&& drop) {
  std::erase_if(arrivals, [&](const Arrival<T>& a) {
    return window.has(a.at_s) && drop(a.at_s - window.from_s);
  });
}

Damage on_fixes(std::function<void(GnssFix&, double since_s)> f);
Damage on_imu(std::function<void(ImuIncrement&, double since_s)> f);

/// North, east, down to ECEF where the fix is. @pre it has a position.
Eigen::Matrix3d ned_to_ecef_at(const GnssFix& fix);

/// Whether it is the turn of one in n, one a second.
bool is_every(int n, double since_s);

std::vector<Fault> receiver_faults();
std::vector<Fault> noise_faults();  ///< of the receiver: what it claims, how often it speaks
std::vector<Fault> imu_faults();
std::vector<Fault> time_faults();
std::vector<Fault> start_faults();

/// All of them, by group.
const std::vector<Fault>& faults();

}  // namespace leeway::sim
