#include "sim/tools/closest_name.hpp"

#include <doctest/doctest.h>

#include <array>
#include <string_view>

namespace leeway::sim {

TEST_CASE("a name that was meant is one that means the same, or is spelt nearly so") {
  constexpr std::array<std::string_view, 6> kOptions{"out",       "out-rate-hz", "odometer",
                                                     "latency-s", "interval-s",  "gate"};
  struct Case {
    std::string_view wrong;
    std::string_view meant;
  };
  for (const Case& c :
       {Case{"output", "out"}, Case{"speedometer", "odometer"}, Case{"odomter", "odometer"},
        Case{"period_s", "interval-s"}, Case{"gaet", "gate"}, Case{"zebra", ""}}) {
    CAPTURE(c.wrong);
    CHECK(meant_by(c.wrong, kOptions) == c.meant);
  }
  // 2026-12-01: rate_hz was taken for latency_h, by its letters.
  constexpr std::array<std::string_view, 2> kKeys{"latency_h", "interval_s"};
  CHECK(meant_by("rate_hz", kKeys) == "interval_s");
  CHECK(did_you_mean("zebra", kKeys) == "accepted: latency_h, interval_s");
  CHECK(did_you_mean("any", {}) == "nothing is accepted here");
}

}  // namespace leeway::sim
