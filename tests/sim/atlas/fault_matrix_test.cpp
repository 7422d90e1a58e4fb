#include "sim/atlas/faults/fault_matrix.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>

#include "sim/atlas/faults/fault_run.hpp"

namespace leeway::sim {

TEST_CASE("faults: 70 and more, each with a name of its own, on seven vehicles") {
  std::set<std::string> names;
  for (const Fault& fault : faults()) {
    CAPTURE(fault.name);
    CHECK(names.insert(fault.name).second);
    CHECK(fault.duration_s > 0.0);
    CHECK((fault.damage || fault.motion));
  }
  CHECK(names.size() >= 70);
  CHECK(regimes().size() == 7);
  CHECK(regimes()[kCarRegime].config.vehicle.kind == VehicleKind::kCar);
}

TEST_CASE("faults: the inputs outside of the window stay as they are") {
  const Regime& car = regimes()[kCarRegime];
  const FaultDrive drive = drive_of(car, car.trajectory, 60.0);
  const FaultWindow window{20.0, 30.0};
  const auto before = [&](const auto& arrivals) {
    return std::count_if(arrivals.begin(), arrivals.end(),
                         [&](const auto& a) { return a.at_s <= window.from_s; });
  };
  for (const Fault& fault : faults()) {
    if (!fault.damage) continue;
    CAPTURE(fault.name);
    FaultInputs inputs = drive.inputs;
    fault.damage(inputs, window);
    CHECK(before(inputs.imu) == before(drive.inputs.imu));
    CHECK(before(inputs.fixes) == before(drive.inputs.fixes));
  }
}

TEST_CASE("faults: a drive without one is right, and a way gone backwards is one") {
  const Regime& car = regimes()[kCarRegime];
  const Trajectory back = paced_at_first(car.trajectory, 60.0, -1.0, 20.0);
  const double backwards_mps = truth_at(back, 10.0).nav.v_e_mps.dot(
      truth_at(car.trajectory, 50.0).nav.v_e_mps.normalized());
  CHECK(backwards_mps < -5.0);
  const FaultDrive drive = drive_of(car, car.trajectory, 120.0);
  Navigator navigator(car.config);
  int beyond = 0;
  run_navigator(navigator, drive.inputs, drive.way, 120.0,
                [&](const FaultEpoch& epoch) { beyond += epoch.is_beyond(); });
  CHECK(beyond == 0);
}

TEST_CASE("faults: the same cells on any number of threads" * doctest::test_suite("heavy")) {
  const FaultMatrix one = run_fault_matrix(true, 1);
  const FaultMatrix two = run_fault_matrix(true, 2);
  REQUIRE(one.cells.size() == two.cells.size());
  for (std::size_t k = 0; k < one.cells.size(); ++k) {
    CAPTURE(faults()[one.cells[k].fault].name);
    CHECK(one.cells[k].silent_s == two.cells[k].silent_s);
    CHECK(one.cells[k].told_s == two.cells[k].told_s);
    CHECK(one.cells[k].worst_m == two.cells[k].worst_m);
    CHECK(one.cells[k].finite);
  }
}

}  // namespace leeway::sim
