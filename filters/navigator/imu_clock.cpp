#include "leeway/navigator/imu_clock.hpp"

namespace leeway {
namespace {

constexpr Duration kWeek = std::chrono::hours{7 * 24};
constexpr int kBelieved = 5;

Duration distance(Time a, Time b) { return a > b ? a - b : b - a; }

}  // namespace

ImuClock::ImuClock(double max_jump_s, double max_gap_s)
    : max_jump_(duration_from_seconds(max_jump_s)), max_gap_(duration_from_seconds(max_gap_s)) {}

Time ImuClock::counted_on(Time t) const {
  t += weeks_;
  if (!newest_) return t;
  for (const Time other : {t + kWeek, t - kWeek}) {
    if (distance(other, *newest_) <= max_jump_) return other;
  }
  return t;
}

Verdict ImuClock::judge(Time t) {
  const Time on_line = counted_on(t);
  if (!newest_) {
    newest_ = on_line;
    return Verdict::kAccepted;
  }
  if (on_line == *newest_) return Verdict::kDuplicate;
  const bool ahead = on_line > *newest_;
  const bool on_time = ahead && on_line - *newest_ <= max_gap_;
  const bool after_gap =
      ahead && on_line - *newest_ <= max_jump_ && doubted_ && on_line > *doubted_;
  if (on_time || after_gap) {
    weeks_ = on_line - t;
    set(on_line);
    return Verdict::kAccepted;
  }
  const bool in_a_row = doubted_ && on_line > *doubted_ && on_line - *doubted_ <= max_gap_;
  doubted_in_a_row_ = in_a_row ? doubted_in_a_row_ + 1 : 1;
  doubted_ = on_line;
  if (doubted_in_a_row_ < kBelieved) return ahead ? Verdict::kFuture : Verdict::kOutOfOrder;
  set(on_line);
  return Verdict::kClockJump;
}

void ImuClock::set(Time newest) {
  newest_ = newest;
  doubted_.reset();
  doubted_in_a_row_ = 0;
}

}  // namespace leeway
