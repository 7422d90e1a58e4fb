#include "sim/cli/quantity.hpp"

#include <spdlog/fmt/ranges.h>

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

namespace leeway::cli {
namespace {

constexpr std::array kTimes{units::kS, units::kMs, units::kMin, units::kH};

/// @returns what is wrong with the text; else it is a number in SI afterwards.
std::string to_si(std::string& text, std::span<const Unit> units, const char* what) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [after, error] = std::from_chars(text.data(), end, value);
  std::string_view symbol(after, static_cast<std::size_t>(end - after));
  while (symbol.starts_with(' ')) symbol.remove_prefix(1);
  std::vector<std::string_view> known;
  for (const Unit& unit : units) known.push_back(unit.symbol);
  const auto wanted = [&] {
    return fmt::format("wanted {}; units: {}", what, fmt::join(known, ", "));
  };
  if (error != std::errc{}) return fmt::format("'{}' is no number: {}", text, wanted());
  const auto unit =
      std::ranges::find(units, symbol.empty() ? known.front() : symbol, &Unit::symbol);
  if (unit == units.end()) return fmt::format("'{}' is no unit of it: {}", symbol, wanted());
  if (!(value > 0.0) || std::isinf(value)) return fmt::format("{} is not above 0", text);
  text = fmt::format("{}", value * unit->si);
  return {};
}

}  // namespace

CLI::Validator quantity(std::span<const Unit> units, const char* what) {
  return {[units, what](std::string& text) { return to_si(text, units, what); }, ""};
}

CLI::Validator seconds_quantity(const char* what) { return quantity(kTimes, what); }

}  // namespace leeway::cli
