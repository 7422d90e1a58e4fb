#include "sim/inspect/record_times.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "leeway/sim/tools/quantile.hpp"

namespace leeway::sim {
namespace {

constexpr double kSessionGapS = 60.0;

}  // namespace

void RecordTimes::add(Time t) {
  if (figures_.records++ == 0) figures_.first_s = to_seconds(t);
  figures_.last_s = to_seconds(t);
  const std::optional<Time> before = std::exchange(last_, t);
  if (!before) return;
  const double step_s = to_seconds(t - *before);
  if (is_decided_) return judge(step_s);
  first_steps_s_.push_back(step_s);
  if (first_steps_s_.size() == kJudged) decide();
}

void RecordTimes::decide() {
  const std::vector<double> steps_s = std::exchange(first_steps_s_, {});
  if (steps_s.empty()) return;
  figures_.step_s = quantile_of(steps_s, 0.5);
  is_decided_ = true;
  for (const double step_s : steps_s) judge(step_s);
}

void RecordTimes::judge(double step_s) {
  const double usual_s = figures_.step_s;
  if (step_s > std::max(kSessionGapS, 10.0 * usual_s)) ++figures_.sessions;
  if (step_s > 1.5 * usual_s) {
    ++figures_.gaps;
    figures_.longest_gap_s = std::max(figures_.longest_gap_s, step_s);
  } else if (step_s < 0.5 * usual_s) {
    ++figures_.bursts;
  } else {
    ++regular_;
    square_sum_s2_ += (step_s - usual_s) * (step_s - usual_s);
  }
}

TimeFigures RecordTimes::figures() const {
  RecordTimes whole = *this;
  if (!whole.is_decided_) whole.decide();
  TimeFigures f = whole.figures_;
  if (whole.regular_ > 0) {
    f.jitter_s = std::sqrt(whole.square_sum_s2_ / static_cast<double>(whole.regular_));
  }
  return f;
}

}  // namespace leeway::sim
