#include "leeway/sim/trials/drift.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/sim/tools/parallel.hpp"
#include "leeway/sim/tools/random.hpp"
#include "leeway/strapdown/strapdown.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway::sim {
namespace {

constexpr double kTableTimeS = 100.0;
constexpr double kTableErrorM = 100.0;

struct PaperCell {
  double error_100s_m;
  double time_to_100m_s;
};

// [seed Table 2], in the order of kAll<ImuClass>
constexpr std::array<PaperCell, 5> kTable2{
    {{0.9, 980.0}, {3.1, 580.0}, {10.2, 325.0}, {87.3, 110.0}, {867.7, 35.0}}};

void validate(const DriftConfig& c) {
  require("drift", "latitude_deg", c.latitude_deg, between(-90.0, 90.0));
  require("drift", "imu_rate_hz", c.imu_rate_hz, between(1.0, 1000.0));
  require("drift", "trials", c.trials, between(2.0, 1e6));
  require("drift", "max_time_s", c.max_time_s,
          {.low = kTableTimeS, .high = 1e5, .above_low = true});
}

/// A vehicle at rest: the start and the true increment, the same at every step.
struct Rest {
  NavState start;
  ImuIncrement increment;
  std::int64_t steps_per_s;

  explicit Rest(const DriftConfig& c) : steps_per_s(std::llround(c.imu_rate_hz)) {
    StaticParameters parameters;
    parameters.origin = {c.latitude_deg * kRadPerDeg, 0.0, 0.0};
    parameters.duration_s = 1.0;
    const Trajectory trajectory = static_trajectory(parameters);
    start = truth_at(trajectory, 0.0).nav;
    increment = true_increment(trajectory, 0.0, 1.0 / static_cast<double>(steps_per_s));
  }
};

/// One free-inertial run, advanced a second at a time.
template <Scheme scheme>
class Run {
 public:
  Run(const Rest& rest, const ImuErrorModel& model, const Random& random)
      : rest_(&rest), state_(rest.start), sensor_(model, random) {}

  /// @returns the 3-D position error at the end of the second, m.
  double advance_second() {
    ImuIncrement inc = rest_->increment;
    const Duration dt = duration_from_seconds(inc.dt_s);
    for (std::int64_t i = 0; i < rest_->steps_per_s; ++i) {
      inc.time = state_.time + dt;
      strapdown_step<scheme>(state_, sensor_.measure(inc), history_);
    }
    return (state_.r_e_m - rest_->start.r_e_m).norm();
  }

 private:
  const Rest* rest_;
  NavState state_;
  ImuHistory history_{};
  ImuErrorSimulator sensor_;
};

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Linear between order statistics. @pre sorted, not empty.
double percentile(const std::vector<double>& sorted, double fraction) {
  const double position = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

template <Scheme scheme>
void follow(std::vector<Run<scheme>>& runs, double max_time_s, DriftCurve& curve) {
  std::vector<double> errors(runs.size());
  const auto add_point = [&curve, &errors](double t_s) {
    std::sort(errors.begin(), errors.end());
    curve.t_s.push_back(t_s);
    curve.error_m.push_back(root_mean_square(errors));
    curve.p2_5_m.push_back(percentile(errors, 0.025));
    curve.p97_5_m.push_back(percentile(errors, 0.975));
  };
  add_point(0.0);
  for (double t_s = 1.0; t_s <= max_time_s; t_s += 1.0) {
    std::transform(runs.begin(), runs.end(), errors.begin(),
                   [](Run<scheme>& run) { return run.advance_second(); });
    add_point(t_s);
    if (t_s >= kTableTimeS && curve.error_m.back() >= kTableErrorM) break;
  }
}

DriftCurve paper_assumptions(const Rest& rest, ImuClass imu, double max_time_s) {
  ImuErrorModel model;
  model.accelerometer.bias.setConstant(
      imu_class_model(imu, RangeEnd::kLow).accelerometer.bias_sigma);
  std::vector<Run<Scheme::kExplicitEuler>> run{{rest, model, Random(0)}};
  DriftCurve curve{imu, RangeEnd::kLow, DriftReading::kPaperAssumptions};
  follow(run, max_time_s, curve);
  return curve;
}

DriftCurve complete(const Rest& rest, ImuClass imu, RangeEnd range, const DriftConfig& c) {
  const ImuErrorModel model = imu_class_model(imu, range);
  std::vector<Run<Scheme::kTwoSample>> runs;
  for (int trial = 0; trial < c.trials; ++trial) {
    runs.emplace_back(rest, model, Random(c.seed, static_cast<std::uint32_t>(trial), kImuStream));
  }
  DriftCurve curve{imu, range, DriftReading::kComplete};
  follow(runs, c.max_time_s, curve);
  return curve;
}

double time_to(double error_m, const DriftCurve& curve) {
  for (std::size_t k = 1; k < curve.t_s.size(); ++k) {
    if (curve.error_m[k] < error_m) continue;
    const double step_m = curve.error_m[k] - curve.error_m[k - 1];
    return curve.t_s[k] - (curve.error_m[k] - error_m) / step_m;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

DriftRow row_of(const DriftCurve& curve) {
  const auto at = static_cast<std::size_t>(kTableTimeS);
  return {curve.imu,
          curve.range,
          curve.reading,
          curve.error_m[at],
          curve.p2_5_m[at],
          curve.p97_5_m[at],
          time_to(kTableErrorM, curve)};
}

}  // namespace

DriftStudy drift_study(const DriftConfig& config,
                       const std::function<void(double fraction)>& progress) {
  validate(config);
  const Rest rest(config);
  constexpr std::size_t kCurvesPerClass = 1 + kAll<RangeEnd>.size();
  DriftStudy study;
  study.curves.resize(kAll<ImuClass>.size() * kCurvesPerClass);
  const std::size_t count = study.curves.size();
  parallel_for(
      count,
      [&](std::size_t k) {
        const ImuClass imu = kAll<ImuClass>[k / kCurvesPerClass];
        const std::size_t which = k % kCurvesPerClass;
        study.curves[k] = which == 0 ? paper_assumptions(rest, imu, config.max_time_s)
                                     : complete(rest, imu, kAll<RangeEnd>[which - 1], config);
      },
      [&](std::size_t finished) {
        if (progress) progress(static_cast<double>(finished) / static_cast<double>(count));
      });
  for (std::size_t k = 0; k < count; ++k) {
    if (k % kCurvesPerClass == 0) {
      const PaperCell& cell = kTable2[k / kCurvesPerClass];
      study.rows.push_back({study.curves[k].imu, RangeEnd::kLow, DriftReading::kPaper,
                            cell.error_100s_m, cell.error_100s_m, cell.error_100s_m,
                            cell.time_to_100m_s});
    }
    study.rows.push_back(row_of(study.curves[k]));
  }
  return study;
}

}  // namespace leeway::sim
