/// @file
/// Which terms of the motion a scheme takes into account. Private to the strapdown.
#pragma once

#include "leeway/strapdown/strapdown.hpp"

namespace leeway {

struct SchemeTerms {
  bool turning_force{false};  ///< the body turns under the force within an increment
  bool coning{false};         ///< of two increments
  bool sculling{false};       ///< of two increments, with the curvature of the position
};

/// The terms of a scheme, from its row in the table of the schemes.
SchemeTerms scheme_terms(Scheme scheme);

}  // namespace leeway
