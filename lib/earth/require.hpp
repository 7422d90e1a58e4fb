/// @file
/// The checks that configurations are made of. Private to the filters.
#pragma once

#include <cmath>
#include <string>

#include "leeway/earth/error.hpp"

namespace leeway {

/// The message is put together only when it is needed: nothing touches the heap before.
/// @throws Error "owner: field is value, must be range" unless it holds.
inline void require(bool holds, const char* owner, const char* field, double value,
                    const char* range) {
  if (holds) return;
  throw Error(std::string(owner) + ": " + field + " is " + std::to_string(value) + ", must be " +
              range);
}

inline void require_positive(const char* owner, const char* field, double value) {
  require(std::isfinite(value) && value > 0.0, owner, field, value, "finite and > 0");
}

inline void require_not_negative(const char* owner, const char* field, double value) {
  require(std::isfinite(value) && value >= 0.0, owner, field, value, "finite and >= 0");
}

}  // namespace leeway
