#include "leeway/earth/units.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::near;

const std::vector<Unit>& all_units() {
  using namespace units;
  static const std::vector<Unit> kAll{kS,
                                      kMs,
                                      kMin,
                                      kH,
                                      kHz,
                                      kM,
                                      kCm,
                                      kKm,
                                      kMps,
                                      kKmPerH,
                                      kRad,
                                      kMrad,
                                      kDeg,
                                      kArcsec,
                                      kRatio,
                                      kPercent,
                                      kPpm,
                                      kMps2,
                                      kStandardG,
                                      kMg,
                                      kUg,
                                      kMps2PerSqrtHz,
                                      kGPerSqrtHz,
                                      kMgPerSqrtHz,
                                      kUgPerSqrtHz,
                                      kMpsPerSqrtH,
                                      kFtpsPerSqrtH,
                                      kRadps,
                                      kDegPerS,
                                      kDegPerH,
                                      kRadpsPerSqrtHz,
                                      kDpsPerSqrtHz,
                                      kDegPerSqrtH,
                                      kMdpsPerSqrtHz,
                                      kRadpsPerMps2,
                                      kRadpsPerG,
                                      kDegPerSPerG,
                                      kDegPerHPerG};
  return kAll;
}

const Unit& unit_of(std::string_view symbol) {
  const auto found = std::find_if(all_units().begin(), all_units().end(),
                                  [symbol](const Unit& u) { return u.symbol == symbol; });
  REQUIRE(found != all_units().end());
  return *found;
}

}  // namespace

TEST_CASE("units: every factor against its exact value") {
  // From the definitions, g = 9.80665 m/s^2, 1 ft = 0.3048 m, pi to 40 digits, rounded to 17.
  const struct {
    const char* symbol;
    double si;
    const char* si_symbol;
  } cases[] = {
      {"s", 1.0, "s"},
      {"ms", 0.001, "s"},
      {"min", 60.0, "s"},
      {"h", 3600.0, "s"},
      {"Hz", 1.0, "Hz"},
      {"m", 1.0, "m"},
      {"cm", 0.01, "m"},
      {"km", 1000.0, "m"},
      {"m/s", 1.0, "m/s"},
      {"km/h", 0.27777777777777778, "m/s"},
      {"rad", 1.0, "rad"},
      {"mrad", 0.001, "rad"},
      {"deg", 1.7453292519943296e-2, "rad"},
      {"arcsec", 4.8481368110953599e-6, "rad"},
      {"1", 1.0, "1"},
      {"%", 0.01, "1"},
      {"ppm", 1e-6, "1"},
      {"m/s^2", 1.0, "m/s^2"},
      {"g", 9.80665, "m/s^2"},
      {"mg", 9.80665e-3, "m/s^2"},
      {"ug", 9.80665e-6, "m/s^2"},
      {"m/s^2/sqrt(Hz)", 1.0, "m/s^2/sqrt(Hz)"},
      {"g/sqrt(Hz)", 9.80665, "m/s^2/sqrt(Hz)"},
      {"mg/sqrt(Hz)", 9.80665e-3, "m/s^2/sqrt(Hz)"},
      {"ug/sqrt(Hz)", 9.80665e-6, "m/s^2/sqrt(Hz)"},
      {"m/s/sqrt(h)", 1.6666666666666667e-2, "m/s^2/sqrt(Hz)"},
      {"ft/s/sqrt(h)", 5.08e-3, "m/s^2/sqrt(Hz)"},
      {"rad/s", 1.0, "rad/s"},
      {"deg/s", 1.7453292519943296e-2, "rad/s"},
      {"deg/h", 4.8481368110953599e-6, "rad/s"},
      {"rad/s/sqrt(Hz)", 1.0, "rad/s/sqrt(Hz)"},
      {"dps/sqrt(Hz)", 1.7453292519943296e-2, "rad/s/sqrt(Hz)"},
      {"mdps/sqrt(Hz)", 1.7453292519943296e-5, "rad/s/sqrt(Hz)"},
      {"deg/sqrt(h)", 2.9088820866572160e-4, "rad/s/sqrt(Hz)"},
      {"rad/s/(m/s^2)", 1.0, "rad/s/(m/s^2)"},
      {"rad/s/g", 0.10197162129779283, "rad/s/(m/s^2)"},
      {"deg/s/g", 1.7797405352432581e-3, "rad/s/(m/s^2)"},
      {"deg/h/g", 4.9437237090090501e-7, "rad/s/(m/s^2)"},
  };
  CHECK(std::size(cases) == all_units().size());
  for (const auto& c : cases) {
    CAPTURE(c.symbol);
    // A few roundings.
    CHECK(near(unit_of(c.symbol).si, c.si, 4e-16 * c.si));
    CHECK(unit_of(c.symbol).si_symbol == c.si_symbol);
  }
}

TEST_CASE("units: each is one step from a unit of the same measure; symbols and keys are unique") {
  for (const Unit& u : all_units()) {
    CAPTURE(u.symbol);
    const Unit& base = unit_of(u.base);
    CHECK(base.si_symbol == u.si_symbol);
    CHECK(near(u.times / u.over * base.si, u.si, 4e-16 * u.si));
    const auto same = [&u](const Unit& v) { return v.symbol == u.symbol || v.key == u.key; };
    CHECK(std::count_if(all_units().begin(), all_units().end(), same) == 1);
  }
}

TEST_CASE("units: a conversion is shown step by step") {
  const struct {
    double value;
    Unit unit;
    const char* text;
  } cases[] = {
      {4.5, units::kDegPerH, "4.5 deg/h = 4.5 / 3600 deg/s = 2.182e-05 rad/s"},
      {50.0, units::kUg, "50 ug = 50 / 1000000 g = 0.0004903 m/s^2"},
      {0.3, units::kMps2, "0.3 m/s^2"},
      {2.0, units::kStandardG, "2 g = 2 x 9.80665 m/s^2 = 19.61 m/s^2"},
      {0.15, units::kDegPerSqrtH,
       "0.15 deg/sqrt(h) = 0.15 / 60 dps/sqrt(Hz) = 4.363e-05 rad/s/sqrt(Hz)"},
      {300.0, units::kPpm, "300 ppm = 300 / 1000000 = 0.0003"},
      {1.0, units::kDegPerS, "1 deg/s = 1 x 0.01745329252 rad/s = 0.01745 rad/s"},
  };
  for (const auto& c : cases) CHECK(working(c.value, c.unit) == c.text);
}

}  // namespace leeway
