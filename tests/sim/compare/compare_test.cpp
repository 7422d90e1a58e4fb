#include "leeway/sim/compare/compare.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <set>

#include "leeway/earth/error.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "sim/compare/variant_run.hpp"
#include "sim/trials/recorded_trial.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

using test::near;

Scene loop_scene(ImuClass imu, double duration_s, double interval_s, int trials) {
  Scene scene;
  scene.name = "loop";
  scene.trajectory = square_loop();
  scene.duration_s = duration_s;
  set_imu(scene, std::string(name(imu)), imu_class_model(imu, RangeEnd::kMid));
  scene.filter.gnss_correlation_s = 0.0;
  scene.filter.gate_probability = 0.0;
  scene.gnss.interval_s = interval_s;
  scene.trials = trials;
  return scene;
}

Variant with_scheme(Scheme scheme) {
  Variant variant;
  variant.strapdown.scheme = scheme;
  return variant;
}

/// As bits, for a variant that is not finite has NaN, which is not equal to itself.
std::vector<std::uint64_t> bits(const std::vector<Accuracy>& accuracies) {
  std::vector<std::uint64_t> all;
  for (const Accuracy& a : accuracies) {
    for (const double x : {a.figures.rms_horizontal_m, a.figures.mean_nees, a.r95_m}) {
      all.push_back(std::bit_cast<std::uint64_t>(x));
    }
  }
  return all;
}

/// Root of the mean claimed horizontal variance before scored fixes of one trial.
double claimed_sigma_m(const TrialPlan& plan, const RecordedTrial& trial, double interval_s) {
  Variant variant;
  variant.covariance_interval_s = interval_s;
  TrialScore score;
  run_variant(variant, plan.scene().filter, trial.start, trial,
              [&score](const Estimate& truth, const Estimate& e, const ErrorMatrix* P) {
                score_epoch(score, truth, e, P);
              });
  REQUIRE(score.epochs > 0);
  return std::sqrt(score.variance_n_m2.head<2>().sum() / static_cast<double>(score.epochs));
}

}  // namespace

TEST_CASE("the default variant errs as a campaign of the scene's own filter does") {
  const Scene scene = loop_scene(ImuClass::kTactical, 120.0, 10.0, 3);
  const CampaignResult campaigned = campaign(scene);
  const Accuracy accuracy = accuracy_of({Variant{}}, scene).front();
  // Rounding, amplified by what a minute of turns does with it.
  CHECK(near(accuracy.figures.rms_horizontal_m, campaigned.rms_horizontal_m, 1e-6));
  CHECK(near(accuracy.figures.mean_nees, campaigned.mean_nees, 1e-4));
  CHECK(accuracy.figures.epochs == campaigned.epochs);
  CHECK(accuracy.r95_m > accuracy.figures.rms_horizontal_m);
  CHECK(accuracy.r95_m <= accuracy.figures.worst_horizontal_m);
}

TEST_CASE(
    "every kernel runs the invariant EKF, which errs as the plain one with fixes every second") {
  const Scene scene = loop_scene(ImuClass::kTactical, 120.0, 1.0, 3);
  std::vector<Variant> variants{Variant{}};
  for (const KernelForm kernel : kAll<KernelForm>) {
    variants.push_back({.estimator = Estimator::kInvariantEkf, .kernel = kernel});
  }
  const auto accuracies = accuracy_of(variants, scene);
  const double plain_m = accuracies[0].figures.rms_horizontal_m;
  const CampaignResult& invariant = accuracies[1].figures;
  // Corrections are small, so the two differ by little; but they do, or it was not chosen.
  CHECK(near(invariant.rms_horizontal_m, plain_m, 0.02 * plain_m));
  CHECK(invariant.rms_horizontal_m != plain_m);
  for (const Accuracy& a : accuracies) {
    CHECK(a.has_claim);
    CHECK(a.figures.diverged == 0);
    if (&a == &accuracies[0]) continue;
    // The kernels differ by rounding.
    CHECK(near(a.figures.rms_horizontal_m, invariant.rms_horizontal_m, 1e-6));
  }
}

