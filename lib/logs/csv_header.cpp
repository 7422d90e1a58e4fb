#include "lib/logs/csv_header.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "leeway/earth/error.hpp"
#include "lib/logs/column_names.hpp"

namespace leeway {

namespace {

constexpr std::size_t kRowsForUnit = 8;
// What a header in seconds must not exceed: by so much even a slow log is faster.
constexpr double kContradiction = 5.0;

Separator separator_of(std::string_view header) {
  if (header.find(';') != std::string_view::npos) return Separator::kSemicolon;
  if (header.find('\t') != std::string_view::npos) return Separator::kTab;
  const bool has_blanks =
      header.find(',') == std::string_view::npos && header.find(' ') != std::string_view::npos;
  return has_blanks && header.find('"') == std::string_view::npos ? Separator::kRuns
                                                                  : Separator::kComma;
}

std::string_view text_of(Separator separator) {
  if (separator == Separator::kSemicolon) return "';'";
  if (separator == Separator::kTab) return "tabs";
  return separator == Separator::kRuns ? "blanks" : "','";
}

std::string to_text(double value) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6);
  return {text.data(), end.ptr};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

CsvHeader::CsvHeader(std::string_view line, std::string path) : path_(std::move(path)) {
  for (const std::string_view name : split_fields(line, Separator::kComma)) {
    names_.emplace_back(name);
  }
  titles_ = names_;
  columns_.resize(names_.size());
  scales_.assign(names_.size(), 1.0);
  names_unit_.assign(names_.size(), true);
}

CsvHeader CsvHeader::understood(std::string_view line, std::string path, const LogFormat& format) {
  const Separator separator = separator_of(line);
  std::string names = plain_csv(line, separator);
  if (separator == Separator::kRuns) {
    names.clear();
    for (const std::string_view name : split_fields(line, separator)) {
      if (!names.empty()) names += ',';
      names += name;
    }
  }
  CsvHeader header(names, std::move(path));
  header.separator_ = separator;
  std::vector<bool> is_alias(header.names_.size());
  for (std::size_t k = 0; k < header.names_.size(); ++k) {
    const ColumnMeaning meaning = meaning_of(header.titles_[k], format);
    header.names_[k] = meaning.column;
    header.scales_[k] = meaning.scale;
    header.names_unit_[k] = meaning.names_unit;
    is_alias[k] = meaning.is_alias;
  }
  const auto is_chosen = [&](std::size_t k) {
    return std::any_of(format.columns.begin(), format.columns.end(), [&](const auto& named) {
      return named.second == header.titles_[k] || named.second == "-" + header.titles_[k];
    });
  };
  // Of two that mean the same, the owner's choice counts, then Leeway's own name; of two times, the
  // first.
  for (std::size_t k = 0; k < header.names_.size(); ++k) {
    if (is_chosen(k)) continue;
    for (std::size_t j = 0; j < header.names_.size(); ++j) {
      if (j == k || header.names_[j] != header.names_[k]) continue;
      const bool is_later_time = j < k && header.names_[k] == "t_s";
      const bool yields = is_chosen(j) || (is_alias[k] && (!is_alias[j] || is_later_time));
      if (yields) header.names_[k] = header.titles_[k];
      if (yields) break;
    }
  }
  return header;
}

std::size_t CsvHeader::index_of(std::string_view name) const {
  return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
}

std::vector<std::string_view> CsvHeader::missing(std::span<const NamedColumn> wanted) const {
  std::vector<std::string_view> names;
  for (const NamedColumn& column : wanted) {
    if (std::find(names_.begin(), names_.end(), column.name) == names_.end()) {
      names.push_back(column.name);
    }
  }
  return names;
}

void CsvHeader::use(std::span<const NamedColumn> wanted) {
  for (const NamedColumn& column : wanted) {
    const auto found = std::find(names_.begin(), names_.end(), column.name);
    if (found == names_.end()) continue;
    if (std::find(found + 1, names_.end(), column.name) != names_.end()) {
      throw Error(path_ + ": column " + std::string(column.name) + " stands twice in the header" +
                  "; say which is meant: --column " + std::string(column.name) + "=NAME");
    }
    const auto at = static_cast<std::size_t>(found - names_.begin());
    columns_[at] = column.column;
    columns_[at].scale = scales_[at];
  }
}

void CsvHeader::require(std::span<const NamedColumn> wanted, const std::string& expected) {
  if (const auto names = missing(wanted); !names.empty()) {
    refuse_linear_acceleration();
    std::string seen;
    if (separator_ != Separator::kComma) {
      seen = " (separated by " + std::string(text_of(separator_)) + ")";
    }
    throw Error(path_ + ": missing columns " + join(names) + seen + "; expected " + expected);
  }
  use(wanted);
}

bool CsvHeader::use_group(std::span<const NamedColumn> wanted) {
  const auto names = missing(wanted);
  if (names.size() == wanted.size()) return false;
  if (!names.empty()) {
    throw Error(path_ + ": missing columns " + join(names) + "; " + join(wanted) +
                " are used together: have all of them or none");
  }
  use(wanted);
  return true;
}

void CsvHeader::refuse_linear_acceleration() const {
  for (const std::string& title : titles_) {
    std::string name(title);
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (name.find("linear") == std::string::npos && name.find("user") == std::string::npos)
      continue;
    if (name.find("acc") == std::string::npos) continue;
    throw Error(path_ + ": column '" + title +
                "' has gravity removed, as phones give it, and cannot be used: record the total "
                "acceleration (phyphox: Acceleration with g; Sensor Logger: TotalAcceleration). "
                "If it has gravity, as in ROS, say so: --column ax='" +
                title + "', likewise y, z");
  }
}

std::vector<double> CsvHeader::steps_of(std::string_view rows) const {
  std::vector<Column> time_only(columns_.size());
  time_only[index_of("t_s")].slot = 0;
  const LineParser parser(separator_, std::move(time_only));
  std::vector<double> steps;
  std::optional<double> last;
  for (std::size_t end = rows.find('\n'); end != std::string_view::npos; end = rows.find('\n')) {
    std::string_view line = rows.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    rows.remove_prefix(end + 1);
    Time unused{};
    std::array<double, 1> value{};
    if (parser.parse(line, unused, value)) continue;
    if (last && value[0] > *last) steps.push_back(value[0] - *last);
    last = value[0];
  }
  return steps;
}

void CsvHeader::settle_time_unit(std::string_view rows, double slowest_s,
                                 std::vector<std::string>& notes) {
  const std::vector<double> steps = steps_of(rows);
  if (steps.size() < kRowsForUnit) return;
  constexpr std::array kTimeUnits{"s", "ms", "us", "ns"};
  const std::size_t at = index_of("t_s");
  const double step = median(steps) * (names_unit_[at] ? scales_[at] : 1.0);
  double bound = names_unit_[at] ? kContradiction * slowest_s : slowest_s;
  std::size_t unit = 0;
  for (; unit + 1 < kTimeUnits.size() && step > bound; bound *= 1e3) ++unit;
  if (unit == 0) return;
  if (names_unit_[at]) {
    unit = std::min(unit + static_cast<std::size_t>(std::lround(-std::log10(scales_[at]) / 3.0)),
                    kTimeUnits.size() - 1);
    throw Error(path_ + ": the log has a step of " + to_text(step) +
                " s between rows by its column " + titles_[at] + "; are its times in " +
                kTimeUnits[unit] + "? Then say --time-unit " + kTimeUnits[unit] +
                ", or --time-unit s if they are right");
  }
  columns_[at].scale = std::pow(1e-3, static_cast<double>(unit));
  notes.emplace_back("times are taken to be in " + std::string(kTimeUnits[unit]) +
                  ", by their step of " + to_text(median(steps)) + " in column " + titles_[at] +
                  "; if not, say --time-unit");
}

void CsvHeader::note(std::vector<std::string>& notes) const {
  std::string unused, silent;
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const bool is_used = columns_[k].slot != Column::kIgnored;
    std::string& list = is_used ? silent : unused;
    if (is_used && (names_unit_[k] || columns_[k].slot == Column::kTime)) continue;
    list += (list.empty() ? "" : ", ") + titles_[k];
    if (is_used) list += " as " + names_[k];
  }
  if (!unused.empty()) notes.emplace_back("columns not used: " + unused);
  if (!silent.empty()) {
    notes.emplace_back("columns that name no unit: " + silent +
                    "; if another, say --gyro-unit or --accel-unit");
  }
}

CsvHeader take_csv_header(LogOpening& log, std::span<const NamedColumn> wanted,
                          const std::string& expected, double slowest_s) {
  LineReader& lines = log.lines;
  CsvHeader header = CsvHeader::understood(first_line(lines, expected), lines.path(), log.format);
  header.require(wanted, expected);
  lines.next();
  if (log.format.time_unit.empty()) {
    header.settle_time_unit(lines.preview(), slowest_s, log.notes);
  }
  return header;
}

std::string join(std::span<const std::string_view> names) {
  std::string joined;
  for (const std::string_view name : names) {
    if (!joined.empty()) joined += ", ";
    joined += name;
  }
  return joined;
}

std::string join(std::span<const NamedColumn> columns) {
  std::vector<std::string_view> names;
  for (const NamedColumn& column : columns) names.push_back(column.name);
  return join(names);
}

}  // namespace leeway
