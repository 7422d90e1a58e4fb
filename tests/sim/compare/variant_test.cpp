#include "leeway/sim/compare/variant.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "leeway/earth/earth.hpp"
#include "sim/compare/variant_run.hpp"

namespace leeway::sim {

TEST_CASE("every variant has a name of its own, without a comma, and a filter that runs it") {
  const auto variants = sensible_variants({1, 2, 5});
  // 6 schemes, 3 gravities, 2 rotations, 3 rates; 7 kernels and forms, 2 precisions, 3 intervals,
  // of which the default is among the first; the invariant EKF at 3 rates and 3 intervals; 2
  // policies of the reset at 3 rates.
  CHECK(variants.size() == 108 + 42 - 1 + 9 + 6);
  std::set<std::string> names;
  TrialStart start;
  start.estimate.nav.r_e_m.x() = wgs84::kSemiMajorAxisM;
  start.P.setIdentity();
  for (const Variant& variant : variants) {
    const std::string its_name = variant_name(variant, 50.0);
    CAPTURE(its_name);
    CHECK(names.insert(its_name).second);
    CHECK(its_name.find_first_of(",\"\n") == std::string::npos);
    CHECK(run_variant(variant, EkfConfig{}, start, RecordedTrial{}) >= 0.0);
  }
}

TEST_CASE("a name says what was chosen, and nothing that is not there") {
  CHECK(variant_name(Variant{}, 50.0) ==
        "two-sample/normal/turning/50Hz symmetric/joseph/double/0.1s");
  Variant ud;
  ud.kernel = KernelForm::kUd;
  ud.precision = Precision::kFloat;
  ud.covariance_interval_s = 0.0;
  ud.imu_divider = 5;
  CHECK(variant_name(ud, 50.0) == "two-sample/normal/turning/10Hz ud/float/each");
  ud.estimator = Estimator::kInvariantEkf;
  CHECK(variant_name(ud, 50.0) == "two-sample/normal/turning/10Hz invariant/ud/float/each");
  ud.estimator = Estimator::kReset;
  ud.strapdown = {Scheme::kExplicitEuler, GravityModel::kConstant, EarthRotation::kOff};
  CHECK(variant_name(ud, 50.0) == "explicit-euler/constant/still/10Hz reset");
}

TEST_CASE("rates that the fixes do not allow are left out") {
  for (const Variant& variant : sensible_variants({1})) CHECK(variant.imu_divider == 1);
}

TEST_CASE("combined: the motion of the one, the covariance of the other") {
  Variant strapdown;
  strapdown.strapdown.scheme = Scheme::kTrapezoid;
  strapdown.imu_divider = 2;
  Variant covariance;
  covariance.update = UpdateForm::kBatch;
  covariance.covariance_interval_s = 1.0;
  CHECK(variant_name(combined(strapdown, covariance), 50.0) ==
        "trapezoid/normal/turning/25Hz symmetric/batch/double/1s");
}

}  // namespace leeway::sim
