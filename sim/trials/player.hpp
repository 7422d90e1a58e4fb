/// @file
/// The walk over the IMU increments of a trial and the fixes that come with them.
#pragma once

#include <cstddef>

namespace leeway::sim {

/// Walk over a trial in the order of time. It calls advance(k) at the last of every `step`
/// increments, then arrives(fix) of the fixes that are on their way, then valid(fix) of the next
/// one, which may arrive at once.
/// @param fixes    ascending; each has `at` and `arrives`, the increments at whose ends it is valid
///                 and known to the filter, both ends of steps
template <class Fixes, class Advance, class Valid, class Arrives>
void play(std::size_t increments, std::size_t step, const Fixes& fixes, Advance&& advance,
          Valid&& valid, Arrives&& arrives) {
  auto next = fixes.begin();
  auto on_its_way = fixes.begin();
  for (std::size_t k = step - 1; k < increments; k += step) {
    advance(k);
    const auto deliver = [&] {
      for (; on_its_way != next && on_its_way->arrives == k; ++on_its_way) arrives(*on_its_way);
    };
    deliver();
    if (next == fixes.end() || next->at != k) continue;
    valid(*next++);
    deliver();
  }
}

}  // namespace leeway::sim
