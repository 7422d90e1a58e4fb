/// @file
/// The correction interval over the spread of an IMU's own data.
#pragma once

#include <optional>

#include "leeway/sim/analysis/interval.hpp"

namespace leeway::sim {

/// The answers for the ends of a range: where all of the IMU's specifications are at their least,
/// typical or greatest.
struct IntervalSpread {
  Interval low{};  ///< of the specifications: the longest interval
  Interval mid{};
  Interval high{};
};

/// The spread of the answer for one limit. A class of Table 1 has a range, and the scene's name of
/// its IMU tells: "tactical/mid". A part of the catalogue has none, being one number each, nor has
/// a model of the user's.
/// @throws Error as solve_intervals() does.
std::optional<IntervalSpread> interval_spread(const Scene& scene, const AllowedError& limit,
                                              const IntervalConfig& config = {});

}  // namespace leeway::sim
