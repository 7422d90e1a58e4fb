#include <algorithm>
#include <cmath>
#include <utility>

#include "leeway/model/error_metric.hpp"
#include "leeway/sim/tools/quantile.hpp"
#include "sim/reduce/reduction_parts.hpp"

namespace leeway::sim {
namespace {

/// Of north, east and down.
Eigen::Matrix3d second_moment_m2(const std::vector<CaseRun>& runs) {
  Eigen::Matrix3d sum_m2 = Eigen::Matrix3d::Zero();
  double epochs = 0.0;
  for (const CaseRun& run : runs) {
    if (!run.score.finite) continue;
    for (const Eigen::Vector3d& error_m : run.error_n_m) sum_m2 += error_m * error_m.transpose();
    epochs += static_cast<double>(run.error_n_m.size());
  }
  return sum_m2 / epochs;
}

double empirical_error_m(ErrorMetric metric, const std::vector<CaseRun>& runs) {
  const double probability = quantile_probability(metric);
  if (probability > 0.0) return quantile_of(sizes_m(metric, runs), probability);
  return error_size_m(metric, second_moment_m2(runs), 0.0);
}

double difference_m(const std::vector<CaseRun>& runs, const std::vector<CaseRun>& others) {
  double sum_m2 = 0.0;
  std::size_t epochs = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (!runs[k].score.finite || !others[k].score.finite) continue;
    epochs += runs[k].error_n_m.size();
    for (std::size_t i = 0; i < runs[k].error_n_m.size(); ++i) {
      sum_m2 += (runs[k].error_n_m[i] - others[k].error_n_m[i]).head<2>().squaredNorm();
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
  const ErrorMetric metric = cases.front().plan->scene().limit.metric;
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
