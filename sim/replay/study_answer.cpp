#include "leeway/sim/replay/study_answer.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/model/horizontal.hpp"
#include "sim/replay/block_bootstrap.hpp"

namespace leeway::sim {
namespace {

using Outcome = SupportedInterval::Outcome;

constexpr double kNoSize = std::numeric_limits<double>::quiet_NaN();
/// Errors of a fix last this long even where fixes are close: as long as those of receivers do.
constexpr double kShortestBlockS = 60.0;
/// Fewer errors than this at an interval tell no percentile.
constexpr std::size_t kFewestErrors = 20;

/// Twice as long as errors overlap, so that most neighbours share a block.
double block_s(double overlap_s) { return std::max(2.0 * overlap_s, kShortestBlockS); }

using BlockValues = std::vector<BlockValue>;

void sort(BlockValues& values) {
  std::sort(values.begin(), values.end(),
            [](const BlockValue& a, const BlockValue& b) { return a.value < b.value; });
}

Banded percentile(std::size_t blocks, const BlockValues& sorted, double probability) {
  return banded(
      blocks, [&](const BlockCounts& counts) { return quantile_of(sorted, counts, probability); });
}

OutageAnswer outage_answer(std::span<const LogStudy* const> studies, double duration_s) {
  Blocks blocks(block_s(duration_s));
  BlockValues ends;
  BlockValues largest;
  for (const LogStudy* study : studies) {
    blocks.begin(study->settled_s, study->last_s);
    for (const OutageError& error : study->outages) {
      if (error.duration_s != duration_s) continue;
      const std::uint32_t block = blocks.block_at(error.start_s);
      ends.push_back({error.end_h_m, block});
      largest.push_back({error.largest_h_m, block});
    }
  }
  sort(ends);
  sort(largest);
  OutageAnswer answer{duration_s, ends.size()};
  for (std::size_t p = 0; p < kOutagePercentiles.size(); ++p) {
    answer.end_h_m[p] = percentile(blocks.count(), ends, kOutagePercentiles[p]);
    answer.largest_h_m[p] = percentile(blocks.count(), largest, kOutagePercentiles[p]);
  }
  return answer;
}

/// Errors before thinned fixes by interval, sorted, in blocks that suit an interval.
struct ErrorsByInterval {
  std::size_t blocks{};
  std::array<BlockValues, kStudiedIntervalsS.size()> values{};
};

ErrorsByInterval errors_by_interval(std::span<const LogStudy* const> studies, double overlap_s) {
  ErrorsByInterval errors;
  Blocks blocks(block_s(overlap_s));
  for (const LogStudy* study : studies) {
    blocks.begin(study->settled_s, study->last_s);
    for (const FixError& e : study->errors) {
      errors.values[e.interval].push_back({e.size_m, blocks.block_at(e.t_s)});
    }
  }
  for (BlockValues& values : errors.values) sort(values);
  errors.blocks = blocks.count();
  return errors;
}

double size_of(ErrorMetric metric, const BlockValues& sorted, const BlockCounts& counts) {
  if (sorted.size() < kFewestErrors) return kNoSize;
  const double probability = quantile_probability(metric);
  return probability > 0.0 ? quantile_of(sorted, counts, probability) : rms_of(sorted, counts);
}

using PairsOfVariances = std::vector<std::array<double, 2>>;

/// The radius that so great a share of errors with these variances stays within.
double radius_m(const PairsOfVariances& variances_m2, double probability) {
  const auto beyond = [&](double radius) {
    double sum = 0.0;
    for (const auto& [a, b] : variances_m2) {
      sum += probability_beyond(Eigen::Vector2d(a, b).asDiagonal(), radius);
    }
    return sum / static_cast<double>(variances_m2.size()) > 1.0 - probability;
  };
  double below = 0.0;
  double above = 1e-3;
  while (beyond(above) && above < 1e9) above *= 2.0;
  for (int k = 0; k < 30; ++k) {
    const double middle = 0.5 * (below + above);
    (beyond(middle) ? below : above) = middle;
  }
  return above;
}

double expected_size_m(ErrorMetric metric, const PairsOfVariances& variances_m2) {
  if (variances_m2.size() < kFewestErrors) return kNoSize;
  const double probability = quantile_probability(metric);
  if (probability > 0.0) return radius_m(variances_m2, probability);
  double sum_m2 = 0.0;
  for (const auto& [a, b] : variances_m2) sum_m2 += a + b;
  return std::sqrt(sum_m2 / static_cast<double>(variances_m2.size()));
}

struct Crossing {
  Outcome outcome{Outcome::kUnknown};
  double interval_s{kNoSize};
};

/// Where errors over the studied intervals first exceed a limit: between two of them in logarithms,
/// as errors grow with a power of the interval. Intervals without errors are left out.
Crossing crossing_of(const std::array<double, kStudiedIntervalsS.size()>& sizes_m, double limit_m) {
  Crossing crossing;
  double before_m = 0.0;
  for (std::size_t k = 0; k < sizes_m.size(); ++k) {
    if (std::isnan(sizes_m[k])) continue;
    const double here_s = kStudiedIntervalsS[k];
    if (sizes_m[k] > limit_m) {
      if (crossing.outcome == Outcome::kUnknown) return {Outcome::kShorter, here_s};
      const double part = std::log(limit_m / before_m) / std::log(sizes_m[k] / before_m);
      return {Outcome::kFound, crossing.interval_s * std::pow(here_s / crossing.interval_s, part)};
    }
    crossing = {Outcome::kLonger, here_s};
    before_m = std::max(sizes_m[k], 1e-6);
  }
  return crossing;
}

std::array<double, kStudiedIntervalsS.size()> sizes_of(ErrorMetric metric,
                                                       const ErrorsByInterval& errors,
                                                       const BlockCounts& counts) {
  std::array<double, kStudiedIntervalsS.size()> sizes_m{};
  for (std::size_t k = 0; k < sizes_m.size(); ++k) {
    sizes_m[k] = size_of(metric, errors.values[k], counts);
  }
  return sizes_m;
}

SupportedInterval supported(std::span<const LogStudy* const> studies, ErrorMetric metric,
                            const std::array<double, kStudiedIntervalsS.size()>& expected_m,
                            double limit_m) {
  SupportedInterval answer{.limit_m = limit_m};
  // The blocks must suit the interval that is asked for.
  ErrorsByInterval errors = errors_by_interval(studies, 0.0);
  const Crossing measured = crossing_of(sizes_of(metric, errors, {}), limit_m);
  answer.measured_outcome = measured.outcome;
  if (measured.outcome != Outcome::kUnknown) {
    errors = errors_by_interval(studies, measured.interval_s);
    answer.measured_s = banded(errors.blocks, [&](const BlockCounts& counts) {
      return crossing_of(sizes_of(metric, errors, counts), limit_m).interval_s;
    });
  }
  const Crossing expected = crossing_of(expected_m, limit_m);
  answer.expected_outcome = expected.outcome;
  answer.expected_s = expected.interval_s;
  return answer;
}

IntervalErrors interval_errors(std::span<const LogStudy* const> studies, ErrorMetric metric,
                               std::size_t interval) {
  const ErrorsByInterval errors = errors_by_interval(studies, kStudiedIntervalsS[interval]);
  IntervalErrors answer{.interval_s = kStudiedIntervalsS[interval]};
  answer.fixes = errors.values[interval].size();
  answer.measured_m = banded(errors.blocks, [&](const BlockCounts& counts) {
    return size_of(metric, errors.values[interval], counts);
  });
  PairsOfVariances variances_m2;
  for (const LogStudy* study : studies) {
    for (const ExpectedFixError& e : study->expected) {
      if (e.interval == interval) variances_m2.push_back(e.variances_m2);
    }
  }
  answer.expected_m = expected_size_m(metric, variances_m2);
  return answer;
}

}  // namespace

double SupportedInterval::expected_over_measured() const {
  if (measured_outcome != Outcome::kFound || expected_outcome != Outcome::kFound) return kNoSize;
  return expected_s / measured_s.value;
}

StudyAnswer answer_of(std::span<const LogStudy* const> studies, const LogStudyConfig& study,
                      const std::vector<double>& limits_m) {
  StudyAnswer answer;
  for (const double duration_s : study.durations_s) {
    answer.outages.push_back(outage_answer(studies, duration_s));
  }
  std::array<double, kStudiedIntervalsS.size()> expected_m{};
  for (std::size_t k = 0; k < kStudiedIntervalsS.size(); ++k) {
    answer.intervals.push_back(interval_errors(studies, study.metric, k));
    expected_m[k] = answer.intervals.back().expected_m;
  }
  for (const double limit_m : limits_m) {
    answer.supported.push_back(supported(studies, study.metric, expected_m, limit_m));
  }
  return answer;
}

}  // namespace leeway::sim
