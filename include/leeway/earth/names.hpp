/// @file
/// The names of enumerators: one table for each enum, in the header that declares it. Options,
/// files, messages and JSON all use it.
///
///     enum class Side { kLeft, kRight };
///     constexpr auto names(Side) {
///       return std::array{Named{Side::kLeft, "left"}, Named{Side::kRight, "right"}};
///     }
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

namespace leeway {

/// An enumerator with its name, and another that is accepted for it.
template <class Enum>
struct Named {
  Enum value{};
  std::string_view name{};
  std::string_view alias{};
};
template <class Enum>
Named(Enum, const char*) -> Named<Enum>;
template <class Enum>
Named(Enum, const char*, const char*) -> Named<Enum>;

/// An enum that has a table.
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

/// Whether a table has each enumerator, in order, under a name of its own.
template <class Enum, std::size_t N>
constexpr bool is_whole(const std::array<Named<Enum>, N>& table) {
  for (std::size_t i = 0; i < N; ++i) {
    if (table[i].value != static_cast<Enum>(i)) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (table[i].name == table[j].name) return false;
    }
  }
  return !is_enumerator<static_cast<Enum>(N)>();
}

/// The table of an enum. One that is not whole does not compile.
template <NamedEnum Enum>
inline constexpr auto kNames = [] {
  constexpr auto table = names(Enum{});
  static_assert(is_whole(table), "each enumerator has a row, in order, with its own name");
  return table;
}();

/// Every enumerator.
template <NamedEnum Enum>
inline constexpr auto kAll = [] {
  std::array<Enum, kNames<Enum>.size()> all{};
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = kNames<Enum>[i].value;
  return all;
}();

/// Every name.
template <NamedEnum Enum>
inline constexpr auto kWords = [] {
  std::array<std::string_view, kNames<Enum>.size()> words{};
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = kNames<Enum>[i].name;
  return words;
}();

/// @pre the value is an enumerator.
template <NamedEnum Enum>
constexpr std::string_view name(Enum value) {
  return kWords<Enum>[static_cast<std::size_t>(value)];
}

/// Whether two words are the same name: dashes and underscores are alike.
constexpr bool is_same_name(std::string_view a, std::string_view b) {
  const auto dashed = [](char c) { return c == '_' ? '-' : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return dashed(x) == dashed(y); });
}

/// The enumerator of this name or alias, if there is one.
template <NamedEnum Enum>
constexpr std::optional<Enum> from_name(std::string_view word) {
  for (const Named<Enum>& row : kNames<Enum>) {
    if (is_same_name(word, row.name)) return row.value;
    if (!row.alias.empty() && is_same_name(word, row.alias)) return row.value;
  }
  return {};
}

}  // namespace leeway
