#include "sim/compare/variant_run.hpp"

#include <optional>
#include <utility>

#include "leeway/ekf/ekf_config.hpp"
#include "sim/compare/variant_filter.hpp"

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
    auto next = trial.fixes.begin();
    for (std::size_t k = 0; k < trial.imu.size(); ++k) {
      filter_.predict(trial.imu[k]);
      if (next == trial.fixes.end()) continue;
      if (k == next->at && k < next->arrives) when_valid_ = filter_;
      if (k != next->arrives) continue;
      if (observer && next->truth) observe(filter_, *next->truth, observer);
      use(*next, trial);
      ++next;
    }
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
