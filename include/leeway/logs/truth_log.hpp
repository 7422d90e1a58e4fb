/// @file
/// Truth or reference logs: a streaming reader, interpolation in time, and a writer.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "leeway/logs/csv_writer.hpp"
#include "leeway/logs/log_reader.hpp"
#include "leeway/strapdown/nav_state.hpp"

namespace leeway {

/// Row of a truth log; velocity and attitude are zero where it has none.
struct TruthRecord {
  NavStateNed nav{};
  bool has_velocity{false};
  bool has_attitude{false};
};

/// Reader of CSV truth logs, columns found by name in any order:
///
/// - t_s, lat_deg, lon_deg, height_m (ellipsoidal);
/// - all or none of vn_mps, ve_mps, vd_mps;
/// - all or none of roll_deg, pitch_deg, yaw_deg (body with respect to north-east-down).
///
/// An empty or NaN field of a group means that the row does not have the group.
class TruthLogReader : public LogReader<TruthRecord> {
 public:
  /// @throws Error when the file cannot be read, is empty or lacks columns (naming them).
  explicit TruthLogReader(const std::filesystem::path& path);
};

/// Truth log at any time, in constant memory: asked in the order of time.
class TruthTrack {
 public:
  static constexpr Duration kMaxGap = std::chrono::seconds{1};

  explicit TruthTrack(TruthLogReader reader);

  /// Record at t, linear between rows: a dt^2 / 8 off on a path of acceleration a. Euler angles go
  /// the shorter way, which is wrong for pitch near +-90 deg. Nothing outside the log, or between
  /// rows more than kMaxGap apart.
  /// @throws Error when t is before the t of the call before.
  std::optional<TruthRecord> interpolate(Time t);

  const LogSummary& summary() const { return reader_.summary(); }

 private:
  TruthLogReader reader_;
  std::optional<TruthRecord> before_{};  // the latest row at or before the last t
  std::optional<TruthRecord> after_{};
  Time last_t_{Time::min()};
};

/// Writer of all columns: every number is exact. Errors and the partial file are those of
/// CsvWriter.
class TruthLogWriter {
 public:
  explicit TruthLogWriter(const std::filesystem::path& path);

  /// Row of a record; a group that it does not have is NaN.
  void write(const TruthRecord& record);
  void close() { csv_.close(); }

 private:
  CsvWriter csv_;
};

}  // namespace leeway
