#include "lib/logs/text_fields.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace leeway {
namespace {

constexpr double kMaxTimeS = 9e9;  // a signed 64-bit count of nanoseconds ends at 9.2e9 s
constexpr std::int64_t kCountPerS = 1'000'000'000;
constexpr int kMaxWholeDigits = 10;

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

template <Separator separator>
bool is_separator(char c) {
  if constexpr (separator == Separator::kComma) return c == ',';
  return is_blank(c) || c == ',' || c == ';';
}

template <Separator separator>
const char* skip_to_field(const char* p, const char* end) {
  if constexpr (separator == Separator::kComma) {
    while (p != end && is_blank(*p)) ++p;
  } else {
    while (p != end && is_separator<separator>(*p)) ++p;
  }
  return p;
}

template <Separator separator>
const char* find_field_end(const char* p, const char* end) {
  return std::find_if(p, end, is_separator<separator>);
}

const char* skip_plus(const char* p, const char* end) {
  return end - p > 1 && *p == '+' && p[1] != '-' ? p + 1 : p;
}

std::optional<LineDamage> parse_number(const char*& p, const char* end, double& value) {
  const auto [after, error] = std::from_chars(skip_plus(p, end), end, value);
  if (error == std::errc::result_out_of_range) return LineDamage::kOutOfRange;
  if (error != std::errc{}) return LineDamage::kNotANumber;
  p = after;
  return std::nullopt;
}

std::optional<LineDamage> parse_value(const Column& column, const char*& p, const char* end,
                                      double& value) {
  if (const auto damage = parse_number(p, end, value)) return damage;
  value *= column.scale;
  if (value >= column.min && value <= column.max) return std::nullopt;
  if (std::isnan(value) && column.optional) return std::nullopt;
  return std::isfinite(value) ? LineDamage::kOutOfRange : LineDamage::kNotFinite;
}

// Nearly every field is no more than a number in range. Of any other nothing is taken.
template <Separator separator>
bool take_plain_number(const Column& column, const char*& p, const char* end,
                       std::span<double> values) {
  if (column.slot < 0) return false;
  double& value = values[static_cast<std::size_t>(column.slot)];
  const auto [after, error] = std::from_chars(p, end, value);
  value *= column.scale;
  if (error != std::errc{} || !(value >= column.min && value <= column.max)) return false;
  if (after == end) {
    p = end;
    return true;
  }
  if (!is_separator<separator>(*after)) return false;
  p = after + 1;
  return true;
}

// Times with an exponent, and whatever else is no plain decimal.
std::optional<LineDamage> parse_time_as_double(const char*& p, const char* end, Time& time) {
  double seconds = 0.0;
  if (const auto damage = parse_number(p, end, seconds)) return damage;
  if (!std::isfinite(seconds)) return LineDamage::kNotFinite;
  if (!(std::abs(seconds) < kMaxTimeS)) return LineDamage::kOutOfRange;
  time = time_from_seconds(seconds);
  return std::nullopt;
}

// Digits after the decimal point, rounded to nanoseconds.
const char* parse_fraction(const char* p, const char* end, std::int64_t& ns) {
  std::int64_t unit = kCountPerS;
  while (p != end && is_digit(*p) && unit > 1) {
    unit /= 10;
    ns += unit * (*p++ - '0');
  }
  if (p != end && is_digit(*p) && *p >= '5') ++ns;
  while (p != end && is_digit(*p)) ++p;
  return p;
}

}  // namespace

std::optional<LineDamage> parse_time(const char*& first, const char* last, Time& time) {
  const char* p = skip_plus(first, last);
  const bool negative = p != last && *p == '-';
  if (negative) ++p;
  const char* const digits = p;
  std::int64_t whole_s = 0;
  while (p != last && is_digit(*p) && p - digits < kMaxWholeDigits)
    whole_s = 10 * whole_s + (*p++ - '0');
  std::int64_t ns = 0;
  if (p != digits && p != last && *p == '.') p = parse_fraction(p + 1, last, ns);
  const bool plain = p != digits && (p == last || !(is_digit(*p) || *p == 'e' || *p == 'E'));
  if (!plain) return parse_time_as_double(first, last, time);
  if (whole_s >= static_cast<std::int64_t>(kMaxTimeS)) return LineDamage::kOutOfRange;
  ns += whole_s * kCountPerS;
  time = Time{Duration{negative ? -ns : ns}};
  first = p;
  return std::nullopt;
}

