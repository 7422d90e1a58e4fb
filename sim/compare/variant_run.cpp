#include "sim/compare/variant_run.hpp"

#include <ctime>
#include <optional>

#include "leeway/ekf/ekf_config.hpp"
#include "sim/compare/variant_filter.hpp"
#include "sim/trials/player.hpp"

namespace leeway::sim {
namespace {

template <class Filter>
void observe(const Filter& filter, const Estimate& truth, const ScoreObserver& observer) {
  if constexpr (requires { filter.covariance(); }) {
    const ErrorMatrix P = filter.covariance();
    observer(truth, filter.estimate(), &P);
  } else {
    observer(truth, filter.estimate(), nullptr);
  }
}

/// A fix that arrives late acts at its own time: the filter goes back there and comes again.
template <class Filter>
void run(Filter& filter, const RecordedTrial& trial, const ScoreObserver& observer) {
  std::optional<Filter> when_valid;
  play(
      trial.imu.size(), 1, trial.fixes, [&](std::size_t k) { filter.predict(trial.imu[k]); },
      [&](const RecordedTrial::Fix& fix) {
        if (fix.at < fix.arrives) when_valid = filter;
      },
      [&](const RecordedTrial::Fix& fix) {
        if (observer && fix.truth) observe(filter, *fix.truth, observer);
        if (fix.at < fix.arrives) filter = *when_valid;
        filter.update(fix.fix);
        for (std::size_t k = fix.at + 1; k <= fix.arrives; ++k) filter.predict(trial.imu[k]);
      });
}

}  // namespace

double run_variant(const Variant& variant, const EkfConfig& believed, const TrialStart& start,
                   const RecordedTrial& trial, const ScoreObserver& observer) {
  return visit_variant_filter(variant, believed, start, [&](auto filter) {
    const std::clock_t begin = std::clock();
    run(filter, trial, observer);
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  });
}

}  // namespace leeway::sim
