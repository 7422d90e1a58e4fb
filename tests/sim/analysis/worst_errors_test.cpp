#include "leeway/sim/analysis/worst_errors.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "leeway/sim/tools/random.hpp"

namespace leeway::sim {

TEST_CASE("the worst error is that of all, by any limit, for each of seeds 1 to 20") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    std::vector<ErrorBeforeFix> all;
    WorstErrors worst;
    for (int k = 0; k < 200; ++k) {
      // Whole tens of metres: the same way comes again.
      const ErrorBeforeFix error{10.0 * random.uniform(),
                                 10.0 * std::floor(20.0 * random.uniform())};
      all.push_back(error);
      worst.add(error);
      double most_m = 0.0;
      for (const ErrorBeforeFix& e : all) {
        if (e.distance_m <= 100.0) most_m = std::max(most_m, e.error_m);
      }
      CHECK(worst.largest_m(100.0) == most_m);
      if (k % 20 > 0) continue;
      for (const AllowedError& allowed :
           {AllowedError(5.0), AllowedError(0.1, 0.01), AllowedError(5.0, 0.05),
            AllowedError(100.0, 0.5), AllowedError(0.01, 1.0)}) {
        double most = 0.0;
        for (const ErrorBeforeFix& e : all) most = std::max(most, e.over(allowed));
        CHECK(worst.worst(allowed).over(allowed) == most);
      }
    }
  }
}

}  // namespace leeway::sim
