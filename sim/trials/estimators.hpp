/// @file
/// What is under test in a trial: the filter alone, or the navigator around it. Part of trial.
#pragma once

#include <deque>
#include <functional>
#include <optional>

#include "leeway/navigator/navigator.hpp"
#include "leeway/sim/scene/vehicle_sensors.hpp"
#include "leeway/sim/trials/trial.hpp"

namespace leeway::sim {

/// What is believed at a moment.
struct TrialBelief {
  Estimate estimate{};
  ErrorMatrix P{ErrorMatrix::Zero()};
};

/// The filter alone. It has each fix at the fix's own time, whatever the latency: a second one goes
/// on without a fix that is scored until that arrives.
class EkfUnderTest {
 public:
  EkfUnderTest(const TrialPlan& plan, std::uint64_t seed);

  void advance(const ImuIncrement& inc);

  /// The belief at the fix's own time, without it.
  std::optional<TrialBelief> at_fix() const;
  void take(const GnssFix& fix, bool scored, TrialScore& score);

  /// The belief at the arrival of the scored fix, without it.
  std::optional<TrialBelief> at_arrival() const;
  void arrive(bool scored, TrialScore& score);

 private:
  Ekf filter_;
  std::optional<Ekf> without_fix_{};
};

/// The navigator as a vehicle runs it: aligned by itself unless the scene has [initial], fed with
/// fixes when they arrive and with the sensors of the scene's vehicle.
class NavigatorUnderTest {
 public:
  NavigatorUnderTest(const TrialPlan& plan, std::uint64_t seed);

  void advance(const ImuIncrement& inc);
  std::optional<TrialBelief> at_fix() const { return belief(); }
  void take(const GnssFix& fix, bool /*scored*/, TrialScore& /*score*/) { waiting_.push_back(fix); }
  std::optional<TrialBelief> at_arrival() const { return belief(); }
  void arrive(bool scored, TrialScore& score);

 private:
  std::optional<TrialBelief> belief() const;

  const TrialPlan& plan_;
  Navigator navigator_;
  std::optional<VehicleSensors> sensors_{};
  std::deque<GnssFix> waiting_{};
};

}  // namespace leeway::sim
