#include "sim/replay/block_bootstrap.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "leeway/sim/tools/quantile.hpp"
#include "leeway/sim/tools/random.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

std::vector<BlockValue> sorted(std::vector<BlockValue> values) {
  std::sort(values.begin(), values.end(),
            [](const auto& a, const auto& b) { return a.value < b.value; });
  return values;
}

}  // namespace

TEST_CASE("a quantile of weighted values is that of the values written out") {
  Random random(1);
  std::vector<BlockValue> values;
  for (std::uint32_t k = 0; k < 40; ++k) values.push_back({random.normal(), k % 4});
  values = sorted(values);
  const BlockCounts counts{2, 0, 1, 3};
  std::vector<double> all;
  std::vector<double> written_out;
  double sum_sq = 0.0;
  for (const BlockValue& v : values) {
    all.push_back(v.value);
    written_out.insert(written_out.end(), counts[v.block], v.value);
    sum_sq += counts[v.block] * v.value * v.value;
  }
  for (const double probability : {0.05, 0.5, 0.68, 0.95, 0.999}) {
    CHECK(quantile_of(values, {}, probability) == quantile_of(all, probability));
    CHECK(quantile_of(values, counts, probability) == quantile_of(written_out, probability));
  }
  CHECK(test::near(rms_of(values, counts),
                   std::sqrt(sum_sq / static_cast<double>(written_out.size())), 1e-12));
}

TEST_CASE("blocks go on from one log to the next, the last one takes the rest") {
  Blocks blocks(10.0);
  blocks.begin(100.0, 134.0);
  CHECK(blocks.count() == 3);
  CHECK(blocks.block_at(100.0) == 0);
  CHECK(blocks.block_at(119.9) == 1);
  CHECK(blocks.block_at(134.0) == 2);
  blocks.begin(0.0, 4.0);
  CHECK(blocks.count() == 4);
  CHECK(blocks.block_at(4.0) == 3);
}

TEST_CASE("the band of a mean of blocks is that of the textbook") {
  // Values alike in a block count once: the band of their mean is +-1.645 sigma / sqrt(blocks),
  // four standard deviations of a bootstrap of 200 away at most (its 5 % quantile scatters by
  // 0.15 sigma / sqrt(blocks)), and by the scatter of the sample's own sigma, 1 / sqrt(2 blocks).
  constexpr std::uint32_t kBlocks = 400;
  Random random(1);
  std::vector<BlockValue> values;
  for (std::uint32_t block = 0; block < kBlocks; ++block) {
    const double value = random.normal();
    for (int k = 0; k < 5; ++k) values.push_back({value, block});
  }
  const auto mean = [&](const BlockCounts& counts) {
    double sum = 0.0;
    double weight = 0.0;
    for (const BlockValue& v : values) {
      const double w = counts.empty() ? 1.0 : counts[v.block];
      sum += w * v.value;
      weight += w;
    }
    return sum / weight;
  };
  const Banded b = banded(kBlocks, mean);
  const double sigma = 1.0 / std::sqrt(static_cast<double>(kBlocks));
  CHECK(test::near((b.high - b.value) / sigma, 1.645, 0.8));
  CHECK(test::near((b.value - b.low) / sigma, 1.645, 0.8));
}

TEST_CASE("too few blocks have no band") {
  const Banded b = banded(kFewestBlocks - 1, [](const BlockCounts&) { return 1.0; });
  CHECK(b.value == 1.0);
  CHECK(std::isnan(b.low));
  CHECK(std::isnan(b.high));
}

}  // namespace leeway::sim
