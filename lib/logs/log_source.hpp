/// @file
/// What all log readers share: lines to rows in strictly increasing time, every damaged line
/// counted. Private to the log readers.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "leeway/earth/time.hpp"
#include "leeway/logs/line_reader.hpp"
#include "leeway/logs/log_summary.hpp"
#include "lib/logs/text_fields.hpp"

namespace leeway {

/// Blank, or a comment ("#" or "%").
bool is_blank_or_comment(std::string_view line);

/// "path:line:column: reason: 'text'".
std::string damage_message(const LineReader& lines, std::string_view line, const Fault& fault);

/// Continues seconds of week across the end of the week.
class WeekUnroller {
 public:
  Time unroll(Time time_of_week);

 private:
  std::optional<Time> last_{};  // time of week
  Duration offset_{};
};

/// Rows in the order of a log. A Row has a `Time time`.
template <class Row>
class LogSource {
 public:
  LogSource(LineReader lines, RowParser<Row> parser)
      : lines_(std::move(lines)), parser_(std::move(parser)) {}

  /// The next row later than the one before.
  std::optional<Row> next() {
    std::optional<Row> row = held_ ? std::exchange(held_, std::nullopt) : read();
    if (row && (!last_ || row->time - *last_ > kSuspectJump)) row = settle(std::move(*row));
    if (row) last_ = row->time;
    return row;
  }

  LogSummary& report() { return report_; }
  const LogSummary& report() const { return report_; }

 private:
  static constexpr Duration kSuspectJump = std::chrono::seconds{10};

  std::optional<Row> read() {
    Row row;
    while (const auto line = lines_.next()) {
      if (is_blank_or_comment(*line)) continue;
      line_ = *line;
      ++report_.lines;
      if (lines_.overlong()) {
        reject(LineDamage::kTooLong);
      } else if (const auto fault = parser_(line_, row)) {
        report_.add_damage(fault->reason, damage_message(lines_, line_, *fault));
      } else if (last_ && row.time <= *last_) {
        reject_order(row.time, *last_);
      } else {
        return row;
      }
    }
    report_.incomplete = lines_.damage();
    return std::nullopt;
  }

  // A time far ahead of the one before is a gap or a damaged digit. The row after it tells: were a
  // damaged one taken, all that follow would go back in time and the rest of the log would be lost.
  Row settle(Row row) {
    for (;;) {
      std::string message = damage_message(lines_, line_, {LineDamage::kTimeJumpsAhead, line_});
      std::optional<Row> following = read();
      while (following && following->time <= row.time &&
             row.time - following->time <= kSuspectJump) {
        reject_order(following->time, row.time);
        following = read();
      }
      if (!following || following->time > row.time) {
        held_ = std::move(following);
        return row;
      }
      report_.add_damage(LineDamage::kTimeJumpsAhead, std::move(message));
      row = std::move(*following);
      if (last_ && row.time - *last_ <= kSuspectJump) return row;
    }
  }

  void reject_order(Time time, Time before) {
    reject(time < before ? LineDamage::kTimeGoesBack : LineDamage::kDuplicateTime);
  }

  void reject(LineDamage reason) {
    report_.add_damage(reason, damage_message(lines_, line_, {reason, line_}));
  }

  LineReader lines_;
  RowParser<Row> parser_;
  LogSummary report_{};
  std::string_view line_{};    // read last
  std::optional<Row> held_{};  // read ahead to settle() the row before it
  std::optional<Time> last_{};
};

}  // namespace leeway
