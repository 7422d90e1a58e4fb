#include "contender.hpp"

#include <utility>

#include "visit_filter.hpp"

namespace leeway::sim {
namespace {

template <class Filter>
void observe(const Filter& filter, const Estimate& truth, const Contender::Observer& observer) {
  if constexpr (requires { filter.covariance(); }) {
    const ErrorMatrix P = filter.covariance();
    observer(truth, filter.estimate(), &P);
  } else {
    observer(truth, filter.estimate(), nullptr);
  }
}

template <class Filter>
class Runner final : public Contender {
 public:
  explicit Runner(Filter filter) : filter_(std::move(filter)) {}

  void replay(const RecordedTrial& trial, const Observer& observer) override {
    auto next = trial.fixes.begin();
    for (std::size_t k = 0; k < trial.imu.size(); ++k) {
      filter_.predict(trial.imu[k]);
      if (next == trial.fixes.end() || k != next->at) continue;
      if (observer && next->truth) observe(filter_, *next->truth, observer);
      filter_.update(next->fix);
      ++next;
    }
  }

 private:
  Filter filter_;
};

}  // namespace

std::unique_ptr<Contender> make_contender(const Variant& variant, const EkfConfig& believed,
                                          const TrialStart& start) {
  return visit_filter(variant, believed, start, [](auto filter) -> std::unique_ptr<Contender> {
    return std::make_unique<Runner<decltype(filter)>>(std::move(filter));
  });
}

}  // namespace leeway::sim
