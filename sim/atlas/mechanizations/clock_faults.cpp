#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

using std::chrono::hours;
using std::chrono::seconds;

constexpr double kClockScoredFromS = 90.0;
constexpr Duration kWeekLength = hours{7 * 24};
constexpr Time kFaultAt{seconds{30}};

/// Moves times of the IMU and of the fixes.
Spoil moved_times(Time (*imu)(Time), Time (*receiver)(Time)) {
  return [imu, receiver](RecordedTrial& trial) {
    trial.start.estimate.nav.time = imu(trial.start.estimate.nav.time);
    for (ImuIncrement& inc : trial.imu) inc.time = imu(inc.time);
    for (RecordedTrial::Fix& fix : trial.fixes) fix.fix.time = receiver(fix.fix.time);
  };
}

Time same(Time t) { return t; }
Time one_wild(Time t) { return t == kFaultAt ? t + seconds{1000} : t; }
Time hour_ahead(Time t) { return t > kFaultAt ? t + hours{1} : t; }
Time hour_back(Time t) { return t > kFaultAt ? t - hours{1} : t; }
Time leap_seconds_ahead(Time t) { return t + seconds{18}; }
Time leap_seconds_back(Time t) { return t - seconds{18}; }

/// Seconds of week, which begin anew at the fault.
Time rolled(Time t) {
  const Time of_week = t + kWeekLength - kFaultAt.time_since_epoch();
  return of_week.time_since_epoch() >= kWeekLength ? of_week - kWeekLength : of_week;
}

std::vector<SpoiledCondition> faults() {
  return {{"none", moved_times(same, same)},
          {"one IMU time 1000 s ahead", moved_times(one_wild, same)},
          {"all clocks jump an hour ahead", moved_times(hour_ahead, hour_ahead)},
          {"all clocks jump an hour back", moved_times(hour_back, hour_back)},
          {"the week of all rolls over", moved_times(rolled, rolled)},
          {"the receiver's clock 18 s ahead", moved_times(same, leap_seconds_ahead)},
          {"the receiver's clock 18 s behind", moved_times(same, leap_seconds_back)}};
}

/// Takes times for what they say: each sample lasts from the time of the one before to its own.
void trust_times(RecordedTrial& trial) {
  Time before = trial.start.estimate.nav.time;
  for (ImuIncrement& inc : trial.imu) {
    const double scale = to_seconds(inc.time - before) / inc.dt_s;
    before = inc.time;
    inc.dt_s *= scale;
    inc.dtheta_b_rad *= scale;
    inc.dv_b_mps *= scale;
  }
}

std::vector<AtlasCell> run_clock_faults(const AtlasOptions& options) {
  const Scene scene = town_drive(120.0);
  const auto trials = recorded_trials(scene, options.brief ? 1 : 3);
  const Score score = score_after(kClockScoredFromS, &ErrorSums::horizontal_rms_m);
  const AtlasColumn trusting = ekf_column(AtlasGroup::kNotOffered, "Ekf/times trusted");
  return cells_over(faults(), [&](const SpoiledCondition& fault) {
    const auto spoilt = spoiled(trials, fault.spoil);
    auto cells = scored({navigator_column()}, scene.filter, spoilt, fault.condition, score);
    append(cells, scored({trusting}, scene.filter, spoiled(spoilt, trust_times), fault.condition,
                         score));
    return cells;
  });
}

}  // namespace

AtlasScene clock_faults() {
  return {.place = 300,
          .key = "clock",
          .title = "Clocks that jump, and the end of a week",
          .figure = "RMS horizontal error before fixes, from a minute after the fault on",
          .unit = "m",
          .limits =
              {5.0, 50.0,
               "fixes of 2.5 m alone, one second old, leave five; fifty are a coast without fixes"},
          .run = run_clock_faults};
}

}  // namespace leeway::sim::scenes
