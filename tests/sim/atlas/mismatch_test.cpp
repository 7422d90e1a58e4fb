#include "sim/atlas/mismatch/mismatch.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <string>

namespace leeway::sim {
namespace {

const TrueImu& named(const std::vector<TrueImu>& imus, const std::string& name) {
  for (const TrueImu& imu : imus) {
    if (imu.name == name) return imu;
  }
  FAIL("no IMU of the name " << name);
  return imus.front();
}

/// A drive of a car with fixes every second.
struct CarDrive {
  TrueDrive way{};
  FaultInputs inputs{};
};

CarDrive car_with_fixes() {
  const Regime& car = regimes()[kCarRegime];
  CarDrive drive{true_drive(car.trajectory, car.imu_rate_hz, kDenseS + kSparseS), {}};
  drive.inputs = inputs_of(drive.way, car.imu, {.errors = car.gnss}, 0.5, 1);
  return drive;
}

}  // namespace

TEST_CASE("mismatch: a factor changes what it names, and nothing else") {
  const std::vector<TrueImu> imus = true_imus(false);
  std::set<std::string> names;
  for (const TrueImu& imu : imus) CHECK(names.insert(imu.name).second);
  CHECK(imus.size() >= 40);
  const ImuErrorModel believed = believed_imu();
  const ImuErrorModel noisy = named(imus, "noise x 10").model;
  // Products of two numbers: their rounding.
  CHECK(noisy.gyro.noise_density / believed.gyro.noise_density ==
        doctest::Approx(10.0).epsilon(1e-12));
  CHECK(noisy.gyro.in_run.sigma == believed.gyro.in_run.sigma);
  CHECK(noisy.gyro.scale_sigma == believed.gyro.scale_sigma);
  const ImuErrorModel all = named(imus, "all x 0.3").model;
  CHECK(all.accelerometer.in_run.sigma / believed.accelerometer.in_run.sigma ==
        doctest::Approx(0.3).epsilon(1e-12));
  CHECK(all.accelerometer.misalignment_sigma_rad / believed.accelerometer.misalignment_sigma_rad ==
        doctest::Approx(0.3).epsilon(1e-12));
  CHECK(all.accelerometer.bias_sigma == believed.accelerometer.bias_sigma);
}

TEST_CASE("mismatch: fixes every second for 300 s, then every T") {
  const CarDrive drive = car_with_fixes();
  for (const int t_s : {1, 5, 10, 20}) {
    CAPTURE(t_s);
    FaultInputs inputs = drive.inputs;
    thin_out(inputs, t_s);
    CHECK(inputs.fixes.size() == static_cast<std::size_t>(kDenseS + kSparseS / t_s));
    const double last_s = to_seconds(inputs.fixes[inputs.fixes.size() - 2].input.time);
    CHECK(std::lround(to_seconds(inputs.fixes.back().input.time) - last_s) == t_s);
  }
}

TEST_CASE("mismatch: errors and claims are summed as squares") {
  ClaimSums sums;
  FaultEpoch epoch{.claims = {{{3.0, 2.0}, {0.1, 0.1}, {0.0, 0.1}}}, .sigmas = {4.0, 0.0, 0.0}};
  sums.add(epoch);
  epoch.claims[0] = {4.0, 1.0};
  sums.add(epoch);
  // (9 + 16) / (4 + 1), to rounding.
  CHECK(std::abs(sums.ratio(FaultError::kPosition) - std::sqrt(5.0)) < 1e-12);
  CHECK(std::abs(sums.rms(FaultError::kPosition) - std::sqrt(12.5)) < 1e-12);
  CHECK(sums.ratio(FaultError::kHeading) == 0.0);
  CHECK(sums.beyond_3 == 2.0);
  CHECK(sums.beyond_5 == 0.0);
}

TEST_CASE("mismatch: a navigator without fixes is lost, and claims nothing") {
  CarDrive drive = car_with_fixes();
  drive.inputs.fixes.clear();
  const ClaimScore score = run_claims({}, drive.inputs, drive.way, 10);
  CHECK(score.lost);
  CHECK(score.between.epochs == 0.0);
  CHECK(std::isinf(MismatchCell{}.ratio()));
}

TEST_CASE("mismatch: none is lost, and the same bits on any number of threads" *
          doctest::test_suite("heavy")) {
  const MismatchCampaign one = run_mismatch({.brief = true, .trials = 1, .threads = 1});
  const MismatchCampaign two = run_mismatch({.brief = true, .trials = 1, .threads = 2});
  REQUIRE(one.cells.size() == two.cells.size());
  for (std::size_t k = 0; k < one.cells.size(); ++k) {
    CAPTURE(one.imus[one.cells[k].imu].name);
    CAPTURE(name(one.cells[k].fixes));
    CAPTURE(name(one.cells[k].vehicle));
    CHECK(one.cells[k].lost.empty());
    // One unit of an IMU: its claim may be off by more than that of many.
    CHECK(one.cells[k].ratio() > 0.1);
    CHECK(one.cells[k].ratio() < 4.0);
    CHECK(one.cells[k].ratio() == two.cells[k].ratio());
    CHECK(one.cells[k].imu_sigma_scale == two.cells[k].imu_sigma_scale);
  }
}

}  // namespace leeway::sim
