#include "leeway/sim/inspect/log_inspector.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "sim/inspect/findings.hpp"
#include "sim/inspect/imu_scan.hpp"
#include "sim/inspect/own_velocity.hpp"
#include "sim/inspect/shared_turns.hpp"
#include "sim/inspect/speed_ratio.hpp"

namespace leeway::sim {
namespace {

/// The clocks' offset: what the turns say, with the receiver's own lag taken out.
void set_clock_offset(SharedFigures& shared, const TurnMatch& turns, const FixFigures& gnss) {
  const bool has_lag = gnss.with_velocity > 0;
  shared.clock_offset_s = turns.offset_s + (has_lag ? gnss.velocity_lag_s : 0.0);
  shared.clock_offset_sigma_s =
      std::hypot(turns.offset_sigma_s, has_lag ? gnss.velocity_lag_sigma_s : 0.0);
}

void append(std::vector<Finding>& all, std::vector<Finding> some) {
  std::move(some.begin(), some.end(), std::back_inserter(all));
}

}  // namespace

struct LogInspector::Parts {
  ImuScan imu{};
  OwnVelocity gnss{};
  SharedTurns turns{};
  SpeedRatio odometer{};
};

LogInspector::LogInspector() : parts_(std::make_unique<Parts>()) {}
LogInspector::~LogInspector() = default;

void LogInspector::add(const ImuIncrement& inc) {
  parts_->imu.add(inc);
  parts_->turns.add(inc);
}

void LogInspector::add(const GnssFix& fix) {
  parts_->gnss.add(fix);
  parts_->turns.add(fix);
  parts_->odometer.add(fix);
}

void LogInspector::add(const OdometerSpeed& speed) { parts_->odometer.add(speed); }

LogLook LogInspector::look() const {
  LogLook look;
  look.imu = parts_->imu.figures();
  look.imu.forward_b = parts_->turns.forward_b().value_or(Eigen::Vector3d::Constant(kUnseen));
  look.gnss = parts_->gnss.figures();
  const TurnMatch turns = parts_->turns.match();
  look.shared.turn_correlation = turns.correlation;
  look.shared.turn_ratio = turns.ratio;
  look.shared.turn_ratio_sigma = turns.ratio_sigma;
  look.shared.antenna_lead_m = turns.lead_m;
  look.shared.odometer_ratio = parts_->odometer.ratio();
  set_clock_offset(look.shared, turns, look.gnss);
  look.findings = imu_findings(look.imu);
  if (has_gravity(look.imu)) {
    append(look.findings, axes_findings(look.imu));
    append(look.findings, turn_findings(turns, look.shared, look.imu.time.step_s));
  }
  append(look.findings, parts_->gnss.findings());
  append(look.findings, fix_findings(look.gnss));
  append(look.findings, odometer_findings(look.shared.odometer_ratio));
  append(look.findings, time_line_findings(look.imu.time, look.gnss.time));
  std::stable_sort(look.findings.begin(), look.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.certainty > b.certainty; });
  return look;
}

bool LogLook::is_certainly_wrong() const {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.certainty == Certainty::kCertain; });
}

}  // namespace leeway::sim
