#include "sim/trials/journals/journal_line.hpp"

#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "sim/trials/fingerprint.hpp"

namespace leeway::sim {
namespace {

template <class T>
void put(std::string& line, T value) {
  std::array<char, 32> text;
  std::to_chars_result end{};
  if constexpr (std::is_floating_point_v<T>) {
    end = std::to_chars(text.begin(), text.end(), value, std::chars_format::hex);
  } else {
    end = std::to_chars(text.begin(), text.end(), value);
  }
  line.append(text.begin(), end.ptr);
  line += ' ';
}

/// Takes the next number and the space behind it off the line.
template <class T>
bool take(std::string_view& line, T& value) {
  std::from_chars_result end{};
  if constexpr (std::is_floating_point_v<T>) {
    end = std::from_chars(line.begin(), line.end(), value, std::chars_format::hex);
  } else {
    end = std::from_chars(line.begin(), line.end(), value);
  }
  if (end.ec != std::errc{} || end.ptr == line.end() || *end.ptr != ' ') return false;
  line.remove_prefix(static_cast<std::size_t>(end.ptr - line.begin()) + 1);
  return true;
}

/// The one list of what a line holds, for both directions.
template <class Score, class F>
void for_each_field(Score& score, F&& f) {
  f(score.seed);
  f(score.epochs);
  for (Eigen::Index i = 0; i < 3; ++i) f(score.error_sq_n_m2[i]);
  for (Eigen::Index i = 0; i < 3; ++i) f(score.variance_n_m2[i]);
  f(score.nees);
  f(score.nis);
  f(score.nis_dof);
  f(score.beyond_r95);
  f(score.largest_horizontal_m);
  f(score.fused);
  f(score.gated);
}

}  // namespace

std::string line_of(const TrialScore& score) {
  std::string line;
  for_each_field(score, [&line](const auto& value) { put(line, value); });
  put(line, score.diverged ? 1 : 0);
  put(line, score.finite ? 1 : 0);
  put(line, hash_of(line));
  line.pop_back();
  return line;
}

bool parse_line(std::string line, TrialScore& score) {
  line += ' ';
  const std::string_view whole = line;
  std::string_view rest = whole;
  bool good = true;
  for_each_field(score, [&](auto& value) { good = good && take(rest, value); });
  int diverged = 0;
  int finite = 0;
  good = good && take(rest, diverged) && take(rest, finite);
  score.diverged = diverged != 0;
  score.finite = finite != 0;
  const std::size_t checked = whole.size() - rest.size();
  std::uint64_t checksum = 0;
  good = good && take(rest, checksum) && rest.empty();
  return good && checksum == hash_of(whole.substr(0, checked));
}

}  // namespace leeway::sim
