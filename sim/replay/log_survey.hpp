/// @file
/// The first look at a log: the solution with all its fixes, and what the fixes are like.
#pragma once

#include <vector>

#include "leeway/sim/replay/log_study.hpp"
#include "leeway/strapdown/nav_state.hpp"

namespace leeway::sim {

/// The fused motion and what the logs told on the way.
struct LogSurvey {
  std::vector<Solution> solution{};  ///< ten times a second
  std::vector<bool> at_rest{};       ///< of each, by the navigator's detector
  std::vector<double> fixes_s{};     ///< times of the fixes with a position
  LogReceiver receiver{};
  double imu_sigma_scale{1.0};  ///< median
  ReplayResult result{};
};

LogSurvey survey_log(const ReplayInput& input, const NavigatorConfig& config);

/// Speed in m/s at a time, of the last solution until then; 0 before the first.
double speed_at(const LogSurvey& survey, double t_s);

}  // namespace leeway::sim
