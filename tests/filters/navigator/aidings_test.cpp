#include "leeway/navigator/aidings.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "tests/support/near.hpp"

namespace leeway {

using test::near;

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
    // Only a heading needs nothing of the vehicle.
    const bool is_heading = std::string(aiding.name) == MeasuredHeading::kName;
    CHECK(VehicleConfig{}.*aiding.is_on == is_heading);
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

TEST_CASE("a heading log is in degrees, of the whole circle and its sigmas") {
  const Aiding& aiding = kAidings[2];
  CHECK(std::string(aiding.value_column) == "heading_deg");
  CHECK(aiding.largest == 360.0);
  CHECK(near(aiding.default_sigma, 2.0, 0.01));
  const Reading reading = aiding.reading({}, 90.0, 1.0);
  // Rounding of a product.
  CHECK(near(std::get<MeasuredHeading>(reading).heading_rad, std::numbers::pi / 2.0, 1e-15));
  CHECK(near(std::get<MeasuredHeading>(reading).sigma_rad, std::numbers::pi / 180.0, 1e-16));
  CHECK(std::visit([](const auto& r) { return is_usable(r); }, aiding.reading({}, -360.0, 2.0)));
}

TEST_CASE("every part of the vehicle aiding is one of its own") {
  for (std::size_t i = 0; i < kVehicleParts.size(); ++i) {
    VehicleConfig config;
    config.heading = false;
    config.*kVehicleParts[i].is_on = true;
    for (std::size_t k = 0; k < kVehicleParts.size(); ++k) {
      CHECK(config.*kVehicleParts[k].is_on == (k == i));
    }
  }
}

}  // namespace leeway
