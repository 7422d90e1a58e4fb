#include "sim/tools/closest_name.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <vector>

namespace leeway::sim {

namespace {

bool same(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // No name is longer, and the work grows with the product of both lengths.
  constexpr std::size_t kLongest = 64;
  a = a.substr(0, kLongest);
  b = b.substr(0, kLongest);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (same(a[i], b[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string did_you_mean(std::string_view wrong, std::span<const std::string_view> accepted) {
  const auto closest = std::min_element(accepted.begin(), accepted.end(), [wrong](auto a, auto b) {
    return edit_distance(a, wrong) < edit_distance(b, wrong);
  });
  if (closest == accepted.end()) return "nothing is accepted here";
  std::string text = "did you mean '" + std::string(*closest) + "'? Accepted:";
  for (const std::string_view name : accepted) {
    text += (name == accepted.front() ? " " : ", ") + std::string(name);
  }
  return text;
}

}  // namespace leeway::sim
