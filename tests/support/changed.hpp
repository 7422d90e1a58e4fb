/// @file
/// Configurations that differ in one field, for each field of their lists.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include "leeway/earth/names.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway::test {

/// Another value, as valid as this one. @returns that it has changed
struct ToAnother {
  bool operator()(bool& value) const { return value = !value, true; }
  bool operator()(std::string& text) const { return text += "!", true; }
  bool operator()(double& value) const {
    value = value == 0.0 ? 1e-7 : std::isinf(value) ? 1e3 : value * (1.0 - 1e-9);
    return true;
  }
  template <class T>
  bool operator()(T& value) const {
    if constexpr (NamedEnum<T>) {
      value = kAll<T>[(static_cast<std::size_t>(value) + 1) % kAll<T>.size()];
    } else if constexpr (std::is_integral_v<T>) {
      ++value;
    } else {
      value(0) += 1e-9;  // still a rotation, if it was one
    }
    return true;
  }
};

/// No number. @returns whether it was one
struct ToNan {
  template <class T>
  bool operator()(T& value) const {
    constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
    if constexpr (std::is_same_v<T, double>) return value = kNoNumber, true;
    if constexpr (requires { value.setConstant(kNoNumber); }) return value.setConstant(kNoNumber), true;
    return false;
  }
};

/// Calls f(path, config) for each field that can be changed, with it changed.
template <class Config, class Change, class F>
void for_each_changed(const Config& config, const Change& change, const F& f) {
  int fields = 1;
  for (int k = 0; k < fields; ++k) {
    Config other = config;
    std::string changed;
    fields = 0;
    walk_fields(other, [&](const FieldPath& path, auto& value, const Range&) {
      if constexpr (!std::is_const_v<std::remove_reference_t<decltype(value)>>) {
        if (fields++ == k && change(value)) changed = path.text();
      }
    });
    if (!changed.empty()) f(changed, other);
  }
}

}  // namespace leeway::test
