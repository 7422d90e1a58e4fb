#include "leeway/units.hpp"

#include <array>
#include <cstdio>

namespace leeway {
namespace {

std::string text_of(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

}  // namespace

std::string working(double value, const Unit& unit) {
  const std::string given = text_of(value);
  std::string text = given + " " + std::string(unit.symbol);
  if (unit.base != unit.symbol) {
    text += " = " + given;
    if (unit.times != 1.0) text += " x " + text_of(unit.times);
    if (unit.over != 1.0) text += " / " + text_of(unit.over);
    text += " " + std::string(unit.base);
  }
  if (unit.base != unit.si_symbol) {
    text += " = " + text_of(value * unit.si) + " " + std::string(unit.si_symbol);
  }
  return text;
}

}  // namespace leeway
