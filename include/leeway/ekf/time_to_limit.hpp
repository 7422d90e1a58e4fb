/// @file
/// Run-time leeway: how long a filter can go without another fix.
#pragma once

#include "leeway/ekf/ekf.hpp"
#include "leeway/model/error_metric.hpp"

namespace leeway {

/// Beyond this a filter is not asked to see.
inline constexpr double kLeewayHorizonS = 86400.0;

struct TimeToLimit {
  double time_s{0.0};          ///< from the time of the estimate; at most kLeewayHorizonS
  bool beyond_horizon{false};  ///< the limit is not reached within it
};

/// How long from now, without another fix, until the horizontal position error is beyond the limit
/// with more than 1 - probability, while the vehicle keeps its speed and its rate of turn (the mean
/// of InertialEstimate::mean_omega_ib_b_radps). The first time this happens; where the error grows
/// and shrinks, an excursion shorter than a quarter of a turn, or of a Schuler period, may pass
/// unseen. Within 0.5 % of what this filter would say when it had coasted there.
///
/// 0 when the limit is exceeded already, and when the question has no answer: limit <= 0,
/// probability not between 0 and 1, or either of them, or the filter, not a number. Allocates
/// nothing, throws nothing; same inputs give the same bits. 15 to 35 us and 30 kB of stack
/// (docs/theory/ekf/time_to_limit.md).
TimeToLimit time_to_limit(const Ekf& filter, double limit_m, double probability = 0.95);

/// The same, until the metric passes the limit. The track is that of the present turn; of a vehicle
/// that stands, its forward axis: course_over_ground_rad().
TimeToLimit time_to_limit(const Ekf& filter, double limit_m, ErrorMetric metric);

}  // namespace leeway
