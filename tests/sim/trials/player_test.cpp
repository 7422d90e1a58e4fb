#include "sim/trials/player.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace leeway::sim {
namespace {

struct Fix {
  std::size_t at{};
  std::size_t arrives{};
};

/// What is called, in order: the increment, "v" and "a" with the number of the fix.
std::string played(std::size_t increments, std::size_t step, const std::vector<Fix>& fixes) {
  std::string calls;
  int valid = 0;
  int arrived = 0;
  play(
      increments, step, fixes, [&](std::size_t k) { calls += " " + std::to_string(k); },
      [&](const Fix&) { calls += " v" + std::to_string(valid++); },
      [&](const Fix&) { calls += " a" + std::to_string(arrived++); });
  return calls;
}

}  // namespace

TEST_CASE("fixes are valid and arrive at the ends of increments, whole steps at a time") {
  CHECK(played(3, 1, {}) == " 0 1 2");
  CHECK(played(4, 1, {{0, 0}, {2, 3}}) == " 0 v0 a0 1 2 v1 3 a1");
  CHECK(played(7, 2, {{1, 3}}) == " 1 v0 3 a0 5");
}

TEST_CASE("what is on its way arrives before the next fix is valid, and some never arrive") {
  CHECK(played(5, 1, {{1, 3}, {3, 3}}) == " 0 1 v0 2 3 a0 v1 a1 4");
  CHECK(played(5, 1, {{0, 3}, {1, 4}, {2, 5}}) == " 0 v0 1 v1 2 v2 3 a0 4 a1");
}

}  // namespace leeway::sim