TEST_CASE("same seeds, same bits of accuracy, on any number of threads") {
  const Scene scene = loop_scene(ImuClass::kTactical, 60.0, 10.0, 4);
  const auto variants = sensible_variants({5});
  const auto one = bits(accuracy_of(variants, scene, 1));
  CHECK(one == bits(accuracy_of(variants, scene, 2)));
}

TEST_CASE("a lower rate is the same sensor read less often") {
  const Scene scene = loop_scene(ImuClass::kTactical, 20.0, 2.0, 1);
  const TrialPlan plan(scene);
  CHECK(fits(plan, 1));
  CHECK(fits(plan, 5));
  CHECK(!fits(plan, 3));
  const RecordedTrial full = record_trial(plan, 1);
  const RecordedTrial slow = at_lower_rate(full, 5);
  REQUIRE(slow.imu.size() == full.imu.size() / 5);
  Eigen::Vector3d dv_mps = Eigen::Vector3d::Zero();
  for (std::size_t k = 5; k < 10; ++k) dv_mps += full.imu[k].dv_b_mps;
  CHECK(near(slow.imu[1].dv_b_mps, dv_mps, 1e-15));
  CHECK(near(slow.imu[1].dt_s, 0.1, 1e-15));
  CHECK(slow.imu[1].time == full.imu[9].time);
  REQUIRE(slow.fixes.size() == full.fixes.size());
  for (std::size_t i = 0; i < slow.fixes.size(); ++i) {
    CHECK(slow.imu[slow.fixes[i].at].time == full.imu[full.fixes[i].at].time);
  }
  Variant third;
  third.imu_divider = 3;
  CHECK_THROWS_WITH_AS(accuracy_of({third}, scene), doctest::Contains("imu_divider is 3"), Error);
}

TEST_CASE("P ten times a second instead of fifty changes what is claimed by less than 1 %" *
          doctest::test_suite("heavy")) {
  for (const ImuClass imu : kAll<ImuClass>) {
    CAPTURE(name(imu));
    const TrialPlan plan(loop_scene(imu, 600.0, 10.0, 1));
    const RecordedTrial trial = record_trial(plan, 1);
    const double ratio = claimed_sigma_m(plan, trial, 0.1) / claimed_sigma_m(plan, trial, 0.0);
    MESSAGE(name(imu) << ": ratio of sigmas - 1 = " << ratio - 1.0);
    CHECK(near(ratio, 1.0, 0.01));
  }
}

TEST_CASE("explicit Euler errs more than two-sample where there is motion" *
          doctest::test_suite("heavy")) {
  // A marine IMU, so that it is the scheme that errs, and minutes for it to show.
  Scene scene = loop_scene(ImuClass::kMarine, 600.0, 60.0, 3);
  const auto accuracies =
      accuracy_of({with_scheme(Scheme::kExplicitEuler), with_scheme(Scheme::kTwoSample)}, scene);
  const double euler_m = accuracies[0].figures.rms_horizontal_m;
  const double two_sample_m = accuracies[1].figures.rms_horizontal_m;
  MESSAGE("RMS of explicit Euler " << euler_m << " m, of two-sample " << two_sample_m << " m");
  CHECK(euler_m > 1.1 * two_sample_m);
}

