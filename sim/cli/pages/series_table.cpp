#include "sim/cli/pages/series_table.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

namespace leeway::cli {
namespace {

static_assert(std::endian::native == std::endian::little, "what the page reads");

constexpr std::size_t kShort = 2048;

/// RFC 4648.
std::string base64(std::span<const std::byte> bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8U | (k < count ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[bits >> (18U - 6U * k) & 63U] : '=';
    }
  }
  return text;
}

Json column_json(const std::vector<double>& values, bool as_double) {
  if (as_double) return {{"f64", base64(std::as_bytes(std::span(values)))}};
  const std::vector<float> single(values.begin(), values.end());
  return {{"f32", base64(std::as_bytes(std::span(single)))}};
}

}  // namespace

void SeriesTable::add(std::span<const double> row) {
  const std::vector<double> values(row.begin(), row.end());
  if (in_last_ > 0) {
    take_in(rows_.back(), {values, values});
  } else {
    if (rows_.size() == kMostRows) {  // which is even, and the last is complete
      for (std::size_t i = 0; 2 * i < kMostRows; ++i) {
        if (i > 0) rows_[i] = std::move(rows_[2 * i]);
        take_in(rows_[i], rows_[2 * i + 1]);
      }
      rows_.resize(kMostRows / 2);
      together_ *= 2;
    }
    rows_.push_back({values, values});
  }
  in_last_ = (in_last_ + 1) % together_;
}

void SeriesTable::take_in(Row& row, const Row& next) const {
  if (keep_ == Keep::kFirst) return;
  for (std::size_t c = 1; c < names_.size(); ++c) {
    // Of a NaN and a number these are the number.
    row.least[c] = std::fmin(row.least[c], next.least[c]);
    row.greatest[c] = std::fmax(row.greatest[c], next.greatest[c]);
  }
}

Json SeriesTable::json() const {
  const bool is_short = together_ == 1 && rows_.size() <= kShort;
  const auto column = [this](std::vector<double> Row::*side, std::size_t c) {
    std::vector<double> values;
    for (const Row& row : rows_) values.push_back((row.*side)[c]);
    return values;
  };
  Json columns = Json::object();
  for (std::size_t c = 0; c < names_.size(); ++c) {
    columns[names_[c]] = column_json(column(&Row::least, c), is_short || c == 0);
    if (together_ == 1 || c == 0 || keep_ == Keep::kFirst) continue;
    columns[names_[c] + "_max"] = column_json(column(&Row::greatest, c), false);
  }
  return {{"taken_together", together_}, {"columns", std::move(columns)}};
}

}  // namespace leeway::cli
