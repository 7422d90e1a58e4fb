#include "leeway/earth/units.hpp"

#include <array>
#include <cstdio>

namespace leeway {
namespace {

std::string number(double value, int digits) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

/// A ratio has no symbol.
std::string with_symbol(const std::string& value, std::string_view symbol) {
  return symbol == units::kRatio.symbol ? value : value + " " + std::string(symbol);
}

}  // namespace

std::string working(double value, const Unit& unit) {
  constexpr int kGiven = 6;
  constexpr int kFactor = 10;
  constexpr int kResult = 4;
  std::string text = with_symbol(number(value, kGiven), unit.symbol);
  if (unit.symbol != unit.si_symbol) {
    std::string step = number(value, kGiven);
    if (unit.times != 1.0) step += " x " + number(unit.times, kFactor);
    if (unit.over != 1.0) step += " / " + number(unit.over, kFactor);
    text += " = " + with_symbol(step, unit.base);
    text += " = " + with_symbol(number(value * unit.si, kResult), unit.si_symbol);
  }
  return text;
}

}  // namespace leeway
