#include "sim/analysis/doubling/end_analysis.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/analysis/scene_tracks.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "sim/analysis/doubling/repeated_fixes.hpp"

namespace leeway::sim {
namespace {

/// reference/README.md, "Correction interval, a defined case", on a trajectory.
Scene scene_on(const Trajectory& trajectory, double interval_s, double duration_s = 14400.0) {
  Scene scene;
  scene.name = "on a trajectory";
  scene.trajectory = trajectory;
  scene.duration_s = duration_s;
  scene.gnss.interval_s = interval_s;
  set_imu(scene, "tactical", imu_class_model(ImuClass::kTactical, RangeEnd::kMid));
  scene.filter.gnss_correlation_s = 0.0;
  return scene;
}

/// With all that can be doubled: the filter knows neither how wrong its sensors are nor how long
/// the errors of fixes last.
Scene wronged(Scene scene) {
  scene.imu.accelerometer.scale_sigma = 1e-3;
  scene.imu.gyro.misalignment_sigma_rad = 1e-3;
  scene.imu.gyro.noise_density *= 1.5;
  scene.filter.lever_arm_b_m = scene.gnss.errors.lever_arm_b_m = {0.5, -0.3, -1.0};
  scene.gnss.errors.correlated_sigma_n_m = {1.5, 1.0, 2.0};
  scene.gnss.errors.correlation_time_s = 60.0;
  scene.filter.gnss_correlation_s = 40.0;
  scene.gnss.latency_s = 0.2;
  return scene;
}

Trajectory at_rest() { return static_trajectory({.duration_s = 14400.0}); }

void check_against_steps(const Scene& scene, double tolerance) {
  const ErrorTrack track = error_track(scene);
  const CovarianceAnalysis stepped = analyze(scene, track);
  const CovarianceAnalysis doubled = EndAnalysis(scene, track).at(scene.gnss.interval_s);
  CAPTURE(scene.gnss.interval_s);
  CAPTURE(stepped.true_m);
  CAPTURE(doubled.true_m);
  CHECK(std::abs(doubled.true_m / stepped.true_m - 1.0) < tolerance);
  CHECK(std::abs(doubled.claimed_m / stepped.claimed_m - 1.0) < tolerance);
  CHECK(std::abs(doubled.true_drms_m / stepped.true_drms_m - 1.0) < tolerance);
  CHECK(doubled.settled == stepped.settled);
  CHECK(doubled.fixes == stepped.fixes);
}

std::optional<FixPattern> pattern_of(const Scene& scene) {
  const double T_s = scene.gnss.interval_s;
  return fix_pattern(scene, error_track(scene), {T_s, scene.duration_s - 960.0, T_s});
}

}  // namespace

TEST_CASE("a stretch does what its legs do one by one") {
  // 1e-9: rounding, of products in another order.
  const Scene scene = wronged(scene_on(square_loop(), 10.0));
  const ErrorTrack track = error_track(scene);
  Stretches stretches(scene, track);
  const ProcessNoise claimed = process_noise(scene.filter.imu);
  for (const auto& [from_s, to_s] :
       {std::pair{0.0, 240.0}, {3.3, 3.4}, {3.3, 61.7}, {200.5, 555.0}}) {
    ErrorMatrix P = ErrorMatrix::Identity();
    ErrorMatrix all = ErrorMatrix::Identity();
    ParameterMatrix S = ParameterMatrix::Zero();
    track.follow(from_s, to_s, [&](const Leg& leg) {
      propagate(P, leg.Phi, with_motion(claimed, scene.filter.imu, leg.motion));
      S = times(leg.Phi, S) + leg.B;
    });
    const Stretch stretch = stretches.between(from_s, to_s);
    propagate(all, stretch.Phi, ProcessNoise{});
    all += stretch.claimed_noise;
    CAPTURE(from_s);
    CHECK(std::abs(stretch.Phi.dt_s - (to_s - from_s)) < 1e-9);
    CHECK((all - P).norm() < 1e-9 * P.norm());
    CHECK((stretch.B - S).norm() < 1e-9 * S.norm());
  }
}

TEST_CASE("motion that repeats with the fixes is doubled as exactly as it is stepped" *
          doctest::test_suite("heavy")) {
  // Where legs end at fixes 1e-7 is rounding, of 4 h of biases learnt.
  check_against_steps(scene_on(square_loop(), 16.0), 1e-7);
  check_against_steps(scene_on(square_loop(), 100.0), 1e-7);
  check_against_steps(wronged(scene_on(square_loop(), 6.0)), 1e-7);
  check_against_steps(scene_on(at_rest(), 9.0), 1e-7);
  check_against_steps(wronged(scene_on(at_rest(), 9.0)), 1e-7);
  // In a run of steady motion what lies between two fixes is cut into legs once: 1 % of the step's
  // own error, which is 4e-5.
  check_against_steps(scene_on(square_loop(), 3.75), 1e-6);
  // Elsewhere the legs between two fixes are cut otherwise from fix to fix: the step's own error.
  check_against_steps(scene_on(at_rest(), 9.3), 1e-4);
  check_against_steps(wronged(scene_on(at_rest(), 47.1)), 1e-4);
}

TEST_CASE("fixes that are moved a little and what is not doubled: within 1e-4" *
          doctest::test_suite("heavy")) {
  // The limit is a tenth of what an interval is asked for.
  for (const double T_s : {0.7, 3.7, 5.91, 8.3, 14.6}) {
    check_against_steps(scene_on(square_loop(), T_s), 1e-4);
    check_against_steps(wronged(scene_on(square_loop(), T_s)), 1e-4);
  }
  check_against_steps(scene_on(square_loop(), 58.6), 1e-7);
  check_against_steps(wronged(scene_on(square_loop(), 283.1)), 1e-7);
}

TEST_CASE("a pattern of fixes: one at rest, those of some periods on a loop") {
  const auto at_fixes = [](const Scene& scene) {
    const auto pattern = pattern_of(scene);
    return pattern ? pattern->fixes : 0;
  };
  CHECK(at_fixes(scene_on(at_rest(), 9.3)) == 1);
  CHECK(at_fixes(scene_on(square_loop(), 60.0)) == 4);
  CHECK(at_fixes(scene_on(square_loop(), 100.0)) == 12);  // in five loops
  CHECK(at_fixes(scene_on(square_loop(), 3.7)) == 65);    // moved to 240 / 65 s
  CHECK(std::abs(pattern_of(scene_on(square_loop(), 3.7))->row_weight -
                 std::sqrt(240.0 / 65.0 / 3.7)) < 1e-12);
}

TEST_CASE("no pattern where the motion does not repeat, or not often enough") {
  CHECK(!pattern_of(scene_on(car_drive({.duration_s = 14400.0}), 10.0)));
  CHECK(!pattern_of(scene_on(straight({.duration_s = 14400.0}), 10.0)));
  CHECK(!pattern_of(scene_on(square_loop(), 58.6)));
  CHECK(!pattern_of(scene_on(square_loop(), 60.0, 1800.0)));
}

TEST_CASE("fixes closer than a step, taken as one where they change little, or not at all") {
  // 5e-4: fixes that are one take 5 % off a variance, which is then taken for even in between.
  Scene scene = scene_on(car_drive({.duration_s = 900.0}), 0.1, 900.0);
  scene.gnss.settle_s = 300.0;
  for (const Scene& each : {scene, wronged(scene)}) {
    for (const double T_s : {0.1, 0.27, 0.6}) {
      Scene at = each;
      at.gnss.interval_s = T_s;
      const ErrorTrack track = error_track(at);
      const CovarianceAnalysis stepped = analyze(at, track);
      const CovarianceAnalysis together = EndAnalysis(at, track).at(T_s);
      CAPTURE(T_s);
      CHECK(std::abs(together.true_m / stepped.true_m - 1.0) < 5e-4);
      CHECK(std::abs(together.claimed_m / stepped.claimed_m - 1.0) < 5e-4);
    }
  }
}

TEST_CASE("the filter that settled before one interval is that of the next") {
  Scene scene = wronged(scene_on(car_drive({.duration_s = 900.0}), 20.0, 900.0));
  scene.gnss.settle_s = 300.0;
  const ErrorTrack track = error_track(scene);
  EndAnalysis all(scene, track);
  for (const double T_s : {20.0, 47.3, 20.0}) {
    const CovarianceAnalysis again = all.at(T_s);
    const CovarianceAnalysis alone = EndAnalysis(scene, track).at(T_s);
    // Not one bit: nothing is done in another order.
    CHECK(again.true_m == alone.true_m);
    CHECK(again.fixes == alone.fixes);
    CHECK(again.settled == alone.settled);
  }
}

TEST_CASE("what lies between fixes of steady motion is the same again") {
  // 1e-9: rounding. 12 s is within runs of 64 legs; the third of them comes from the second.
  const Scene scene = wronged(scene_on(straight({.duration_s = 600.0}), 12.0, 600.0));
  const ErrorTrack track = error_track(scene);
  Stretches stretches(scene, track);
  const ProcessNoise claimed = process_noise(scene.filter.imu);
  ErrorMatrix stepped = ErrorMatrix::Identity();
  ErrorMatrix taken = stepped;
  struct Taker {
    ErrorMatrix& P;
    const ImuErrorModel& imu;
    const ProcessNoise& noise;
    void operator()(const Stretch& stretch) const {
      propagate(P, stretch.Phi, ProcessNoise{});
      P += stretch.claimed_noise;
    }
    void operator()(const Leg& leg) const {
      propagate(P, leg.Phi, with_motion(noise, imu, leg.motion));
    }
  };
  for (double t_s = 0.0; t_s < 599.0; t_s += 12.0) {
    stretches.follow(t_s, t_s + 12.0, Taker{taken, scene.filter.imu, claimed});
    track.follow(t_s, t_s + 12.0, Taker{stepped, scene.filter.imu, claimed});
    CAPTURE(t_s);
    CHECK((taken - stepped).norm() < 1e-9 * stepped.norm());
  }
}

TEST_CASE("tracks of IMUs on one motion are what each is alone") {
  SceneTracks tracks;
  for (const ImuClass imu : {ImuClass::kMarine, ImuClass::kAutomotive}) {
    Scene scene = scene_on(square_loop(), 10.0);
    set_imu(scene, "class", imu_class_model(imu, RangeEnd::kMid));
    const Leg shared = tracks.of(scene).leg(51.0, 52.0);
    const Leg alone = error_track(scene).leg(51.0, 52.0);
    CHECK(dense(shared.Phi) == dense(alone.Phi));
  }
}

TEST_CASE("what is scored from early on is followed from then on") {
  Scene scene = scene_on(square_loop(), 20.0, 3600.0);
  scene.gnss.settle_s = 600.0;
  check_against_steps(scene, 1e-7);
}

}  // namespace leeway::sim
