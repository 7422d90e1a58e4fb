/// @file
/// The names of enumerators: one list for each enum, in its order, right below it. Options, files,
/// messages and JSON all use it.
///
///     enum class Side { kLeft, kRight };
///     constexpr auto names(Side) { return std::array{"left", "right"}; }
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

namespace leeway {

/// An enum that has a list.
template <class Enum>
concept NamedEnum = std::is_enum_v<Enum> && requires {
  names(Enum{});
};

/// Whether the value is an enumerator: a compiler spells any other as a number.
template <auto value>
constexpr bool is_enumerator() {
  const std::string_view spelled = __PRETTY_FUNCTION__;
  const char first = spelled[spelled.find("value = ") + 8];
  return first != '(' && (first < '0' || first > '9');
}

/// Every name. A list that is longer or shorter than its enum does not compile.
template <NamedEnum Enum>
inline constexpr auto kNames = [] {
  constexpr std::size_t count = names(Enum{}).size();
  static_assert(is_enumerator<static_cast<Enum>(count - 1)>(), "more names than enumerators");
  static_assert(!is_enumerator<static_cast<Enum>(count)>(), "an enumerator has no name");
  std::array<std::string_view, count> all{};
  std::ranges::copy(names(Enum{}), all.begin());
  return all;
}();

/// Every enumerator.
template <NamedEnum Enum>
inline constexpr auto kAll = [] {
  std::array<Enum, kNames<Enum>.size()> all{};
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<Enum>(i);
  return all;
}();

/// @pre the value is an enumerator.
template <NamedEnum Enum>
constexpr std::string_view name(Enum value) {
  return kNames<Enum>[static_cast<std::size_t>(value)];
}

/// Whether two words are the same name: dashes and underscores are alike.
constexpr bool is_same_name(std::string_view a, std::string_view b) {
  const auto dashed = [](char c) { return c == '_' ? '-' : c; };
  return std::ranges::equal(a, b, {}, dashed, dashed);
}

/// The enumerator of this name, or of an old one that alias() of the enum knows.
template <NamedEnum Enum>
constexpr std::optional<Enum> from_name(std::string_view word) {
  for (const Enum value : kAll<Enum>) {
    if (is_same_name(word, name(value))) return value;
  }
  if constexpr (requires { alias(Enum{}, word); }) return alias(Enum{}, word);
  return {};
}

}  // namespace leeway
