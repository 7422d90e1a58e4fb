/// @file
/// Answers of one or several log studies: percentiles of the errors of outages and of thinned
/// fixes, the interval that keeps a limit, measured and expected, with bands.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "leeway/earth/names.hpp"
#include "leeway/sim/replay/log_study.hpp"
#include "leeway/sim/scene/error_limit.hpp"

namespace leeway::sim {

/// A figure with its band: 90 % of it, by resampling blocks of time. NaN: unknown.
struct Banded {
  double value{std::numeric_limits<double>::quiet_NaN()};
  double low{std::numeric_limits<double>::quiet_NaN()};
  double high{std::numeric_limits<double>::quiet_NaN()};
};

/// Percentiles that tables of outages have.
inline constexpr std::array kOutagePercentiles{0.50, 0.68, 0.95};

/// Outages of one duration.
struct OutageAnswer {
  double duration_s{};
  std::size_t outages{0};
  std::array<Banded, kOutagePercentiles.size()> end_h_m{};
  std::array<Banded, kOutagePercentiles.size()> largest_h_m{};
};

/// Errors just before fixes so far apart, by the metric.
struct IntervalErrors {
  double interval_s{};
  std::size_t fixes{0};
  Banded measured_m{};
  double expected_m{std::numeric_limits<double>::quiet_NaN()};
};

/// The interval that keeps a limit.
struct SupportedInterval {
  /// How far a curve over the studied intervals tells it.
  enum class Outcome {
    kFound,
    kShorter,  ///< the shortest interval exceeds the limit: there is none
    kLonger,   ///< the longest with errors keeps it: it is at least this
    kUnknown,  ///< there are no errors
  };
  double limit_m{};
  Outcome measured_outcome{Outcome::kUnknown};
  Banded measured_s{};
  Outcome expected_outcome{Outcome::kUnknown};
  double expected_s{std::numeric_limits<double>::quiet_NaN()};

  /// Above 1 the analysis is too hopeful; NaN unless both are found.
  double expected_over_measured() const;
};
constexpr auto names(SupportedInterval::Outcome) {
  return std::array{"found", "shorter", "longer", "unknown"};
}

struct StudyAnswer {
  std::vector<OutageAnswer> outages{};
  std::vector<IntervalErrors> intervals{};
  std::vector<SupportedInterval> supported{};  ///< one for each limit
};

/// The answer of the studies together, every error counting alike.
/// @param limits_m  ascending or not
/// @pre the studies were made with this one's metric and durations.
StudyAnswer answer_of(std::span<const LogStudy* const> studies, const LogStudyConfig& study,
                      const std::vector<double>& limits_m);

}  // namespace leeway::sim
