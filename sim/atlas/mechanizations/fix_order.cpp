#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kOrderScoredS = 60.0;

/// A fix, and the increment after which it comes.
struct Delivery {
  std::size_t after{};
  GnssFix fix{};
};

using Deliveries = std::vector<Delivery>;

std::size_t increments_in(double s, const RecordedTrial& trial) {
  return static_cast<std::size_t>(std::llround(s / trial.imu.front().dt_s));
}

Deliveries late_by(double latency_s, const RecordedTrial& trial) {
  Deliveries deliveries;
  for (const RecordedTrial::Fix& fix : trial.fixes) {
    deliveries.push_back({fix.at + increments_in(latency_s, trial), fix.fix});
  }
  return deliveries;
}

/// The later one of each pair first, the earlier one right after it.
Deliveries swapped_pairs(const RecordedTrial& trial) {
  Deliveries deliveries = late_by(0.0, trial);
  for (std::size_t k = 1; k < deliveries.size(); k += 2) {
    std::swap(deliveries[k - 1].fix, deliveries[k].fix);
    deliveries[k - 1].after = deliveries[k].after;
  }
  return deliveries;
}

Deliveries twice(const RecordedTrial& trial) {
  Deliveries deliveries = late_by(0.0, trial);
  for (const Delivery& again : late_by(0.3, trial)) deliveries.push_back(again);
  std::stable_sort(deliveries.begin(), deliveries.end(),
                   [](const Delivery& a, const Delivery& b) { return a.after < b.after; });
  return deliveries;
}

struct Order {
  std::string condition;
  std::function<Deliveries(const RecordedTrial&)> deliveries;
};

std::vector<Order> orders() {
  std::vector<Order> all;
  for (const double latency_s : {0.0, 0.5, 1.5, 3.0}) {
    all.push_back({fmt::format("{:g} s late", latency_s),
                   [latency_s](const RecordedTrial& trial) { return late_by(latency_s, trial); }});
  }
  all.push_back({"in pairs; the later first", swapped_pairs});
  all.push_back({"each twice", twice});
  return all;
}

/// RMS horizontal error at whole seconds, of a filter that gets its fixes like this.
/// @param on_arrival  their times are overwritten by that of the newest IMU data
double delivered_rms_m(WatchedFilter& filter, const RecordedTrial& trial,
                       const Deliveries& deliveries, bool on_arrival) {
  ErrorSums sums;
  auto delivery = deliveries.begin();
  auto epoch = trial.fixes.begin();
  for (std::size_t k = 0; k < trial.imu.size(); ++k) {
    filter.predict(trial.imu[k]);
    if (epoch != trial.fixes.end() && epoch->at == k) {
      if (to_seconds(trial.imu[k].time) > kOrderScoredS) sums.add(*epoch->truth, filter);
      ++epoch;
    }
    for (; delivery != deliveries.end() && delivery->after == k; ++delivery) {
      GnssFix fix = delivery->fix;
      if (on_arrival) fix.time = trial.imu[k].time;
      filter.update(fix);
    }
  }
  return sums.horizontal_rms_m();
}

std::vector<AtlasCell> run_fix_order(const AtlasOptions& options) {
  const Scene scene = town_drive(120.0);
  const auto trials = recorded_trials(scene, options.brief ? 1 : 4);
  return cells_over(orders(), [&](const Order& order) {
    const auto run = [&](const std::vector<AtlasColumn>& columns, bool on_arrival) {
      return scored(columns, scene.filter, trials, order.condition,
                    [&](WatchedFilter& filter, const RecordedTrial& trial) {
                      return delivered_rms_m(filter, trial, order.deliveries(trial), on_arrival);
                    });
    };
    auto cells =
        run({navigator_column(),
             navigator_column("Navigator/waits for 4 s", {.max_lateness_s = 4.0})},
            false);
    append(cells,
           run({ekf_column(AtlasGroup::kNotOffered, "Ekf/fixes used as they arrive")}, true));
    return cells;
  });
}

}  // namespace

AtlasScene fix_order() {
  return {.place = 290,
          .key = "fix-order",
          .title = "Late, duplicate and out-of-order fixes",
          .figure = "RMS horizontal error from a minute on",
          .unit = "m",
          .limits = {5.0, 50.0,
                     "fixes of 2.5 m leave less than five; ten are half a second at 20 m/s, fifty "
                     "a coast without fixes"},
          .run = run_fix_order};
}

}  // namespace leeway::sim::scenes
