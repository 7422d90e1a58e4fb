#include "sim/trials/journals/seed_set.hpp"

#include <doctest/doctest.h>

#include <set>
#include <vector>

#include "leeway/sim/tools/random.hpp"

namespace leeway::sim {
namespace {

std::vector<std::uint64_t> listed(const std::vector<SeedRange>& ranges) {
  std::vector<std::uint64_t> seeds;
  for (const SeedRange& r : ranges) {
    for (std::uint64_t i = 0; i < r.count; ++i) seeds.push_back(r.first + i);
  }
  return seeds;
}

}  // namespace

TEST_CASE("an empty set misses the whole range, a full one nothing of it") {
  SeedSet set;
  REQUIRE(set.missing({5, 3}).size() == 1);
  CHECK(listed(set.missing({5, 3})) == std::vector<std::uint64_t>{5, 6, 7});
  for (const std::uint64_t seed : {6u, 5u, 7u}) CHECK(set.insert(seed));
  CHECK(set.missing({5, 3}).empty());
  CHECK(!set.insert(6));
  CHECK(listed(set.missing({4, 5})) == std::vector<std::uint64_t>{4, 8});
  CHECK(listed(set.missing({6, 4})) == std::vector<std::uint64_t>{8, 9});
}

TEST_CASE("against std::set, over seeds 1 to 20") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    SeedSet set;
    std::set<std::uint64_t> reference;
    for (int i = 0; i < 150; ++i) {
      const auto number = static_cast<std::uint64_t>(100.0 * random.uniform());
      CHECK(set.insert(number) == reference.insert(number).second);
    }
    std::vector<std::uint64_t> missing;
    for (std::uint64_t i = 10; i < 110; ++i) {
      if (reference.count(i) == 0) missing.push_back(i);
    }
    const auto gaps = set.missing({10, 100});
    CHECK(listed(gaps) == missing);
    for (std::size_t i = 1; i < gaps.size(); ++i) {
      CHECK(gaps[i].first > gaps[i - 1].first + gaps[i - 1].count);
    }
  }
}

}  // namespace leeway::sim
