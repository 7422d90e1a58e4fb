/// @file
/// The speed that an odometer tells, over that of the receiver.
#pragma once

#include <cmath>
#include <optional>

#include "leeway/navigator/aidings.hpp"
#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sim/inspect/log_look.hpp"

namespace leeway::sim {

/// An odometer's speed over the receiver's, while the vehicle moves.
class SpeedRatio {
 public:
  void add(const OdometerSpeed& speed) { last_ = speed; }

  void add(const GnssFix& fix) {
    if (!last_ || !fix.velocity || to_seconds(fix.time - last_->time) > kSameTimeS) return;
    const double speed_mps = fix.velocity->v_e_mps.norm();
    if (speed_mps < kMovingMps) return;
    across_ += speed_mps * std::abs(last_->speed_mps);
    square_ += speed_mps * speed_mps;
    ++count_;
  }

  double ratio() const { return count_ < kFewSpeeds ? kUnseen : across_ / square_; }

 private:
  static constexpr double kSameTimeS = 0.3;
  static constexpr double kMovingMps = 3.0;
  static constexpr int kFewSpeeds = 10;

  std::optional<OdometerSpeed> last_{};
  double across_{0.0};
  double square_{0.0};
  int count_{0};
};

}  // namespace leeway::sim
