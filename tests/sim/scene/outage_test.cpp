#include "leeway/sim/scene/outage.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "leeway/earth/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::sim {

TEST_CASE("a summary pools by duration") {
  OutageResult a;
  a.outage = {0.0, 10.0};
  a.against = Against::kReference;
  a.end_error_h_m = 3.0;
  a.end_error_v_m = 1.0;
  a.end_sigma_h_m = 1.0;
  OutageResult b = a;
  b.end_error_h_m = 4.0;
  OutageResult c = a;
  c.outage.duration_s = 5.0;
  c.against = Against::kNothing;
  const auto s = summarize({a, c, b});
  REQUIRE(s.size() == 2);
  CHECK(s[0].duration_s == 5.0);
  CHECK(s[0].count == 0);
  CHECK(s[0].unscored == 1);
  CHECK(s[1].count == 2);
  CHECK(test::near(s[1].rms_end_h_m, std::sqrt(12.5), 1e-12));
  CHECK(test::near(s[1].rms_over_sigma_h, std::sqrt(12.5), 1e-12));
  CHECK(s[1].max_end_h_m == 4.0);
}

TEST_CASE("an outage file tells what is wrong with it") {
  const test::TempDir dir;
  CHECK(read_outages(dir.file("ok.json", R"([{"start_s": 60.5, "duration_s": 10}])")).size() == 1);
  struct Case {
    const char* content;
    const char* told;
  };
  for (const Case& c :
       {Case{"[{\"start_s\": 1}]", "duration_s"},
        Case{"[{\"start_s\": 1, \"duration_s\": -2}]", "between 0 and"},
        Case{"[{\"start_s\": \"x\", \"duration_s\": 2}]", "outage 1"}, Case{"{", "wanted"}}) {
    CAPTURE(c.content);
    const auto path = dir.file("bad.json", c.content);
    CHECK_THROWS_WITH_AS(read_outages(path), doctest::Contains(c.told), Error);
  }
  CHECK_THROWS_WITH_AS(read_outages(dir / "missing.json"), doctest::Contains("missing.json"),
                       Error);
}

}  // namespace leeway::sim
