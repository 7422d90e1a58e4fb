/// @file
/// The recent past: what came in, and points in time to come back to, so that a late measurement
/// acts at its own time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "leeway/navigator/aidings.hpp"
#include "leeway/navigator/navigator_state.hpp"
#include "leeway/navigator/ring_buffer.hpp"
#include "leeway/sensors/imu.hpp"

namespace leeway {

/// A measurement, at the time it was valid. Those of one time act in the order of the readings.
struct Event {
  Time time{};
  Reading reading{};
  bool counts{true};  ///< false: the second half of a fix that was cut in two
  bool done{false};   ///< fused up to the newest IMU data
  Verdict verdict{Verdict::kAccepted};
};

/// IMU data over an interval of time, or none of it.
struct Step {
  ImuIncrement inc{};
  bool is_gap{false};
};

/// Runs steps and events through a NavigatorState in the order of their times, whatever the order
/// of their arrival: the state depends on what was measured, not on when it was heard of. Goes back
/// to a checkpoint at most max_lateness_s old; which one costs time, and changes no bit. Allocates
/// at construction only.
class Timeline {
 public:
  /// @throws Error when the configuration is invalid.
  explicit Timeline(const NavigatorConfig& config);

  /// Forgets everything and goes on from here. Events from before are late.
  void restart(const NavigatorState& state, Time now);

  /// @pre step.inc.time is later than every step before and step.inc reaches back to the last one.
  void push(const Step& step);

  /// Takes an event, and if it lies in the past goes back for it.
  /// @returns kAccepted when it waits for IMU data, what became of it when it acted, or why it was
  /// not taken: kLate, kDuplicate, kOverflow. All but kAccepted is in the ledger.
  Verdict push(Event event);

  const NavigatorState& state() const { return state_; }
  const std::optional<Time>& now() const { return now_; }

  /// Verdicts on events, by kind. An event that is judged again counts once, with its last verdict.
  using Ledger = std::array<std::uint64_t, kVerdicts>;
  const Ledger& ledger() const { return ledger_; }

  /// Names what a snapshot needs: the oldest point in time to come back to, and all that came in
  /// since. When read it is run again, which leads to the same bits.
  template <class Archive>
  void visit(Archive& archive) {
    bool has_begun = now_.has_value();
    Checkpoint oldest = has_begun ? checkpoints_.front() : Checkpoint{state_};
    archive(has_begun, oldest.state, oldest.time, oldest.next_step, steps_forgotten_, ledger_,
            steps_, events_);
    if constexpr (Archive::kReads) {
      state_ = oldest.state;
      now_.reset();
      checkpoints_.clear();
      forget_streams();
      if (!has_begun) return;
      checkpoints_.push_back(oldest);
      go_back_to(oldest);
    }
  }

 private:
  struct Checkpoint {
    NavigatorState state;
    Time time{Time::max()};
    std::uint64_t next_step{0};  // counted from the first ever
  };

  /// Measurements of one kind come at a steady pace: where the next late one is expected, and a
  /// checkpoint shortly before it.
  struct Stream {
    Checkpoint before;  // Time::max() when there is none
    Time newest{Time::max()};
    Time next{Time::max()};
  };

  static constexpr double kCheckpointS = 0.25;

  void run(std::size_t step);
  void integrate(const Step& step, Time to, ImuIncrement& rest);
  void decide(Event& event);
  Verdict note(Event& event, Verdict verdict);
  void go_back_to(const Checkpoint& checkpoint);
  const Checkpoint& newest_before(Time t) const;
  bool is_checkpoint_due() const;
  void keep(Checkpoint& checkpoint, std::size_t next_step) const;
  void forget_old();
  void forget_streams();
  void expect_after(const Event& event, bool is_late);
  void make_room();

  NavigatorConfig config_;
  NavigatorState state_;
  RingBuffer<Step> steps_;
  RingBuffer<Event> events_;  // by time, then kind
  RingBuffer<Checkpoint> checkpoints_;
  std::vector<Stream> streams_;  // by the kind of reading; the last of second halves
  std::uint64_t steps_forgotten_{0};
  std::optional<Time> now_{};
  Ledger ledger_{};
};

}  // namespace leeway
