#include "sim/cli/pages/series_table.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace leeway::cli {
namespace {

/// RFC 4648, the other way round.
std::string bytes_of(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : base64.substr(0, base64.find('='))) {
    bits = bits << 6U | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> static_cast<unsigned>(count) & 255U);
  }
  return bytes;
}

template <class Number>
std::vector<Number> numbers_in(const Json& column, const char* type) {
  const std::string bytes = bytes_of(column.at(type).get<std::string>());
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return numbers;
}

}  // namespace

TEST_CASE("report table: a short one is kept to the bit") {
  SeriesTable table({"t_s", "x_m"});
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> x_m{0.1, -1e-300, 6378137.123456789, none};
  for (std::size_t k = 0; k < x_m.size(); ++k) table.add({static_cast<double>(k) / 3.0, x_m[k]});
  const Json json = table.json();
  CHECK(json.at("taken_together") == 1);
  CHECK(json.at("columns").size() == 2);
  CHECK(numbers_in<double>(json.at("columns").at("t_s"), "f64").at(2) == 2.0 / 3.0);
  const auto read = numbers_in<double>(json.at("columns").at("x_m"), "f64");
  REQUIRE(read.size() == 4);
  CHECK(std::equal(x_m.begin(), x_m.begin() + 3, read.begin()));
  CHECK(std::isnan(read[3]));
}

TEST_CASE("report table: of a long one no peak is lost, and its size is bounded") {
  constexpr int kRows = 1'440'000;  // two hours at 200 Hz
  constexpr int kUp = 777'777;
  constexpr int kDown = 1'000'001;
  SeriesTable table({"t_s", "x_m"});
  for (int k = 0; k < kRows; ++k) {
    table.add({k / 200.0, k == kUp ? 9.0 : k == kDown ? -8.0 : std::sin(k * 0.01)});
  }
  const Json json = table.json();
  const auto together = json.at("taken_together").get<std::size_t>();
  const auto t_s = numbers_in<double>(json.at("columns").at("t_s"), "f64");
  const auto low = numbers_in<float>(json.at("columns").at("x_m"), "f32");
  const auto high = numbers_in<float>(json.at("columns").at("x_m_max"), "f32");
  CHECK(t_s.size() <= SeriesTable::kMostRows);
  CHECK(t_s.size() > SeriesTable::kMostRows / 2);
  REQUIRE(low.size() == t_s.size());
  REQUIRE(high.size() == t_s.size());
  CHECK(together * t_s.size() >= kRows);
  CHECK(t_s[1] == static_cast<double>(together) / 200.0);
  CHECK(high[kUp / together] == 9.0F);
  CHECK(low[kDown / together] == -8.0F);
  CHECK(std::count(high.begin(), high.end(), 9.0F) == 1);
  CHECK(std::count(low.begin(), low.end(), -8.0F) == 1);
}

TEST_CASE("report table: what is missing hides no number beside it") {
  const double none = std::numeric_limits<double>::quiet_NaN();
  SeriesTable table({"t_s", "x_m"});
  for (std::size_t k = 0; k <= SeriesTable::kMostRows; ++k) {
    table.add({static_cast<double>(k), k % 2 == 0 ? none : 5.0});
  }
  const Json columns = table.json().at("columns");
  const auto low = numbers_in<float>(columns.at("x_m"), "f32");
  CHECK(std::all_of(low.begin(), low.end() - 1, [](float x) { return x == 5.0F; }));
  CHECK(std::isnan(low.back()));
}

TEST_CASE("report table: first rows are rows") {
  SeriesTable table({"t_s", "x_m", "y_m"}, SeriesTable::Keep::kFirst);
  for (int k = 0; k < 40'000; ++k) table.add({1.0 * k, 2.0 * k, -3.0 * k});
  const Json columns = table.json().at("columns");
  CHECK(columns.size() == 3);
  const auto t_s = numbers_in<double>(columns.at("t_s"), "f64");
  const auto x_m = numbers_in<float>(columns.at("x_m"), "f32");
  const auto y_m = numbers_in<float>(columns.at("y_m"), "f32");
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    REQUIRE(x_m[i] == static_cast<float>(2.0 * t_s[i]));
    REQUIRE(y_m[i] == static_cast<float>(-3.0 * t_s[i]));
  }
}

}  // namespace leeway::cli
