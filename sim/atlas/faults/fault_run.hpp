/// @file
/// A drive of a regime with its truth, and a navigator that is fed with its inputs and compared
/// with it, ten times a second.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "leeway/navigator/navigator.hpp"
#include "leeway/sim/scene/scene.hpp"
#include "leeway/strapdown/nav_state.hpp"
#include "sim/atlas/faults/fault.hpp"
#include "sim/atlas/faults/regime.hpp"

namespace leeway::sim {

inline constexpr double kEpochS = 0.1;  ///< between comparisons

/// The motion, which trials share.
struct TrueDrive {
  Trajectory trajectory{};
  std::vector<NavState> truth{};  ///< at k kEpochS, from 0 on
  std::vector<ImuIncrement> increments{};
};

TrueDrive true_drive(const Trajectory& trajectory, double imu_rate_hz, double duration_s);

/// What sensors deliver on it.
/// @param first_fix_s  when the first fix is valid; the others follow at the interval
FaultInputs inputs_of(const TrueDrive& way, const ImuErrorModel& imu, const GnssScenario& gnss,
                      double first_fix_s, std::uint64_t seed);

struct FaultDrive {
  TrueDrive way{};
  FaultInputs inputs{};  ///< as the sensors deliver them, without any fault
};

/// Seed 1.
FaultDrive drive_of(const Regime& regime, const Trajectory& trajectory, double duration_s);

/// What of a solution can be wrong.
enum class FaultError { kPosition, kVelocity, kHeading };
constexpr auto names(FaultError) { return std::array{"position", "velocity", "heading"}; }

/// An error and what is claimed for it, both as the root of the sum of squares over the axes.
struct ErrorClaim {
  double error{0.0};
  double sigma{0.0};
};

/// What a navigator is like at one time.
struct FaultEpoch {
  double t_s{};
  bool has_solution{false};
  bool finite{true};         ///< of the solution, sigmas included
  bool stands_still{false};  ///< the time of the solution is that of the epoch before
  /// By FaultError: horizontal, m; velocity, m/s; heading, rad.
  std::array<ErrorClaim, 3> claims{};
  /// Errors over their claimed sigmas, by FaultError: north or east, the worst axis of velocity,
  /// heading. The last counts for little where the claim is tens of degrees: it is at most 180.
  std::array<double, 3> sigmas{};
  Health::State state{};

  static constexpr double kMostSigmas = 5.0;
  double horizontal_m() const { return claims.front().error; }
  double worst_sigmas() const { return *std::max_element(sigmas.begin(), sigmas.end()); }
  bool is_beyond() const { return has_solution && (!finite || worst_sigmas() > kMostSigmas); }
};

/// Feeds a navigator with all inputs by their time of arrival, and shows what it is like after each
/// epoch up to end_s. Where clocks disagree, a solution is right that is right by one of them: now,
/// or at its own time.
/// @param inputs  those of the way, spoiled
void run_navigator(Navigator& navigator, FaultInputs inputs, const TrueDrive& way, double end_s,
                   const std::function<void(const FaultEpoch&)>& observe);

/// Starts at the truth but for a turn about the vertical, with 3 deg of claimed sigma.
void start_turned(Navigator& navigator, const Regime& regime, const NavState& truth,
                  double heading_error_rad);

}  // namespace leeway::sim