namespace {

/// A time in counts of less than a second, exact where a double would round.
std::optional<LineDamage> parse_counts(const char*& p, const char* end, double seconds_per_count,
                                       Time& time) {
  if (seconds_per_count == 1.0) return parse_time(p, end, time);
  const char* const first = skip_plus(p, end);
  std::int64_t whole = 0;
  const auto [after, error] = std::from_chars(first, end, whole);
  if (error == std::errc::result_out_of_range) return LineDamage::kOutOfRange;
  if (error != std::errc{}) return LineDamage::kNotANumber;
  const double ns_per_count = seconds_per_count * 1e9;
  if (std::abs(static_cast<double>(whole)) * seconds_per_count >= kMaxTimeS) {
    return LineDamage::kOutOfRange;
  }
  double fraction = 0.0;
  p = after;
  if (p != end && *p == '.' && p + 1 != end && is_digit(p[1])) {
    p = std::from_chars(p, end, fraction).ptr;
  }
  const double ns = std::round(*first == '-' ? -fraction * ns_per_count : fraction * ns_per_count);
  time = Time{Duration{whole * std::llround(ns_per_count) + std::llround(ns)}};
  return std::nullopt;
}

/// Any field, and the separator behind it.
template <Separator separator>
std::optional<Fault> parse_field(const Column& column, const char*& p, const char* end, Time& time,
                                 std::span<double> values) {
  const char* const field = p;
  const auto fault = [field, end](LineDamage reason) {
    const char* const field_end = find_field_end<separator>(field, end);
    return Fault{reason, {field, static_cast<std::size_t>(field_end - field)}};
  };
  if (column.slot == Column::kIgnored) {
    p = find_field_end<separator>(p, end);
  } else if (p == end || is_separator<separator>(*p)) {
    if (!column.optional) return fault(LineDamage::kMissingField);
    values[static_cast<std::size_t>(column.slot)] = std::numeric_limits<double>::quiet_NaN();
  } else {
    const auto damage =
        column.slot == Column::kTime
            ? parse_counts(p, end, column.scale, time)
            : parse_value(column, p, end, values[static_cast<std::size_t>(column.slot)]);
    if (damage) return fault(*damage);
  }
  if constexpr (separator == Separator::kComma) p = skip_to_field<separator>(p, end);
  if (p == end) return std::nullopt;
  if (!is_separator<separator>(*p)) return fault(LineDamage::kNotANumber);
  ++p;
  return std::nullopt;
}

}  // namespace

LineParser::LineParser(Separator separator, std::vector<Column> columns)
    : separator_(separator), columns_(std::move(columns)) {
  while (!columns_.empty() && columns_.back().slot == Column::kIgnored) columns_.pop_back();
}

std::optional<Fault> LineParser::parse(std::string_view line, Time& time,
                                       std::span<double> values) const {
  if (separator_ == Separator::kRuns) return parse_fields<Separator::kRuns>(line, time, values);
  if (separator_ != Separator::kComma) return parse_plain(line, time, values);
  auto fault = parse_fields<Separator::kComma>(line, time, values);
  const bool is_quoted = fault && line.find('"') != std::string_view::npos;
  return is_quoted ? parse_plain(line, time, values) : fault;
}

std::optional<Fault> LineParser::parse_plain(std::string_view line, Time& time,
                                             std::span<double> values) const {
  const std::string plain = plain_csv(line, separator_);
  auto fault = parse_fields<Separator::kComma>(plain, time, values);
  if (fault) {
    const auto at = static_cast<std::size_t>(fault->text.data() - plain.data());
    fault->text = line.substr(at, fault->text.size());
  }
  return fault;
}

template <Separator separator>
std::optional<Fault> LineParser::parse_fields(std::string_view line, Time& time,
                                              std::span<double> values) const {
  const char* p = line.data();
  const char* const end = p + line.size();
  for (const Column& column : columns_) {
    p = skip_to_field<separator>(p, end);
    if (take_plain_number<separator>(column, p, end, values)) continue;
    if (const auto fault = parse_field<separator>(column, p, end, time, values)) return fault;
  }
  return std::nullopt;
}

std::string plain_csv(std::string_view line, Separator separator) {
  const char between = separator == Separator::kSemicolon ? ';'
                       : separator == Separator::kTab     ? '\t'
                                                          : ',';
  std::string plain(line);
  bool is_quoted = false;
  for (char& c : plain) {
    if (c == '"') {
      is_quoted = !is_quoted;
      c = ' ';
    } else if (c == between && !is_quoted) {
      c = ',';
    } else if (c == ',') {
      c = '.';
    }
  }
  return plain;
}

std::vector<std::string_view> split_fields(std::string_view line, Separator separator) {
  const std::string_view separators = separator == Separator::kComma ? "," : " \t,;";
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t end = std::min(line.find_first_of(separators), line.size());
    std::string_view field = line.substr(0, end);
    while (!field.empty() && is_blank(field.front())) field.remove_prefix(1);
    while (!field.empty() && is_blank(field.back())) field.remove_suffix(1);
    if (!field.empty() || separator == Separator::kComma) fields.push_back(field);
    if (end == line.size()) return fields;
    line.remove_prefix(end + 1);
  }
}

bool is_number(std::string_view text) {
  double value = 0.0;
  const char* p = text.data();
  const char* const end = p + text.size();
  return !parse_number(p, end, value) && p == end;
}

}  // namespace leeway
