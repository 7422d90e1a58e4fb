/// The nonlinear filter against the covariance analysis, over seeds 1..200: the long runs, in a
/// program of their own.
#include <doctest/doctest.h>

#include <cmath>

#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/trials/campaign.hpp"

namespace leeway::sim {
namespace {

/// reference/README.md, "Correction interval, a defined case", an hour of it.
Scene defined_case(ImuClass imu, double interval_s) {
  Scene scene;
  scene.name = "defined case";
  scene.trajectory = square_loop();
  scene.duration_s = 3600.0;
  set_imu(scene, std::string(name(imu)), imu_class_model(imu, RangeEnd::kMid));
  scene.filter.gnss_correlation_s = 0.0;
  scene.filter.gate_probability = 0.0;  // the case has no outliers
  scene.gnss.interval_s = interval_s;
  return scene;
}

}  // namespace

TEST_CASE("errors and NEES are what the filter claims, as far as an EKF can be consistent" *
          doctest::test_suite("heavy")) {
  struct Case {
    ImuClass imu;
    double interval_s;
    double score_last_s;
  };
  // Of 300 s the last ten fixes: two would leave the RMS of 200 trials a scatter of 3 %.
  for (const Case& c :
       {Case{ImuClass::kTactical, 300.0, 3000.0}, Case{ImuClass::kAutomotive, 1.0, 480.0},
        Case{ImuClass::kAutomotive, 10.0, 480.0}}) {
    const Scene scene = defined_case(c.imu, c.interval_s);
    CampaignOptions options;
    options.score_last_s = c.score_last_s;
    const CampaignResult r = campaign(scene, options);
    MESSAGE(scene.imu_name << ", fixes every " << c.interval_s << " s: RMS/sigma "
                           << r.rms_over_sigma << ", NEES " << r.mean_nees << " in " << r.nees_low
                           << " to " << r.nees_high);
    CHECK(r.rms_over_sigma > 0.95);
    CHECK(r.rms_over_sigma < 1.05);
    CHECK(r.mean_nees > r.nees_low);
    CHECK(r.mean_nees < r.nees_high);
    CHECK(r.diverged == 0);
  }
}

TEST_CASE("errors that the filter does not model are as large as the truth-model analysis says" *
          doctest::test_suite("heavy")) {
  for (const double interval_s : {10.0, 60.0}) {
    Scene scene = defined_case(ImuClass::kTactical, interval_s);
    scene.duration_s = 1800.0;
    for (TriadErrorModel* triad : {&scene.imu.accelerometer, &scene.imu.gyro}) {
      triad->scale_sigma = 1e-3;
      triad->misalignment_sigma_rad = 1e-3;
    }
    scene.gnss.errors.correlated_sigma_n_m = {2.5, 2.5, 3.5};
    scene.gnss.errors.correlation_time_s = 60.0;
    const CovarianceAnalysis linear = analyze(scene, error_track(scene));
    CampaignOptions options;
    options.score_last_s = linear.window_s;
    const CampaignResult r = campaign(scene, options);
    const double ratio = r.rms_horizontal_m / linear.true_drms_m;
    const double optimism = linear.true_drms_m / linear.claimed_drms_m;
    MESSAGE("fixes every " << interval_s << " s: RMS / true " << ratio << ", optimistic by x"
                           << optimism);
    CHECK(ratio > 0.93);
    CHECK(ratio < 1.07);
    CHECK(optimism > 1.04);  // the filter itself claims less
    CHECK(std::abs(r.sigma_horizontal_m / linear.claimed_drms_m - 1.0) < 0.02);
  }
}

}  // namespace leeway::sim
