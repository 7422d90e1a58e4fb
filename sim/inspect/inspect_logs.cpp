#include "leeway/sim/inspect/inspect_logs.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "leeway/sim/inspect/log_inspector.hpp"
#include "sim/inspect/findings.hpp"

namespace leeway::sim {
namespace {

/// The records of one log, to be taken up to a time.
template <class Reader, class Record>
class Taken {
 public:
  template <class... Args>
  explicit Taken(const std::filesystem::path& path, const Args&... args) {
    if (path.empty()) return;
    reader_.emplace(path, args...);
    next_ = reader_->next();
  }

  template <class F>
  void take_until(Time t, const F& take) {
    for (; next_ && next_->time <= t; next_ = reader_->next()) take(*next_);
  }

  /// The next one; nothing at the end.
  std::optional<Record> take() {
    return next_ ? std::exchange(next_, reader_->next()) : std::nullopt;
  }

  LogSummary summary() const { return reader_ ? reader_->summary() : LogSummary{}; }
  std::string layout() const { return reader_ ? std::string(reader_->layout()) : std::string(); }

 private:
  std::optional<Reader> reader_{};
  std::optional<Record> next_{};
};

}  // namespace

ScalarColumns odometer_columns() {
  return {OdometerSpeed::kColumns[0], OdometerSpeed::kColumns[1], OdometerSpeed::kLargest};
}

std::optional<ClockOffset> find_clock_offset(LogsToInspect logs) {
  LogLook look = inspect(logs).look;
  const Duration told = logs.gnss_options.time_offset;
  if (!time_line_findings(look.imu.time, look.gnss.time).empty()) {
    logs.gnss_options.time_offset +=
        duration_from_seconds(look.imu.time.first_s - look.gnss.time.first_s);
    look = inspect(logs).look;
  }
  const double offset_s = look.shared.clock_offset_s;
  if (!std::isfinite(offset_s) || !(look.shared.turn_correlation > kSameTurns)) return std::nullopt;
  return ClockOffset{to_seconds(logs.gnss_options.time_offset - told) + offset_s,
                     look.shared.clock_offset_sigma_s};
}

InspectedLogs inspect(const LogsToInspect& logs, const std::function<void(Time)>& progress) {
  constexpr int kProgressEvery = 4096;
  Taken<ImuLogReader, ImuIncrement> imu(logs.imu, logs.imu_options);
  Taken<GnssLogReader, GnssFix> gnss(logs.gnss, logs.gnss_options);
  Taken<ScalarLogReader, ScalarRecord> odometer(logs.odometer, odometer_columns());
  LogInspector inspector;
  const auto take_until = [&](Time t) {
    gnss.take_until(t, [&](const GnssFix& fix) {
      odometer.take_until(fix.time, [&](const ScalarRecord& speed) {
        inspector.add(OdometerSpeed{speed.time, speed.value});
      });
      inspector.add(fix);
    });
  };
  for (int count = 0; const auto inc = imu.take(); ++count) {
    take_until(inc->time);
    inspector.add(*inc);
    if (progress && count % kProgressEvery == 0) progress(inc->time);
  }
  take_until(Time::max());
  return {inspector.look(), imu.layout(), gnss.layout(), imu.summary(), gnss.summary()};
}

}  // namespace leeway::sim
