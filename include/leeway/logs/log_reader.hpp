/// @file
/// What the readers of logs have in common.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "leeway/logs/log_summary.hpp"

namespace leeway {

/// The records of a log, one after the other.
template <class Record>
class RecordSource {
 public:
  virtual ~RecordSource() = default;
  virtual std::optional<Record> next() = 0;
  virtual const LogSummary& summary() const = 0;
  virtual std::string_view layout() const = 0;
};

/// A reader of a plain or gzip log, in constant memory. A damaged line costs that line.
template <class Record>
class LogReader {
 public:
  /// The next record, later than the one before; nothing at the end.
  std::optional<Record> next() { return source_->next(); }

  /// What was met so far.
  const LogSummary& summary() const { return source_->summary(); }

  /// The name of the layout, told from the content.
  std::string_view layout() const { return source_->layout(); }

 protected:
  explicit LogReader(std::unique_ptr<RecordSource<Record>> source) : source_(std::move(source)) {}

 private:
  std::unique_ptr<RecordSource<Record>> source_;
};

}  // namespace leeway
