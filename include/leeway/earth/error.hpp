/// @file
/// The exception of the library, thrown on misuse of the API. Bad data is never an exception.
#pragma once

#include <stdexcept>

namespace leeway {

/// Misuse: a negative noise, a non-unit quaternion, an unreadable file. The message names what is
/// wrong, where, and the allowed range or the remedy.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace leeway
