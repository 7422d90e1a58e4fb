#include "leeway/alternatives/nis_monitor.hpp"

#include <doctest/doctest.h>

#include <limits>

namespace leeway {

// 300 degrees of freedom: chi-square is beyond 300 +- 3.7 sqrt(600) with 1e-4 on either side.
TEST_CASE("NIS monitor: within, above and below what chi-square allows") {
  struct Case {
    double ratio;
    bool high;
    bool low;
  };
  const Case cases[] = {{1.0, false, false},
                        {1.25, false, false},
                        {1.4, true, false},
                        {0.8, false, false},
                        {0.6, false, true}};
  for (const Case& c : cases) {
    CAPTURE(c.ratio);
    NisMonitor monitor;
    for (int k = 0; k < 100; ++k) monitor.note(3.0 * c.ratio, 3);
    CHECK(monitor.is_high() == c.high);
    CHECK(monitor.is_low() == c.low);
  }
}

TEST_CASE("NIS monitor: nothing is said before the first fix, and no number is high for good") {
  NisMonitor monitor;
  CHECK(!monitor.is_high());
  CHECK(!monitor.is_low());
  CHECK(monitor.ratio() == 1.0);
  monitor.note(std::numeric_limits<double>::quiet_NaN(), 3);
  monitor.note(3.0, 3);
  CHECK(monitor.is_high());
}

}  // namespace leeway
