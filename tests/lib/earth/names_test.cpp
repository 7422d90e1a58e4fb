#include "leeway/earth/names.hpp"

#include <doctest/doctest.h>

namespace leeway {
namespace {

enum class Side { kLeft, kFarRight };
constexpr auto names(Side) { return std::array{"left", "far-right"}; }
constexpr std::optional<Side> alias(Side, std::string_view word) {
  return word == "right" ? std::optional(Side::kFarRight) : std::nullopt;
}

}  // namespace

TEST_CASE("an enumerator is found by its name, dashes and underscores alike, and by its old one") {
  CHECK(name(Side::kFarRight) == "far-right");
  CHECK(from_name<Side>("far-right") == Side::kFarRight);
  CHECK(from_name<Side>("far_right") == Side::kFarRight);
  CHECK(from_name<Side>("right") == Side::kFarRight);
  CHECK(from_name<Side>("left") == Side::kLeft);
  for (const char* other : {"", "far", "far-right-", "Left", "far right"}) {
    CAPTURE(other);
    CHECK(!from_name<Side>(other));
  }
  CHECK(kAll<Side> == std::array{Side::kLeft, Side::kFarRight});
}

TEST_CASE("an enumerator is told from a number, which is how a list that is too short shows") {
  CHECK(is_enumerator<Side::kFarRight>());
  CHECK(!is_enumerator<static_cast<Side>(2)>());
}

}  // namespace leeway
