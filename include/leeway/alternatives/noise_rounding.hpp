/// @file
/// Process noise that is lost to the rounding of a kernel's numbers.
#pragma once

#include <algorithm>
#include <cmath>

#include "leeway/model/error_state.hpp"

namespace leeway {

/// Share of itself by which the process noise of one propagation is changed when numbers of a kind
/// take it in, of the state where that is most. 1: it is lost. The state grows too sure where this
/// stays above a half for as long as the noise takes to matter.
/// @param variance  diagonal of P
/// @param noise     what one propagation adds to it, noise_variance()
template <class Number>
double noise_rounding(const ErrorVector& variance, const ErrorVector& noise) {
  double largest = 0.0;
  for (int i = 0; i < kErrorStates; ++i) {
    const auto before = static_cast<Number>(variance(i));
    const auto added = static_cast<Number>(noise(i));
    if (!(added > 0)) continue;
    const Number kept = (before + added) - before;
    largest = std::max(largest, static_cast<double>(std::abs(kept / added - 1)));
  }
  return largest;
}

}  // namespace leeway
