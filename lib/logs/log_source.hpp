/// @file
/// What all log readers share: lines or messages to rows in strictly increasing time, every damaged
/// one counted. Private to the log readers.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "leeway/earth/time.hpp"
#include "leeway/logs/line_reader.hpp"
#include "leeway/logs/log_reader.hpp"
#include "leeway/logs/log_summary.hpp"
#include "lib/logs/messages/message_reader.hpp"
#include "lib/logs/text_fields.hpp"

namespace leeway {

/// Blank, or a comment ("#" or "%").
bool is_blank_or_comment(std::string_view line);

/// "path:line:column: reason: 'text'".
std::string damage_message(const LineReader& lines, std::string_view line, const Fault& fault);

/// "path: byte 123: reason", and the fault's text where it is none of the message's own.
std::string damage_message(const MessageReader& messages, std::string_view message,
                           const Fault& fault);

/// What delivers records to a LogSource: lines of text, or messages.
inline bool is_no_record(const LineReader&, std::string_view line) {
  return is_blank_or_comment(line);
}
inline bool is_no_record(const MessageReader&, std::string_view) { return false; }

/// Why the record just delivered is damaged, before anybody parses it.
inline std::optional<LineDamage> damage_of_record(const LineReader& lines) {
  return lines.overlong() ? std::optional(LineDamage::kTooLong) : std::nullopt;
}
inline std::optional<LineDamage> damage_of_record(const MessageReader& messages) {
  return messages.damaged();
}

/// "line 12", or "byte 123" of messages.
inline std::string place_of_record(const LineReader& lines) {
  return "line " + std::to_string(lines.line_number());
}
inline std::string place_of_record(const MessageReader& messages) {
  return "byte " + std::to_string(messages.offset());
}

/// Continues seconds of week across the end of the week. Times beyond 0 to 604800 s are no seconds
/// of week, and stay.
class WeekUnroller {
 public:
  Time unroll(Time time_of_week);

 private:
  std::optional<Time> last_{};  // time of week
  Duration offset_{};
};

template <class Row>
Time time_of(const Row& row) {
  return row.time;
}

/// Whether a row whose time is that of the row before is to be added to the one after it: then only
/// its time is wrong. A row that repeats the one before altogether is no news.
template <class Row>
bool carries_over(const Row& /*row*/, const Row& /*before*/) {
  return false;
}

template <class Row>
void add_to(Row& /*row*/, const Row& /*carried*/) {}

/// The rows of a log in strictly increasing time. Each counts as a record.
template <class Row, class Records = LineReader>
class LogSource final : public RecordSource<Row> {
 public:
  LogSource(Records records, RowParser<Row> parser, std::string_view layout = "CSV",
            std::vector<std::string> notes = {})
      : records_(std::move(records)), parser_(std::move(parser)), layout_(layout) {
    summary_.notes = std::move(notes);
  }

  std::optional<Row> next() override {
    std::optional<Row> row = held_ ? std::exchange(held_, std::nullopt) : read();
    if (row && (!last_ || time_of(*row) - *last_ > suspect_)) row = settle(std::move(*row));
    if (!row) return row;
    last_ = time_of(*row);
    learn_step(*last_);
    newest_ = *row;
    if (carried_) add_to(*row, *std::exchange(carried_, std::nullopt));
    ++summary_.records;
    return row;
  }

  LogSummary& summary() { return summary_; }
  const LogSummary& summary() const override { return summary_; }
  std::string_view layout() const override { return layout_; }

 private:
  static constexpr Duration kSuspectJump = std::chrono::seconds{10};
  static constexpr int kSuspectSteps = 10;

  // A fast log is doubted sooner: what is believed of a damaged time costs all rows before it.
  void learn_step(Time time) {
    if (!first_) first_ = time;
    if (summary_.records == kSuspectSteps) suspect_ = std::min(time - *first_, kSuspectJump);
  }

