#include "sim/tools/closest_name.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>
#include <vector>

namespace leeway::sim {

namespace {

bool same(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

/// Words for one thing, a line each.
constexpr std::array<std::string_view, 19> kSynonyms{
    " rate interval period step frequency ",
    " out output result write save file ",
    " odometer speedometer wheel wheels ",
    " barometer altimeter baro pressure ",
    " heading yaw azimuth course compass ",
    " height altitude elevation ",
    " lever arm antenna ",
    " duration length ",
    " campaign monte carlo montecarlo trials runs ",
    " fuse fusion filter run process navigate solve ",
    " info inspect look check show describe validate ",
    " simulate generate synthesize make ",
    " imu sensor datasheet catalogue catalog ",
    " replay outage coast dropout ",
    " reduce simplify ",
    " compare bench benchmark ",
    " report html page plot ",
    " threads jobs cores parallel ",
    " class grade "};

/// Calls f with every word of a name: "imu-rate-hz" has three.
template <class F>
void for_each_part(std::string_view name, const F& f) {
  while (!name.empty()) {
    const std::size_t end = std::min(name.find_first_of("-_. "), name.size());
    if (end > 0) f(name.substr(0, end));
    name.remove_prefix(std::min(end + 1, name.size()));
  }
}

bool mean_the_same(std::string_view a, std::string_view b) {
  if (a == b) return true;
  const auto has = [](std::string_view words, std::string_view word) {
    return words.find(" " + std::string(word) + " ") != std::string_view::npos;
  };
  return std::any_of(kSynonyms.begin(), kSynonyms.end(),
                     [&](std::string_view words) { return has(words, a) && has(words, b); });
}

/// How many words of one name mean what one of the other does. Units and articles are no words.
int shared_meaning(std::string_view a, std::string_view b) {
  constexpr std::size_t kShortest = 3;
  int shared = 0;
  for_each_part(a, [&](std::string_view word) {
    bool is_shared = false;
    for_each_part(b, [&](std::string_view other) {
      is_shared = is_shared || (word.size() >= kShortest && mean_the_same(word, other));
    });
    shared += is_shared ? 1 : 0;
  });
  return shared;
}

}  // namespace

std::string_view meant_by(std::string_view wrong, std::span<const std::string_view> accepted) {
  const auto is_nearer = [wrong](std::string_view a, std::string_view b) {
    const int shared_by_a = shared_meaning(wrong, a);
    const int shared_by_b = shared_meaning(wrong, b);
    if (shared_by_a != shared_by_b) return shared_by_a > shared_by_b;
    return edit_distance(a, wrong) < edit_distance(b, wrong);
  };
  const auto nearest = std::min_element(accepted.begin(), accepted.end(), is_nearer);
  if (nearest == accepted.end()) return {};
  const bool is_near =
      shared_meaning(wrong, *nearest) > 0 || edit_distance(*nearest, wrong) <= 1 + wrong.size() / 4;
  return is_near ? *nearest : std::string_view();
}

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
  if (accepted.empty()) return "nothing is accepted here";
  const std::string_view meant = meant_by(wrong, accepted);
  std::string text = meant.empty() ? "accepted:" : "did you mean '";
  if (!meant.empty()) text += std::string(meant) + "'? Accepted:";
  for (const std::string_view name : accepted) {
    text += (name == accepted.front() ? " " : ", ") + std::string(name);
  }
  return text;
}

}  // namespace leeway::sim
