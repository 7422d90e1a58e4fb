#include "leeway/earth/names.hpp"

#include <doctest/doctest.h>

namespace leeway {
namespace {

enum class Side { kLeft, kFarRight };
constexpr auto names(Side) {
  return std::array{Named{Side::kLeft, "left"}, Named{Side::kFarRight, "far-right", "right"}};
}

enum class Forgetful { kKnown, kForgotten };
constexpr std::array kForgetful{Named{Forgetful::kKnown, "known"}};
constexpr std::array kAlike{Named{Side::kLeft, "side"}, Named{Side::kFarRight, "side"}};
constexpr std::array kTwisted{Named{Side::kFarRight, "far-right"}, Named{Side::kLeft, "left"}};

}  // namespace

TEST_CASE("an enumerator is found by its name, dashes and underscores alike, and by its alias") {
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

TEST_CASE("a table with a gap, in another order or with a name twice is told from a whole one") {
  static_assert(is_whole(names(Side{})));
  static_assert(!is_whole(kForgetful));
  static_assert(!is_whole(kTwisted));
  static_assert(!is_whole(kAlike));
  CHECK(is_enumerator<Forgetful::kForgotten>());
  CHECK(!is_enumerator<static_cast<Forgetful>(2)>());
}

}  // namespace leeway
