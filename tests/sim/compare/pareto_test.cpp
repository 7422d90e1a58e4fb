#include "leeway/sim/compare/pareto.hpp"

#include <doctest/doctest.h>

#include <limits>

namespace leeway::sim {
namespace {

/// A cost known to 5 %.
ParetoPoint point(double cost, double error) { return {cost, 0.95 * cost, 1.05 * cost, error}; }

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("whoever is worse in both is dominated, by the cheapest of those that do") {
  const auto by =
      dominators({point(10.0, 2.0), point(20.0, 1.0), point(30.0, 3.0), point(40.0, 1.0)});
  CHECK(!by[0]);
  CHECK(!by[1]);
  CHECK(by[2] == 0U);  // by the second, too, which costs more
  CHECK(by[3] == 1U);
}

TEST_CASE("costs whose spreads overlap are alike") {
  CHECK(!dominates(point(10.0, 1.0), point(10.5, 1.0)));
  CHECK(dominates(point(10.0, 1.0), point(12.0, 1.0)));
  // The error decides between costs that are alike, unless it is the dearer one's by the median.
  CHECK(dominates(point(10.0, 1.0), point(10.5, 1.1)));
  CHECK(!dominates(point(10.5, 1.0), point(10.0, 1.1)));
}

TEST_CASE("errors within a thousandth are alike") {
  CHECK(dominates(point(10.0, 1.0005), point(20.0, 1.0)));
  CHECK(!dominates(point(10.0, 1.002), point(20.0, 1.0)));
  CHECK(!dominates(point(10.0, 0.9995), point(10.0, 1.0)));
  CHECK(dominates(point(10.0, 0.998), point(10.0, 1.0)));
}

TEST_CASE("nobody dominates itself, and what is not finite takes no part") {
  CHECK(!dominates(point(1.0, 1.0), point(1.0, 1.0)));
  const auto by = dominators({point(1.0, kNan), point(2.0, 1.0), point(3.0, 2.0),
                              point(4.0, std::numeric_limits<double>::infinity())});
  CHECK(!by[0]);
  CHECK(!by[1]);
  CHECK(by[2] == 1U);
  CHECK(!by[3]);
}

TEST_CASE("a chain of errors that are alike leaves somebody on the front") {
  // Each is within a thousandth of the next, and cheaper.
  const auto by = dominators({point(10.0, 1.0016), point(20.0, 1.0008), point(30.0, 1.0)});
  CHECK(!by[0]);
  CHECK(by[1] == 0U);
  CHECK(by[2] == 1U);
}

}  // namespace leeway::sim
