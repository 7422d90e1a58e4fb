#include "sim/cli/quantity.hpp"

#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "leeway/earth/units.hpp"

namespace leeway::cli {
namespace {

constexpr std::array kTimes{units::kS, units::kMs, units::kMin, units::kH};

/// @returns what is wrong with the text; else it is a number in SI afterwards.
std::string to_si(std::string& text, const char* what) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [after, error] = std::from_chars(text.data(), end, value);
  std::string_view symbol(after, static_cast<std::size_t>(end - after));
  while (symbol.starts_with(' ')) symbol.remove_prefix(1);
  std::vector<std::string_view> known;
  for (const Unit& unit : kTimes) known.push_back(unit.symbol);
  const auto wanted = [&] {
    return fmt::format("wanted {}; units: {}", what, fmt::join(known, ", "));
  };
  if (error != std::errc{}) return fmt::format("'{}' is no number: {}", text, wanted());
  const auto unit =
      std::ranges::find(kTimes, symbol.empty() ? known.front() : symbol, &Unit::symbol);
  if (unit == kTimes.end()) return fmt::format("'{}' is no unit of it: {}", symbol, wanted());
  if (!(value > 0.0) || std::isinf(value)) return fmt::format("{} is not above 0", text);
  text = fmt::format("{}", value * unit->si);
  return {};
}

}  // namespace

CLI::Validator seconds_quantity(const char* what) {
  return {[what](std::string& text) { return to_si(text, what); }, ""};
}

}  // namespace leeway::cli
