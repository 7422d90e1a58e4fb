#include "leeway/navigator/timeline.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace leeway {
namespace {

constexpr std::size_t kMaxEvents = 256;
constexpr std::size_t kStreams = std::variant_size_v<Reading> + 1;

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
      checkpoints_(checkpoint_capacity(config.timing, kCheckpointS), Checkpoint{state_}),
      streams_(kStreams, Stream{Checkpoint{state_}}) {}

void Timeline::restart(const NavigatorState& state, Time now) {
  state_ = state;
  now_ = now;
  steps_forgotten_ += steps_.size();
  steps_.clear();
  checkpoints_.clear();
  keep(checkpoints_.extend(), 0);
  forget_streams();
  while (!events_.empty() && events_.front().time < now) {
    if (!events_.front().done) note(events_.front(), Verdict::kLate);
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
  run(steps_.size() - 1);
  if (!is_checkpoint_due()) return;
  if (checkpoints_.full()) checkpoints_.pop_front();
  keep(checkpoints_.extend(), steps_.size());
  const Duration lateness = duration_from_seconds(config_.timing.max_lateness_s);
  while (checkpoints_.size() > 1 && checkpoints_[1].time < *now_ - lateness) {
    checkpoints_.pop_front();
  }
  forget_old();
}

void Timeline::run(std::size_t step) {
  const auto& [inc, is_gap] = steps_[step];
  // A step early: what is expected may come a little before.
  const Time next_end = inc.time + (inc.time - *now_);
  for (Stream& stream : streams_) {
    if (stream.next > next_end) continue;
    stream.next = Time::max();
    keep(stream.before, step);
  }
  ImuIncrement rest = inc;
  for (std::size_t k = 0; k < events_.size() && events_[k].time <= inc.time; ++k) {
    if (events_[k].done) continue;
    integrate(steps_[step], events_[k].time, rest);
    decide(events_[k]);
  }
  integrate(steps_[step], inc.time, rest);
  now_ = inc.time;
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
  note(event, state_.fuse(event.reading));
  event.done = true;
}

Verdict Timeline::note(Event& event, Verdict verdict) {
  const auto count_of = [this](Verdict v) -> auto& { return ledger_[static_cast<std::size_t>(v)]; };
  if (event.counts && event.verdict != Verdict::kAccepted) --count_of(event.verdict);
  if (event.counts) ++count_of(verdict);
  return event.verdict = verdict;
}

bool Timeline::is_checkpoint_due() const {
  return to_seconds(*now_ - checkpoints_.back().time) >= kCheckpointS;
}

void Timeline::keep(Checkpoint& checkpoint, std::size_t next_step) const {
  checkpoint.state = state_;
  checkpoint.time = *now_;
  checkpoint.next_step = steps_forgotten_ + next_step;
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

void Timeline::forget_streams() {
  for (Stream& s : streams_) s.before.time = s.newest = s.next = Time::max();
}

void Timeline::expect_after(const Event& event, bool is_late) {
  Stream& stream = streams_[event.counts ? event.reading.index() : kStreams - 1];
  // One that waits for IMU data needs no way back.
  stream.next = is_late && event.time > stream.newest ? event.time + (event.time - stream.newest)
                                                      : Time::max();
  stream.newest = event.time;
}

Verdict Timeline::push(Event event) {
  if (events_.full()) make_room();
  const bool within = now_ && event.time <= *now_;
  if (within && (event.time <= checkpoints_.front().time ||
                 to_seconds(*now_ - event.time) > config_.timing.max_lateness_s)) {
    return note(event, Verdict::kLate);
  }
  std::size_t place = 0;
  while (place < events_.size() && !acts_before(event, events_[place])) {
    if (events_[place].time == event.time && same_kind(events_[place], event)) {
      return note(event, Verdict::kDuplicate);
    }
    ++place;
  }
  if (events_.full()) return note(event, Verdict::kOverflow);
  events_.insert(place, event);
  expect_after(event, within);
  if (!within) return Verdict::kAccepted;
  const bool is_last = place + 1 == events_.size() || events_[place + 1].time > *now_;
  if (event.time < *now_ || !is_last) {
    go_back_to(newest_before(event.time));
  } else {
    decide(events_[place]);
    if (checkpoints_.back().time == *now_) checkpoints_.back().state = state_;
  }
  return events_[place].verdict;
}

void Timeline::make_room() {
  while (events_.full() && checkpoints_.size() > 1) {
    checkpoints_.pop_front();
    forget_old();
  }
  if (events_.full() && events_.front().done) restart(state_, *now_);
}

const Timeline::Checkpoint& Timeline::newest_before(Time t) const {
  const Checkpoint* newest = &checkpoints_.front();
  const auto take = [&](const Checkpoint& c) {
    if (c.time < t && c.time > newest->time) newest = &c;
  };
  for (std::size_t k = 1; k < checkpoints_.size(); ++k) take(checkpoints_[k]);
  for (const Stream& stream : streams_) take(stream.before);
  return *newest;
}

void Timeline::go_back_to(const Checkpoint& checkpoint) {
  state_ = checkpoint.state;
  now_ = checkpoint.time;
  const auto first = static_cast<std::size_t>(checkpoint.next_step - steps_forgotten_);
  while (checkpoints_.back().time > *now_) checkpoints_.pop_back();
  for (Stream& stream : streams_) {
    if (stream.before.time > *now_) stream.before.time = Time::max();
  }
  for (std::size_t k = 0; k < events_.size(); ++k) {
    if (events_[k].time > *now_) events_[k].done = false;
  }
  for (std::size_t k = first; k < steps_.size(); ++k) {
    run(k);
    if (is_checkpoint_due() && !checkpoints_.full()) keep(checkpoints_.extend(), k + 1);
  }
}

}  // namespace leeway
