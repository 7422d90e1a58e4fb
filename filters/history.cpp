#include "leeway/filters/history.hpp"

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
  if (a.data.index() != b.data.index()) return false;
  const auto* fix_a = std::get_if<GnssFix>(&a.data);
  const auto* fix_b = std::get_if<GnssFix>(&b.data);
  return fix_a == nullptr || (fix_a->position && fix_b->position) ||
         (fix_a->velocity && fix_b->velocity);
}

/// The order in which events act.
bool acts_before(const Event& a, const Event& b) {
  return a.time != b.time ? a.time < b.time : a.data.index() < b.data.index();
}

}  // namespace

History::History(const NavigatorConfig& config)
    : config_(config),
      fusion_(config),
      steps_(step_capacity(config.timing, kCheckpointS), Step{}),
      events_(kMaxEvents, Event{}),
      checkpoints_(checkpoint_capacity(config.timing, kCheckpointS), Checkpoint{fusion_}) {}

void History::restart(const Fusion& fusion, Time now) {
  fusion_ = fusion;
  now_ = now;
  steps_forgotten_ += steps_.size();
  steps_.clear();
  checkpoints_.clear();
  checkpoints_.push_back({fusion_, now, steps_forgotten_});
  while (!events_.empty() && events_.front().time < now) {
    const Event& event = events_.front();
    if (!event.done && event.counts) ++ledger_[static_cast<std::size_t>(Verdict::kLate)];
    events_.pop_front();
  }
}

void History::push(const Step& step) {
  if (!now_) restart(fusion_, step.inc.time - duration_from_seconds(step.inc.dt_s));
  if (steps_.full()) {
    if (checkpoints_.size() > 1) checkpoints_.pop_front();
    forget_old();
  }
  // A checkpoint further back than the room for steps leads nowhere.
  if (steps_.full()) restart(fusion_, *now_);
  steps_.push_back(step);
  run(step);
  keep_checkpoint();
}

void History::run(const Step& step) {
  ImuIncrement rest = step.inc;
  for (std::size_t k = 0; k < events_.size() && events_[k].time <= step.inc.time; ++k) {
    if (events_[k].done) continue;
    integrate(step, events_[k].time, rest);
    decide(events_[k]);
  }
  integrate(step, step.inc.time, rest);
  now_ = step.inc.time;
}

void History::integrate(const Step& step, Time to, ImuIncrement& rest) {
  const Time begin = rest.time - duration_from_seconds(rest.dt_s);
  if (to <= begin || rest.dt_s == 0.0) return;
  ImuIncrement before = rest;
  if (to < rest.time) {
    std::tie(before, rest) = split(rest, to);
  } else {
    rest.dt_s = 0.0;
  }
  step.is_gap ? fusion_.bridge(to) : fusion_.integrate(before);
}

void History::decide(Event& event) {
  const Verdict verdict =
      std::visit([this](const auto& measurement) { return fusion_.fuse(measurement); }, event.data);
  if (event.counts) {
    if (event.verdict != Verdict::kAccepted) {
      --ledger_[static_cast<std::size_t>(event.verdict)];
    }
    ++ledger_[static_cast<std::size_t>(verdict)];
  }
  event.verdict = verdict;
  event.done = true;
}

void History::keep_checkpoint() {
  if (to_seconds(*now_ - checkpoints_.back().time) < kCheckpointS) return;
  if (checkpoints_.full()) checkpoints_.pop_front();
  checkpoints_.push_back({fusion_, *now_, steps_forgotten_ + steps_.size()});
  const Duration lateness = duration_from_seconds(config_.timing.max_lateness_s);
  while (checkpoints_.size() > 1 && checkpoints_[1].time < *now_ - lateness) {
    checkpoints_.pop_front();
  }
  forget_old();
}

void History::forget_old() {
  const Checkpoint& oldest = checkpoints_.front();
  while (!steps_.empty() && steps_forgotten_ < oldest.next_step) {
    steps_.pop_front();
    ++steps_forgotten_;
  }
  while (!events_.empty() && events_.front().done && events_.front().time <= oldest.time) {
    events_.pop_front();
  }
}

History::Place History::push(const Event& event) {
  if (events_.full()) make_room();
  const bool within = now_ && event.time <= *now_;
  if (within && (event.time <= checkpoints_.front().time ||
                 to_seconds(*now_ - event.time) > config_.timing.max_lateness_s)) {
    return Place::kLate;
  }
  std::size_t place = 0;
  while (place < events_.size() && !acts_before(event, events_[place])) {
    if (events_[place].time == event.time && same_kind(events_[place], event)) {
      return Place::kDuplicate;
    }
    ++place;
  }
  if (events_.full()) return Place::kFull;
  events_.insert(place, event);
  if (!within) return Place::kAhead;
  std::size_t checkpoint = checkpoints_.size() - 1;
  while (checkpoints_[checkpoint].time >= event.time) --checkpoint;
  rewind(checkpoint);
  return Place::kWithin;
}

void History::make_room() {
  while (events_.full() && checkpoints_.size() > 1) {
    checkpoints_.pop_front();
    forget_old();
  }
  if (events_.full() && events_.front().done) restart(fusion_, *now_);
}

void History::rewind(std::size_t checkpoint) {
  while (checkpoints_.size() > checkpoint + 1) checkpoints_.pop_back();
  const Checkpoint& from = checkpoints_.back();
  fusion_ = from.fusion;
  now_ = from.time;
  for (std::size_t k = 0; k < events_.size(); ++k) {
    if (events_[k].time > from.time) events_[k].done = false;
  }
  const std::size_t first = static_cast<std::size_t>(from.next_step - steps_forgotten_);
  for (std::size_t k = first; k < steps_.size(); ++k) {
    run(steps_[k]);
    if (to_seconds(*now_ - checkpoints_.back().time) >= kCheckpointS && !checkpoints_.full()) {
      checkpoints_.push_back({fusion_, *now_, steps_forgotten_ + k + 1});
    }
  }
}

Verdict History::verdict(const Event& event) const {
  for (std::size_t k = 0; k < events_.size(); ++k) {
    if (events_[k].time == event.time && same_kind(events_[k], event)) return events_[k].verdict;
  }
  return Verdict::kLate;
}

}  // namespace leeway
