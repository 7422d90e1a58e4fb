/// @file
/// Quantities that more than one section of a scene file has, and the units they may come in. Where
/// a value is out of range in its own unit, the reader names the other in which it would not be.
#pragma once

#include "leeway/earth/error.hpp"
#include "sim/tools/toml_reader.hpp"

namespace leeway::sim {

inline constexpr std::array<const Unit*, 4> kTimes{&units::kS, &units::kMs, &units::kMin,
                                                   &units::kH};
inline constexpr std::array<const Unit*, 4> kLengths{&units::kM, &units::kCm, &units::kKm};
inline constexpr std::array<const Unit*, 4> kSpeeds{&units::kMps, &units::kKmPerH};
inline constexpr std::array<const Unit*, 4> kAngles{&units::kDeg, &units::kMrad};
inline constexpr std::array<const Unit*, 4> kAccelerations{&units::kMps2, &units::kStandardG};

/// Leaves the field as it is where the key is absent.
inline void set(TomlSection& section, const Quantity& quantity, double& field) {
  if (const auto value = section.number(quantity)) field = *value;
}

/// What a key of the section names, read by f, whose errors are those of the key.
template <class F>
decltype(auto) usable(const TomlSection& section, std::string_view key, F&& f) {
  try {
    return f();
  } catch (const Error& error) {
    section.fail_at(key, std::string("cannot be used: ") + error.what());
  }
}

}  // namespace leeway::sim
