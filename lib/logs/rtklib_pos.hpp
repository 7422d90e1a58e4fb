/// @file
/// The RTKLIB .pos layout. Private to the GNSS log reader.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "leeway/sensors/gnss_fix.hpp"
#include "lib/logs/text_fields.hpp"

namespace leeway {

/// Field names, time system and options are told by the lines that start with '%'.
/// Source: RTKLIB ver. 2.4.2 Manual, appendix B.1.
class RtklibParser {
 public:
  /// @throws Error on an e/n/u baseline, a geodetic height or a datum other than WGS-84, or a
  /// column header without a position and its standard deviations.
  void read_header(std::string_view line, const std::string& path);

  bool has_columns() const { return has_columns_; }

  std::optional<Fault> operator()(std::string_view line, GnssFix& fix) const;

 private:
  void read_columns(std::string_view line, const std::string& path);
  std::optional<Fault> parse_epoch(std::string_view& line, Time& time) const;

  LineParser fields_{};
  Duration to_gps_{0};  // from the log's calendar
  bool is_utc_{false};
  bool is_ecef_{false};
  bool has_columns_{false};
};

}  // namespace leeway
