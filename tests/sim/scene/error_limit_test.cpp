#include "leeway/sim/scene/error_limit.hpp"

#include <doctest/doctest.h>

#include <set>
#include <string>

#include "leeway/earth/error.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {

using test::near;

TEST_CASE("a limit is read from text, and written as it may be read again") {
  const struct {
    const char* text;
    AllowedError allowed;
    const char* written;
  } cases[] = {{"5", 5.0, "5m"},
               {"5m", 5.0, "5m"},
               {" 5 m ", 5.0, "5m"},
               {"0.25m", 0.25, "0.25m"},
               {"1e3", 1000.0, "1000m"},
               {"5m+5%", {5.0, 0.05}, "5m+5%"},
               {"5 m + 5 %", {5.0, 0.05}, "5m+5%"},
               {"2.5m+0.1%", {2.5, 0.001}, "2.5m+0.1%"},
               {"5m+0%", 5.0, "5m"}};
  for (const auto& [text, allowed, written] : cases) {
    CAPTURE(text);
    CHECK(allowed_error(text).limit_m == allowed.limit_m);
    CHECK(near(allowed_error(text).share, allowed.share, 1e-15));
    CHECK(text_of(allowed_error(text)) == written);
    CHECK(text_of(allowed_error(written)) == written);
  }
  CHECK(near(AllowedError(5.0, 0.05).after_m(400.0), 25.0, 1e-12));
}

TEST_CASE("what is no limit is refused with its text, the form and the remedy") {
  for (const char* text : {"", "m", "five", "5 ft", "5km", "5m5", "5%", "5m+", "5m+5", "5m+5m",
                           "5m+%", "5m-5%", "5+5%", "5m+5%+1", "5m + 5 % s", "5,0m", "--5"}) {
    CAPTURE(text);
    CHECK_THROWS_WITH_AS(allowed_error(text), doctest::Contains("as in 5m+5%"), Error);
    CHECK_THROWS_WITH_AS(allowed_error(text), doctest::Contains(text), Error);
  }
  for (const char* text : {"-3", "0", "0m+5%", "0.001", "1e6", "inf", "nan"}) {
    CAPTURE(text);
    CHECK_THROWS_WITH_AS(allowed_error(text), doctest::Contains("0.01 to 100000"), Error);
  }
  for (const char* text : {"5m+101%", "5m+-1%", "5m+nan%", "5m+0.00001%"}) {
    CAPTURE(text);
    CHECK_THROWS_WITH_AS(allowed_error(text), doctest::Contains("100 %"), Error);
  }
}

TEST_CASE("presets: the figures of the documents that they name") {
  const struct {
    const char* name;
    ErrorMetric metric;
    AllowedError allowed;
    const char* source;
  } documents[] = {// A nautical mile is 1852 m.
                   {"rnp-0.3", ErrorMetric::kCross95, 555.6, "ICAO Doc 9613"},
                   {"rnp-1", ErrorMetric::kCross95, 1852.0, "ICAO Doc 9613"},
                   {"rnp-2", ErrorMetric::kCross95, 3704.0, "ICAO Doc 9613"},
                   {"rnp-4", ErrorMetric::kCross95, 7408.0, "ICAO Doc 9613"},
                   {"rnp-10", ErrorMetric::kCross95, 18520.0, "ICAO Doc 9613"},
                   {"imo-a", ErrorMetric::kR95, 100.0, "MSC.1/Circ.1575"},
                   {"imo-b", ErrorMetric::kR95, 10.0, "MSC.1/Circ.1575"},
                   {"imo-c", ErrorMetric::kR95, 1.0, "MSC.1/Circ.1575"},
                   {"imo-d", ErrorMetric::kR95, 0.1, "MSC.1/Circ.1575"},
                   {"etcs-odometry", ErrorMetric::kAlong95, {5.0, 0.05}, "SUBSET-041, 5.3.1.1"}};
  CHECK(limit_presets().size() == std::size(documents));
  for (const auto& [name, metric, allowed, source] : documents) {
    CAPTURE(name);
    const LimitPreset& preset = limit_preset(name);
    CHECK(preset.metric == metric);
    CHECK(near(preset.allowed.limit_m, allowed.limit_m, 1e-9));
    CHECK(preset.allowed.share == allowed.share);
    CHECK(preset.source.find(source) != std::string_view::npos);
    // A limit that can also be asked for without the preset.
    CHECK(allowed_error(text_of(preset.allowed)) == preset.allowed);
  }
  std::set<std::string_view> names;
  for (const LimitPreset& preset : limit_presets()) names.insert(preset.name);
  CHECK(names.size() == limit_presets().size());
}

TEST_CASE("a preset sets metric and limit and leaves its name; an unknown one lists the others") {
  ErrorLimit limit;
  limit.last_s = 60.0;
  apply_preset(limit, "etcs_odometry");
  CHECK(limit.metric == ErrorMetric::kAlong95);
  CHECK(limit.allowed() == AllowedError(5.0, 0.05));
  CHECK(limit.preset == "etcs-odometry");
  CHECK(limit.last_s == 60.0);
  CHECK_THROWS_WITH_AS(apply_preset(limit, "rnp-5"), doctest::Contains("'rnp-5' is no preset"),
                       Error);
  CHECK_THROWS_WITH_AS(apply_preset(limit, "imo"), doctest::Contains("etcs-odometry"), Error);
}

}  // namespace leeway::sim
