#include "leeway/earth/fields.hpp"

#include <sstream>

#include "leeway/earth/error.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway {

std::string Range::text() const {
  std::ostringstream text;
  const bool has_low = low > kFinite.low;
  if (or_zero) text << "0 or ";
  if (high < kFinite.high && !above_low) {
    text << low << " to " << high;
  } else {
    if (high == kFinite.high) text << (has_low ? "finite and " : "finite");
    if (has_low) text << (above_low ? "> " : ">= ") << low;
    if (high < kFinite.high) text << " and at most " << high;
  }
  return text.str();
}

void require(const char* owner, const FieldPath& path, double value, const Range& range) {
  if (range.contains(value)) return;
  std::ostringstream message;
  message << owner << ": " << path.text() << " is " << value << ", must be " << range.text();
  throw Error(message.str());
}

}  // namespace leeway
