#include "leeway/earth/fields.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "leeway/earth/error.hpp"
#include "lib/earth/field_walk.hpp"
#include "tests/support/numbers.hpp"

namespace leeway {
namespace {

using test::kInf;
using test::kNan;

struct Inner {
  double tau_s{1.0};
  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"tau_s", c.tau_s, kPositive});
  }
};

struct Outer {
  Inner inner{};
  std::optional<Inner> maybe{};
  std::vector<Inner> many{};
  Eigen::Vector3d v{Eigen::Vector3d::Zero()};
  bool forgotten{false};
  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"inner", c.inner}, Field{"maybe", c.maybe}, Field{"many", c.many},
                   Field{"v", c.v, between(-1.0, 1.0)});
  }
};

}  // namespace

TEST_CASE("a list that misses a member is told from its count") {
  static_assert(count_members<Inner>() == 1 && count_listed<Inner>() == 1);
  static_assert(count_members<Outer>() == 5 && count_listed<Outer>() == 4);
}

TEST_CASE("a range says what it contains") {
  struct Case {
    Range range;
    const char* text;
    std::vector<double> in;
    std::vector<double> out;
  };
  const Case cases[] = {
      {kFinite, "finite", {-1e300, 0.0}, {kInf, -kInf}},
      {kNotNegative, "finite and >= 0", {0.0, 1e300}, {-1e-300, kInf}},
      {kPositive, "finite and > 0", {1e-300}, {0.0, kInf}},
      {kPositiveOrInfinite, "> 0", {1e-300, kInf}, {0.0, -kInf}},
      {between(-2.0, 3.0), "-2 to 3", {-2.0, 3.0}, {-2.1, 3.1}},
      {positive_to(3.0), "> 0 and at most 3", {1e-300, 3.0}, {0.0, 3.1}},
      {zero_or(2.0, 3.0), "0 or 2 to 3", {0.0, 2.0, 3.0}, {1.0, -1.0, 3.1}},
  };
  for (const Case& c : cases) {
    CAPTURE(c.text);
    CHECK(c.range.text() == c.text);
    for (const double value : c.in) CHECK(c.range.contains(value));
    for (const double value : c.out) CHECK(!c.range.contains(value));
    CHECK(!c.range.contains(kNan));
  }
}

}  // namespace leeway