TEST_CASE(
    "a heading 10 deg off and a whole turn between two fixes: the invariant EKF is the worse" *
    doctest::test_suite("heavy")) {
  // Why: docs/theory/alternatives/invariant_ekf.md, "What it does not do".
  Scene scene = loop_scene(ImuClass::kTactical, 120.0, 10.0, 60);
  InitialSigma start = initial_sigma(scene);
  start.heading_rad = 10.0 * kRadPerDeg;
  scene.initial = start;
  Variant invariant;
  invariant.estimator = Estimator::kInvariantEkf;
  const auto accuracies = accuracy_of({Variant{}, invariant}, scene);
  const CampaignResult& plain = accuracies[0].figures;
  const CampaignResult& other = accuracies[1].figures;
  MESSAGE("RMS " << plain.rms_horizontal_m << " -> " << other.rms_horizontal_m << " m, diverged "
                 << plain.diverged << " -> " << other.diverged << " of " << plain.trials);
  CHECK(plain.diverged > 0);
  CHECK(other.diverged > plain.diverged);
  CHECK(other.rms_horizontal_m > plain.rms_horizontal_m);
}

TEST_CASE("compare: sorted, ranked, and combinations of survivors among them" *
          doctest::test_suite("heavy")) {
  Scene scene = loop_scene(ImuClass::kTactical, 120.0, 10.0, 2);
  scene.gnss.latency_s = 0.3;
  scene.gnss.outlier_probability = 0.2;
  CompareOptions options;
  options.repeat = 3;
  double last = 0.0;
  options.progress = [&last](double fraction) {
    CHECK(fraction >= last);
    last = fraction;
  };
  const Comparison comparison = compare(scene, options);
  CHECK(last == 1.0);
  CHECK(comparison.scene.gnss.latency_s == 0.0);
  CHECK(comparison.scene.gnss.outlier_probability == 0.0);
  CHECK(comparison.imu_dividers == std::vector<int>{1, 2, 5});
  CHECK(comparison.variants.size() > sensible_variants({1, 2, 5}).size());
  std::set<std::string> names;
  int on_front = 0;
  for (std::size_t v = 0; v < comparison.variants.size(); ++v) {
    const Compared& c = comparison.variants[v];
    CAPTURE(c.name);
    CHECK(names.insert(c.name).second);
    CHECK(c.cost.least_ns_per_s > 0.0);
    CHECK(c.cost.least_ns_per_s <= c.cost.median_ns_per_s);
    CHECK(c.cost.median_ns_per_s <= c.cost.most_ns_per_s);
    if (v > 0) CHECK(comparison.variants[v - 1].cost.median_ns_per_s <= c.cost.median_ns_per_s);
    CHECK(!(c.on_front && c.dominated_by));
    on_front += c.on_front ? 1 : 0;
  }
  CHECK(on_front >= 1);
  CHECK(on_front < 40);
}

TEST_CASE("nonsense in a trial is an outcome") {
  Scene scene = loop_scene(ImuClass::kTactical, 60.0, 10.0, 1);
  scene.imu.accelerometer.bias.setConstant(1e200);
  Variant reset;
  reset.estimator = Estimator::kReset;
  for (const Accuracy& a : accuracy_of({Variant{}, reset}, scene)) {
    CHECK(consistency_of(a) == Consistency::kNotFinite);
    CHECK(a.figures.not_finite == 1);
  }
}

TEST_CASE("consistency is two-sided, and not for who claims nothing") {
  Accuracy a;
  a.figures.nees_low = 14.0;
  a.figures.nees_high = 16.0;
  const auto with_nees = [&a](double nees) {
    a.figures.mean_nees = nees;
    return consistency_of(a);
  };
  CHECK(with_nees(15.0) == Consistency::kConsistent);
  CHECK(with_nees(13.0) == Consistency::kPessimistic);
  CHECK(with_nees(17.0) == Consistency::kOptimistic);
  a.figures.diverged = 1;
  CHECK(with_nees(15.0) == Consistency::kDiverged);
  a.has_claim = false;
  CHECK(with_nees(0.0) == Consistency::kNoClaim);
  CompareOptions none;
  none.repeat = 0;
  CHECK_THROWS_WITH_AS(compare(loop_scene(ImuClass::kTactical, 60.0, 10.0, 1), none),
                       doctest::Contains("repeat is 0"), Error);
}

}  // namespace leeway::sim
