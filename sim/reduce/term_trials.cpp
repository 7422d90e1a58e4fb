#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/reduce/reduction_parts.hpp"

namespace leeway::sim {
namespace {

double empirical_error_m(HorizontalMetric metric, const std::vector<CaseRun>& runs) {
  std::vector<double> radii_m = radial_errors_m(runs);
  if (metric == HorizontalMetric::kR95) return r95_of(std::move(radii_m));
  Eigen::Vector2d sum_sq_m2 = Eigen::Vector2d::Zero();
  for (const CaseRun& run : runs) {
    if (!run.score.finite) continue;
    for (const Eigen::Vector2d& error_m : run.error_ne_m) sum_sq_m2 += error_m.cwiseAbs2();
  }
  sum_sq_m2 /= static_cast<double>(radii_m.size());
  return std::sqrt(metric == HorizontalMetric::kDrms ? sum_sq_m2.sum() : sum_sq_m2.maxCoeff());
}

double difference_m(const std::vector<CaseRun>& runs, const std::vector<CaseRun>& others) {
  double sum_m2 = 0.0;
  std::size_t epochs = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (!runs[k].score.finite || !others[k].score.finite) continue;
    epochs += runs[k].error_ne_m.size();
    for (std::size_t i = 0; i < runs[k].error_ne_m.size(); ++i) {
      sum_m2 += (runs[k].error_ne_m[i] - others[k].error_ne_m[i]).squaredNorm();
    }
  }
  return std::sqrt(sum_m2 / static_cast<double>(epochs));
}

void take_away(TriadErrorModel& triad, bool scales, bool misalignments) {
  // Not zero: a spread that is drawn leaves the random numbers after it as they were.
  constexpr double kNothing = 1e-300;
  if (scales) {
    triad.M.diagonal().setOnes();
    if (triad.scale_sigma > 0.0) triad.scale_sigma = kNothing;
  }
  if (misalignments) {
    triad.M = Eigen::Matrix3d(triad.M.diagonal().asDiagonal());
    if (triad.misalignment_sigma_rad > 0.0) triad.misalignment_sigma_rad = kNothing;
  }
}

}  // namespace

Scene without_sources(Scene scene, const std::vector<ErrorSource>& sources) {
  const auto has = [&sources](ErrorSource source) {
    return std::find(sources.begin(), sources.end(), source) != sources.end();
  };
  take_away(scene.imu.accelerometer, has(ErrorSource::kAccelerometerScale),
            has(ErrorSource::kAccelerometerMisalignment));
  take_away(scene.imu.gyro, has(ErrorSource::kGyroScale), has(ErrorSource::kGyroMisalignment));
  if (has(ErrorSource::kGyroGSensitivity)) {
    scene.imu.G_g_radps_per_mps2.setZero();
    if (scene.imu.G_g_sigma_radps_per_mps2 > 0.0) scene.imu.G_g_sigma_radps_per_mps2 = 1e-300;
  }
  return scene;
}

FilterCase case_of(const TrialPlan& plan, const FilterModel& model) {
  return {&plan,
          {.strapdown = model.config.strapdown,
           .imu_divider = model.imu_divider,
           .covariance_interval_s = model.config.covariance_interval_s,
           .precision = model.precision},
          model.config,
          model.knows_latency};
}

std::vector<MeasuredAccuracy> measured(const std::vector<FilterCase>& cases, int threads,
                                       const std::function<void(double)>& progress) {
  const HorizontalMetric metric = cases.front().plan->scene().limit.metric;
  const auto runs = run_cases(cases, threads, progress);
  std::vector<MeasuredAccuracy> result;
  for (const auto& of_case : runs) {
    result.push_back({empirical_error_m(metric, of_case), difference_m(of_case, runs.front()),
                      figures_of(of_case)});
  }
  return result;
}

ModelCosts model_costs(const TrialPlan& plan, const std::vector<FilterModel>& models, int rounds,
                       const std::function<void(double)>& progress) {
  std::vector<FilterCase> cases;
  for (const FilterModel& model : models) {
    // The first model beside each: what slows the machine slows both.
    cases.push_back(case_of(plan, models.front()));
    cases.push_back(case_of(plan, model));
  }
  const auto times = times_ns_per_s(cases, rounds, progress);
  ModelCosts result;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const std::vector<double>& of_first = times[2 * m];
    const std::vector<double>& of_model = times[2 * m + 1];
    std::vector<double> savings;
    for (std::size_t k = 0; k < of_model.size(); ++k) savings.push_back(of_first[k] - of_model[k]);
    result.costs.push_back(cost_of(of_model));
    result.savings.push_back(cost_of(savings));
  }
  return result;
}

}  // namespace leeway::sim
