#include "leeway/sim/scene/filter_file.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "leeway/earth/error.hpp"
#include "tests/support/changed.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::sim {
namespace {

Scene read_back(const std::string& text) {
  const test::TempDir dir;
  std::ofstream(dir / "filter.toml") << text;
  Scene scene;
  read_filter_file(dir / "filter.toml", scene);
  return scene;
}

}  // namespace

TEST_CASE("every field of a filter is written and read back, but for what a scene tells it") {
  const std::string original = filter_file(Scene{}, "");
  test::for_each_changed(
      EkfConfig{}, test::ToAnother{}, [&](const std::string& field, const EkfConfig& other) {
        CAPTURE(field);
        Scene scene;
        scene.filter = other;
        const std::string text = filter_file(scene, "");
        const bool is_told = field.starts_with("imu.") || field == "lever_arm_b_m" ||
                             field == "gnss_correlation_s" || field == "gate_probability";
        CHECK((text == original) == is_told);
        CHECK(filter_file(read_back(text), "") == text);
      });
}

TEST_CASE("a scheme has one name, whichever way it is spelt") {
  for (const Scheme scheme : kAll<Scheme>) {
    std::string spelt(name(scheme));
    CHECK(read_back("[filter]\nscheme = \"" + spelt + "\"\n").filter.strapdown.scheme == scheme);
    std::replace(spelt.begin(), spelt.end(), '-', '_');
    CHECK(read_back("[filter]\nscheme = \"" + spelt + "\"\n").filter.strapdown.scheme == scheme);
  }
  CHECK(read_back("[filter]\nscheme = \"rk4\"\n").filter.strapdown.scheme == Scheme::kRungeKutta4);
  CHECK(read_back("[filter]\ngnss_correlation_min = 2\ngate_probability = 0\n")
            .filter.gnss_correlation_s == 120.0);
  CHECK_THROWS_AS(read_back("[filter]\ngate_probability = 0.5\n"), Error);
}

}  // namespace leeway::sim
