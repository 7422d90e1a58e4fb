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

SeriesTable::SeriesTable(std::vector<std::string> columns, Keep keep)
    : names_(std::move(columns)), keep_(keep), least_(names_.size()), greatest_(names_.size()) {}

void SeriesTable::add(std::span<const double> row) {
  if (in_last_ > 0) {
    take_together(least_.front().size() - 1, row, row);
  } else {
    if (least_.front().size() == kMostRows) halve();
    for (std::size_t c = 0; c < names_.size(); ++c) {
      least_[c].push_back(row[c]);
      greatest_[c].push_back(row[c]);
    }
  }
  in_last_ = (in_last_ + 1) % together_;
}

void SeriesTable::take_together(std::size_t into, std::span<const double> least,
                                std::span<const double> greatest) {
  if (keep_ == Keep::kFirst) return;
  for (std::size_t c = 1; c < names_.size(); ++c) {
    // Of a NaN and a number these are the number.
    least_[c][into] = std::fmin(least_[c][into], least[c]);
    greatest_[c][into] = std::fmax(greatest_[c][into], greatest[c]);
  }
}

/// @pre the last group is complete, and there are as many as kMostRows, which is even.
void SeriesTable::halve() {
  const std::size_t half = kMostRows / 2;
  std::vector<double> least(names_.size());
  std::vector<double> greatest(names_.size());
  for (std::size_t i = 0; i < half; ++i) {
    for (std::size_t c = 0; c < names_.size(); ++c) {
      least_[c][i] = least_[c][2 * i];
      greatest_[c][i] = greatest_[c][2 * i];
      least[c] = least_[c][2 * i + 1];
      greatest[c] = greatest_[c][2 * i + 1];
    }
    take_together(i, least, greatest);
  }
  for (std::size_t c = 0; c < names_.size(); ++c) {
    least_[c].resize(half);
    greatest_[c].resize(half);
  }
  together_ *= 2;
}

Json SeriesTable::json() const {
  const bool is_short = together_ == 1 && least_.front().size() <= kShort;
  Json columns = Json::object();
  for (std::size_t c = 0; c < names_.size(); ++c) {
    columns[names_[c]] = column_json(least_[c], is_short || c == 0);
    if (together_ == 1 || c == 0 || keep_ == Keep::kFirst) continue;
    columns[names_[c] + "_max"] = column_json(greatest_[c], false);
  }
  return {{"taken_together", together_}, {"columns", std::move(columns)}};
}

}  // namespace leeway::cli
