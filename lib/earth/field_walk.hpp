/// @file
/// What goes by the lists of fields: validation and bytes for fingerprints. A struct whose list
/// misses a member does not compile here.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "leeway/earth/fields.hpp"

namespace leeway {

struct ToAnything {
  template <class T>
  operator T() const;  // NOLINT(google-explicit-constructor)
};

/// How many members an aggregate has: as many as it can be initialized from. An optional one from
/// nothing, since it could be made of ToAnything in two ways.
template <class T, class... Given>
constexpr std::size_t count_members() {
  if constexpr (requires { T{std::declval<Given>()..., std::nullopt}; }) {
    return count_members<T, Given..., std::nullopt_t>();
  } else if constexpr (requires { T{std::declval<Given>()..., ToAnything{}}; }) {
    return count_members<T, Given..., ToAnything>();
  } else {
    return sizeof...(Given);
  }
}

template <class T>
constexpr std::size_t count_listed() {
  constexpr auto count = [](auto... fields) {
    return std::integral_constant<std::size_t, sizeof...(fields)>{};
  };
  return decltype(T::visit(std::declval<T&>(), count))::value;
}

/// Where a field is: "in_run.tau_s".
struct FieldPath {
  FieldPath(const char* its_name, const FieldPath* its_owner = nullptr)  // NOLINT(*-explicit-*)
      : name(its_name), owner(its_owner) {}

  const char* name;
  const FieldPath* owner;

  std::string_view root() const { return owner != nullptr ? owner->root() : name; }
  std::string text() const { return (owner != nullptr ? owner->text() + "." : "") + name; }
};

template <class T>
concept FieldLeaf = std::is_arithmetic_v<T> || std::is_enum_v<T> ||
    std::is_same_v<T, std::string> || std::is_base_of_v<Eigen::DenseBase<T>, T>;

template <class T, class Leaf>
void walk_fields(T& config, const Leaf& leaf, const FieldPath* owner = nullptr);

template <class Leaf>
void walk_field(NoData, const Leaf&, const FieldPath*) {}

/// Whether an optional is there, and how many a vector holds, come before what they hold.
template <class T, class Leaf>
void walk_field(const Field<T>& field, const Leaf& leaf, const FieldPath* owner) {
  const FieldPath path(field.name, owner);
  if constexpr (FieldLeaf<std::remove_const_t<T>>) {
    leaf(path, field.value, field.range);
  } else if constexpr (requires { field.value.has_value(); }) {
    const bool is_there = field.value.has_value();
    leaf(path, is_there, kFinite);
    if (is_there) walk_field(Field{field.name, *field.value, field.range}, leaf, owner);
  } else if constexpr (requires { field.value.begin(); }) {
    const std::size_t size = field.value.size();
    leaf(path, size, kFinite);
    for (auto& element : field.value) walk_field(Field{field.name, element}, leaf, owner);
  } else {
    walk_fields(field.value, leaf, &path);
  }
}

/// Calls leaf(path, value, range) for each number, choice, text and matrix, in order.
template <class T, class Leaf>
void walk_fields(T& config, const Leaf& leaf, const FieldPath* owner) {
  using Config = std::remove_const_t<T>;
  static_assert(count_listed<Config>() == count_members<Config>(), "visit() lists every member");
  Config::visit(config, [&](const auto&... fields) { (walk_field(fields, leaf, owner), ...); });
}

/// Makes no message, which would need the heap, unless one is needed.
/// @throws Error "owner: field is value, must be range" for a value out of its range.
void require(const char* owner, const FieldPath& path, double value, const Range& range);

/// @throws Error for the first number that is out of its range.
template <class T>
void validate_fields(const char* owner, const T& config) {
  walk_fields(config, [owner](const FieldPath& path, const auto& value, const Range& range) {
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
      require(owner, path, static_cast<double>(value), range);
    } else if constexpr (requires { value.allFinite(); }) {
      for (const double element : value.reshaped()) require(owner, path, element, range);
    }
  });
}

/// The bytes of a leaf.
template <FieldLeaf T>
std::span<const std::byte> bytes_of(const T& value) {
  if constexpr (requires { value.data(); }) {
    return std::as_bytes(std::span(value.data(), static_cast<std::size_t>(value.size())));
  } else {
    return std::as_bytes(std::span(&value, 1));
  }
}

}  // namespace leeway