  std::optional<Row> read() {
    Row row;
    while (const auto record = second_session_ ? std::nullopt
                               : is_repeated_  ? std::optional(line_)
                                               : records_.next()) {
      if (is_no_record(records_, *record)) continue;
      line_ = *record;
      if (!std::exchange(is_repeated_, false)) ++summary_.lines;
      if (const auto damage = damage_of_record(records_)) {
        reject(*damage);
      } else if (const auto fault = parser_(line_, row); fault && !fault->is_row) {
        if (fault->is_damage)
          summary_.add_damage(fault->reason, damage_message(records_, line_, *fault));
      } else if (is_repeated_ = fault.has_value();
                 last_ && time_of(row) == *last_ && carries_over(row, *newest_)) {
        carry_over(row);
      } else if (last_ && time_of(row) <= *last_) {
        reject_order(time_of(row), *last_);
        watch_for_session(time_of(row));
      } else {
        restart_.reset();
        return row;
      }
    }
    if (!second_session_) summary_.incomplete = records_.damage();
    if (std::exchange(is_asked_, true)) return std::nullopt;
    const auto fault = parser_({}, row);
    // What is wrong with a log as a whole has a text; an empty line is no fault.
    if (fault && fault->is_damage && !fault->text.empty())
      summary_.add_damage(fault->reason, damage_message(records_, {}, *fault));
    if (!fault && !(last_ && time_of(row) <= *last_)) return row;
    return std::nullopt;
  }

  // A time far ahead of the one before is a gap or a damaged digit. The row after it tells: were a
  // damaged one taken, all that follow would go back in time and the rest of the log would be lost.
  Row settle(Row row) {
    for (;;) {
      std::string message = damage_message(records_, line_, {LineDamage::kTimeJumpsAhead, line_});
      std::optional<Row> following = read();
      while (following && time_of(*following) <= time_of(row) &&
             time_of(row) - time_of(*following) <= suspect_) {
        if (time_of(*following) == time_of(row) && carries_over(*following, row)) {
          carry_over(*following);
        } else {
          reject_order(time_of(*following), time_of(row));
        }
        following = read();
      }
      if (!following || time_of(*following) > time_of(row)) {
        held_ = std::move(following);
        return row;
      }
      summary_.add_damage(LineDamage::kTimeJumpsAhead, std::move(message));
      row = std::move(*following);
      if (last_ && time_of(row) - *last_ <= suspect_) return row;
    }
  }

  // Times that go back and then go on are no damage: they are those of another session, whose end
  // would be taken for the end of this one.
  void watch_for_session(Time time) {
    if (!restart_ || time <= restart_->last)
      restart_ = Restart{time, time, place_of_record(records_)};
    restart_->last = time;
    const Duration back = *last_ - restart_->first;
    second_session_ = back > kSuspectJump && time - restart_->first > kSuspectJump;
    if (!second_session_) return;
    summary_.incomplete = records_.path() + ": a second session begins at " + restart_->place +
                          ", with times " + std::to_string(to_seconds(back)) +
                          " s earlier; it is not read: split the file there";
  }

  void carry_over(const Row& row) {
    Row sum = row;
    if (carried_) add_to(sum, *carried_);
    carried_ = sum;
    newest_ = row;
    ++summary_.carried_over;
  }

  void reject_order(Time time, Time before) {
    reject(time < before ? LineDamage::kTimeGoesBack : LineDamage::kDuplicateTime);
  }

  void reject(LineDamage reason) {
    summary_.add_damage(reason, damage_message(records_, line_, {reason, line_}));
  }

  Records records_;
  RowParser<Row> parser_;
  std::string_view layout_;
  LogSummary summary_{};
  std::string_view line_{};  // read last, or the message
  bool is_repeated_{false};  // it has more rows

  // Rows before last_, each later than the one before.
  struct Restart {
    Time first{};
    Time last{};
    std::string place{};
  };
  std::optional<Restart> restart_{};
  bool second_session_{false};
  bool is_asked_{false};       // the parser, for what it holds at the end
  std::optional<Row> held_{};  // read ahead to settle() the row before it
  std::optional<Time> last_{};
  std::optional<Time> first_{};
  Duration suspect_{kSuspectJump};  // a longer step, of some ten of the usual ones
  std::optional<Row> newest_{};     // as it was read
  std::optional<Row> carried_{};    // waits for the next row
};

}  // namespace leeway
