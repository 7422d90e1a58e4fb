/// @file
/// A look at logs as they are read: what a replay or `leeway info` then says of them.
#pragma once

#include <memory>

#include "leeway/navigator/aidings.hpp"
#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sensors/imu.hpp"
#include "leeway/sim/inspect/log_look.hpp"

namespace leeway::sim {

/// An observer of the records of an IMU log and a GNSS log, in constant memory. No filter is
/// involved. Records of a log come in the order of time; a fix or a reading comes before the
/// increments that end after it, unless the logs share no time.
class LogInspector {
 public:
  LogInspector();
  ~LogInspector();
  LogInspector(const LogInspector&) = delete;
  LogInspector& operator=(const LogInspector&) = delete;

  void add(const ImuIncrement& inc);
  void add(const GnssFix& fix);
  void add(const OdometerSpeed& speed);

  /// Figures and findings of what has been added so far.
  LogLook look() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace leeway::sim
