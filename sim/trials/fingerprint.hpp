/// @file
/// A number by which two runs know that they are of the same scene.
#pragma once

#include <cstdint>
#include <string_view>

#include "leeway/sim/trials/trial.hpp"

namespace leeway::sim {

/// 64-bit FNV-1a. No defence against intent.
std::uint64_t hash_of(std::string_view bytes);

/// Of everything that decides what a trial with a given seed gives, this version of Leeway
/// included: true increments, sensors, receiver, fixes, filter, start. Not of names, limit, number
/// of trials or first seed. The motion enters by the values it takes, so a mathematical library
/// that rounds otherwise makes another scene.
std::uint64_t fingerprint(const TrialPlan& plan);

}  // namespace leeway::sim
