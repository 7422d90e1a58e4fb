#include "sim/replay/log_survey.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/sim/tools/quantile.hpp"

namespace leeway::sim {
namespace {

constexpr double kSurveyRateHz = 10.0;
constexpr double kMedian = 0.5;

/// Standard deviations that a receiver claims: per horizontal axis and down.
struct ClaimedSigmas {
  std::vector<double> horizontal{};
  std::vector<double> down{};

  void add(const Eigen::Matrix3d& R_e, const Eigen::Matrix3d& C_en) {
    const Eigen::Vector3d variance = (C_en.transpose() * R_e * C_en).diagonal();
    horizontal.push_back(std::sqrt(0.5 * variance.head<2>().sum()));
    down.push_back(std::sqrt(variance.z()));
  }
};

/// Times of the fixes and what they claim, from the log alone.
void read_fixes(const ReplayInput& input, LogSurvey& survey) {
  GnssLogReader gnss(input.gnss, input.gnss_options);
  ClaimedSigmas position;
  ClaimedSigmas velocity;
  std::vector<double> intervals_s;
  while (const auto fix = gnss.next()) {
    if (!fix->position) continue;
    const double t_s = to_seconds(fix->time);
    if (!survey.fixes_s.empty()) intervals_s.push_back(t_s - survey.fixes_s.back());
    survey.fixes_s.push_back(t_s);
    const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(fix->position->r_e_m));
    position.add(fix->position->R_e_m2, C_en);
    if (fix->velocity) velocity.add(fix->velocity->R_e_m2ps2, C_en);
  }
  survey.receiver.interval_s = quantile_of(intervals_s, kMedian);
  survey.receiver.sigma_h_m = quantile_of(position.horizontal, kMedian);
  survey.receiver.sigma_v_m = quantile_of(position.down, kMedian);
  survey.receiver.sigma_h_mps = quantile_of(velocity.horizontal, kMedian);
  survey.receiver.sigma_v_mps = quantile_of(velocity.down, kMedian);
}

}  // namespace

LogSurvey survey_log(const ReplayInput& input, const NavigatorConfig& config) {
  LogSurvey survey;
  read_fixes(input, survey);
  ReplayInput plain = input;
  plain.outages.clear();
  plain.thinnings.clear();
  plain.solution.clear();
  plain.solution_rate_hz = kSurveyRateHz;
  ReplayObserver observer;
  observer.epoch = [&](const Solution& s, const std::optional<TruthRecord>&) {
    survey.solution.push_back(s);
  };
  std::vector<double> position_scales;
  std::vector<double> velocity_scales;
  std::vector<double> imu_scales;
  observer.health = [&](const Health& health) {
    survey.at_rest.push_back(health.at_rest);
    position_scales.push_back(health.position_sigma_scale);
    velocity_scales.push_back(health.velocity_sigma_scale);
    imu_scales.push_back(health.imu_sigma_scale);
  };
  survey.result = replay(plain, config, observer);
  if (!survey.result.has_solution) return survey;
  survey.imu_sigma_scale = quantile_of(imu_scales, kMedian);
  LogReceiver& receiver = survey.receiver;
  receiver.position_scale = quantile_of(position_scales, kMedian);
  receiver.velocity_scale = quantile_of(velocity_scales, kMedian);
  receiver.sigma_h_m *= receiver.position_scale;
  receiver.sigma_v_m *= receiver.position_scale;
  receiver.sigma_h_mps *= receiver.velocity_scale;
  receiver.sigma_v_mps *= receiver.velocity_scale;
  return survey;
}

double speed_at(const LogSurvey& survey, double t_s) {
  const auto after =
      std::upper_bound(survey.solution.begin(), survey.solution.end(), time_from_seconds(t_s),
                       [](Time t, const Solution& s) { return t < s.nav.time; });
  return after == survey.solution.begin() ? 0.0 : std::prev(after)->nav.v_e_mps.norm();
}

}  // namespace leeway::sim
