#include "leeway/navigator/timeline.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace leeway {
namespace {

constexpr std::size_t kMaxEvents = 256;

std::size_t step_capacity(const TimingConfig& timing, double checkpoint_s) {
  return static_cast<std::size_t>(
      std::ceil((timing.max_lateness_s + 2.0 * checkpoint_s) * timing.max_imu_rate_hz));
}

std::size_t checkpoint_capacity(const TimingConfig& timing, double checkpoint_s) {
  return static_cast<std::size_t>(std::ceil(timing.max_lateness_s / checkpoint_s)) + 2;
}

bool same_kind(const Event& a, const Event& b) {
  if (a.reading.index() != b.reading.index()) return false;
  const auto* fix_a = std::get_if<GnssFix>(&a.reading);
  const auto* fix_b = std::get_if<GnssFix>(&b.reading);
  return fix_a == nullptr || (fix_a->position && fix_b->position) ||
         (fix_a->velocity && fix_b->velocity);
}

/// The order in which events act.
bool acts_before(const Event& a, const Event& b) {
  return a.time != b.time ? a.time < b.time : a.reading.index() < b.reading.index();
}

}  // namespace

Timeline::Timeline(const NavigatorConfig& config)
    : config_(config),
      state_(config),
      steps_(step_capacity(config.timing, kCheckpointS), Step{}),
      events_(kMaxEvents, Event{}),
      checkpoints_(checkpoint_capacity(config.timing, kCheckpointS), Checkpoint{state_}) {}

void Timeline::restart(const NavigatorState& state, Time now) {
  state_ = state;
  now_ = now;
  steps_forgotten_ += steps_.size();
  steps_.clear();
  checkpoints_.clear();
  checkpoints_.push_back({state_, now, steps_forgotten_});
  while (!events_.empty() && events_.front().time < now) {
    const Event& event = events_.front();
    if (!event.done) refuse(event, Verdict::kLate);
    events_.pop_front();
  }
}

void Timeline::push(const Step& step) {
  if (!now_) restart(state_, step.inc.time - duration_from_seconds(step.inc.dt_s));
  if (steps_.full()) {
    if (checkpoints_.size() > 1) checkpoints_.pop_front();
    forget_old();
  }
  // A checkpoint further back than the room for steps leads nowhere.
  if (steps_.full()) restart(state_, *now_);
  steps_.push_back(step);
  run(step);
  keep_checkpoint();
}

void Timeline::run(const Step& step) {
  ImuIncrement rest = step.inc;
  for (std::size_t k = 0; k < events_.size() && events_[k].time <= step.inc.time; ++k) {
    if (events_[k].done) continue;
    integrate(step, events_[k].time, rest);
    decide(events_[k]);
  }
  integrate(step, step.inc.time, rest);
  now_ = step.inc.time;
}

void Timeline::integrate(const Step& step, Time to, ImuIncrement& rest) {
  const Time begin = rest.time - duration_from_seconds(rest.dt_s);
  if (to <= begin || rest.dt_s == 0.0) return;
  ImuIncrement before = rest;
  if (to < rest.time) {
    std::tie(before, rest) = split(rest, to);
  } else {
    rest.dt_s = 0.0;
  }
  step.is_gap ? state_.bridge(to) : state_.integrate(before);
}

void Timeline::decide(Event& event) {
  const Verdict verdict = state_.fuse(event.reading);
  if (event.counts) {
    if (event.verdict != Verdict::kAccepted) {
      --ledger_[static_cast<std::size_t>(event.verdict)];
    }
    ++ledger_[static_cast<std::size_t>(verdict)];
  }
  event.verdict = verdict;
  event.done = true;
}

Verdict Timeline::refuse(const Event& event, Verdict verdict) {
  if (event.counts) ++ledger_[static_cast<std::size_t>(verdict)];
  return verdict;
}

bool Timeline::is_checkpoint_due() const {
  return to_seconds(*now_ - checkpoints_.back().time) >= kCheckpointS;
}

void Timeline::keep_checkpoint() {
  if (!is_checkpoint_due()) return;
  if (checkpoints_.full()) checkpoints_.pop_front();
  checkpoints_.push_back({state_, *now_, steps_forgotten_ + steps_.size()});
  const Duration lateness = duration_from_seconds(config_.timing.max_lateness_s);
  while (checkpoints_.size() > 1 && checkpoints_[1].time < *now_ - lateness) {
    checkpoints_.pop_front();
  }
  forget_old();
}

void Timeline::forget_old() {
  const Checkpoint& oldest = checkpoints_.front();
  while (!steps_.empty() && steps_forgotten_ < oldest.next_step) {
    steps_.pop_front();
    ++steps_forgotten_;
  }
  while (!events_.empty() && events_.front().done && events_.front().time <= oldest.time) {
    events_.pop_front();
  }
}

Verdict Timeline::push(const Event& event) {
  if (events_.full()) make_room();
  const bool within = now_ && event.time <= *now_;
  if (within && (event.time <= checkpoints_.front().time ||
                 to_seconds(*now_ - event.time) > config_.timing.max_lateness_s)) {
    return refuse(event, Verdict::kLate);
  }
  std::size_t place = 0;
  while (place < events_.size() && !acts_before(event, events_[place])) {
    if (events_[place].time == event.time && same_kind(events_[place], event)) {
      return refuse(event, Verdict::kDuplicate);
    }
    ++place;
  }
  if (events_.full()) return refuse(event, Verdict::kOverflow);
  events_.insert(place, event);
  if (!within) return Verdict::kAccepted;
  std::size_t checkpoint = checkpoints_.size() - 1;
  while (checkpoints_[checkpoint].time >= event.time) --checkpoint;
  rewind(checkpoint);
  return events_[place].verdict;
}

void Timeline::make_room() {
  while (events_.full() && checkpoints_.size() > 1) {
    checkpoints_.pop_front();
    forget_old();
  }
  if (events_.full() && events_.front().done) restart(state_, *now_);
}

void Timeline::rewind(std::size_t checkpoint) {
  while (checkpoints_.size() > checkpoint + 1) checkpoints_.pop_back();
  const Checkpoint& from = checkpoints_.back();
  state_ = from.state;
  now_ = from.time;
  for (std::size_t k = 0; k < events_.size(); ++k) {
    if (events_[k].time > from.time) events_[k].done = false;
  }
  const std::size_t first = static_cast<std::size_t>(from.next_step - steps_forgotten_);
  for (std::size_t k = first; k < steps_.size(); ++k) {
    run(steps_[k]);
    if (is_checkpoint_due() && !checkpoints_.full()) {
      checkpoints_.push_back({state_, *now_, steps_forgotten_ + k + 1});
    }
  }
}

}  // namespace leeway
