#include "leeway/navigator/aidings.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <string>

namespace leeway {

TEST_CASE("readings that no vehicle gives are not usable") {
  CHECK(is_usable(OdometerSpeed{{}, -3.0, 0.1}));
  CHECK_FALSE(is_usable(OdometerSpeed{{}, 501.0, 0.1}));
  CHECK_FALSE(is_usable(OdometerSpeed{{}, 3.0, 0.0}));
  // 2026-11-28: the square of such a sigma is zero, and the filter divided by it.
  CHECK_FALSE(is_usable(OdometerSpeed{{}, 3.0, 1e-308}));
  CHECK_FALSE(is_usable(OdometerSpeed{{}, NAN, 0.1}));
  CHECK(is_usable(BarometricHeight{{}, -20.0, 0.5}));
  CHECK_FALSE(is_usable(BarometricHeight{{}, 2e5, 0.5}));
  CHECK_FALSE(is_usable(BarometricHeight{{}, 0.0, -0.5}));
}

TEST_CASE("every sensor has a row: its own names, a switch, and readings of its kind") {
  std::set<std::string> names;
  for (std::size_t a = 0; a < kAidings.size(); ++a) {
    const Aiding& aiding = kAidings[a];
    CAPTURE(std::string(aiding.name));
    names.insert({aiding.name, aiding.value_column, aiding.log});
    CHECK_FALSE(VehicleConfig{}.*aiding.is_on);
    CHECK(VehicleConfig::car().*aiding.is_on);
    const Time t = time_from_seconds(3.0);
    const Reading reading = aiding.reading(t, 0.5 * aiding.largest, aiding.default_sigma);
    CHECK(reading.index() == a + 1);  // after the fix
    std::visit(
        [&](const auto& r) {
          CHECK(is_usable(r));
          CHECK(r.time == t);
        },
        reading);
    std::visit([](const auto& r) { CHECK_FALSE(is_usable(r)); },
               aiding.reading(t, 1.01 * aiding.largest, aiding.default_sigma));
  }
  CHECK(names.size() == 3 * kAidings.size());
}

TEST_CASE("every part of the vehicle aiding is one of its own") {
  for (std::size_t i = 0; i < kVehicleParts.size(); ++i) {
    VehicleConfig config;
    config.*kVehicleParts[i].is_on = true;
    for (std::size_t k = 0; k < kVehicleParts.size(); ++k) {
      CHECK(config.*kVehicleParts[k].is_on == (k == i));
    }
  }
}

}  // namespace leeway
