#include "sim/compare/variant_run.hpp"

#include <optional>
#include <utility>

#include "sim/compare/variant_filter.hpp"
#include "sim/trials/player.hpp"

namespace leeway::sim {
namespace {

template <class Filter>
void observe(const Filter& filter, const Estimate& truth, const VariantRun::Observer& observer) {
  if constexpr (requires { filter.covariance(); }) {
    const ErrorMatrix P = filter.covariance();
    observer(truth, filter.estimate(), &P);
  } else {
    observer(truth, filter.estimate(), nullptr);
  }
}

template <class Filter>
class Runner final : public VariantRun {
 public:
  explicit Runner(Filter filter) : filter_(std::move(filter)) {}

  void replay(const RecordedTrial& trial, const Observer& observer) override {
    play(
        trial.imu.size(), 1, trial.fixes,
        [&](std::size_t k) {
          filter_.predict(trial.imu[k]);
          return true;
        },
        [&](const RecordedTrial::Fix& fix) {
          if (fix.at < fix.arrives) when_valid_ = filter_;
        },
        [&](const RecordedTrial::Fix& fix) {
          if (observer && fix.truth) observe(filter_, *fix.truth, observer);
          use(fix, trial);
        });
  }

 private:
  /// A fix that arrives late acts at its own time: the filter goes back there and comes again.
  void use(const RecordedTrial::Fix& fix, const RecordedTrial& trial) {
    if (fix.arrives > fix.at) filter_ = *when_valid_;
    filter_.update(fix.fix);
    for (std::size_t k = fix.at + 1; k <= fix.arrives; ++k) filter_.predict(trial.imu[k]);
  }

  Filter filter_;
  std::optional<Filter> when_valid_{};
};

}  // namespace

std::unique_ptr<VariantRun> make_variant_run(const Variant& variant, const EkfConfig& believed,
                                             const TrialStart& start) {
  return visit_variant_filter(
      variant, believed, start, [](auto filter) -> std::unique_ptr<VariantRun> {
        return std::make_unique<Runner<decltype(filter)>>(std::move(filter));
      });
}

}  // namespace leeway::sim
