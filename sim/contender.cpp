#include "contender.hpp"

#include <algorithm>
#include <array>
#include <concepts>
#include <optional>
#include <utility>

#include "leeway/filters/dense_kernel.hpp"
#include "leeway/filters/invariant_ekf.hpp"
#include "leeway/filters/kernel_ekf.hpp"
#include "leeway/filters/reset_filter.hpp"
#include "leeway/filters/square_root_kernel.hpp"
#include "leeway/filters/symmetric_kernel.hpp"
#include "leeway/filters/ud_kernel.hpp"

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

template <class Filter>
std::unique_ptr<Contender> running(Filter filter) {
  return std::make_unique<Runner<Filter>>(std::move(filter));
}

using Factory = std::unique_ptr<Contender> (*)(const EkfConfig&, UpdateForm, const TrialStart&);

template <class Kernel, class Error>
std::unique_ptr<Contender> make_ekf(const EkfConfig& config, UpdateForm form,
                                    const TrialStart& start) {
  using Filter = KernelEkf<Kernel, Error>;
  if constexpr (std::constructible_from<Kernel, const ErrorMatrix&, UpdateForm>) {
    return running(Filter(config, start.estimate, Kernel(start.P, form)));
  } else {
    return running(Filter(config, start.estimate, Kernel(start.P)));
  }
}

struct Entry {
  KernelForm kernel;
  Precision precision;
  Factory make;
};

template <class Error>
constexpr std::array kEkfs{
    Entry{KernelForm::kDense, Precision::kFloat, make_ekf<DenseKernel<float>, Error>},
    Entry{KernelForm::kDense, Precision::kDouble, make_ekf<DenseKernel<double>, Error>},
    Entry{KernelForm::kSymmetric, Precision::kFloat, make_ekf<SymmetricKernel<float>, Error>},
    Entry{KernelForm::kSymmetric, Precision::kDouble, make_ekf<SymmetricKernel<double>, Error>},
    Entry{KernelForm::kUd, Precision::kFloat, make_ekf<UdKernel<float>, Error>},
    Entry{KernelForm::kUd, Precision::kDouble, make_ekf<UdKernel<double>, Error>},
    Entry{KernelForm::kSquareRoot, Precision::kFloat, make_ekf<SquareRootKernel<float>, Error>},
    Entry{KernelForm::kSquareRoot, Precision::kDouble, make_ekf<SquareRootKernel<double>, Error>}};

}  // namespace

std::unique_ptr<Contender> make_contender(const Variant& variant, const EkfConfig& believed,
                                          const TrialStart& start) {
  EkfConfig config = believed;
  config.strapdown = variant.strapdown;
  config.covariance_interval_s = variant.covariance_interval_s;
  if (variant.estimator == Estimator::kReset) return running(ResetFilter(config, start.estimate));
  const bool is_invariant = variant.estimator == Estimator::kInvariantEkf;
  const auto& ekfs = is_invariant ? kEkfs<InvariantError> : kEkfs<AdditiveError>;
  const auto* entry = std::find_if(ekfs.begin(), ekfs.end(), [&variant](const Entry& e) {
    return e.kernel == variant.kernel && e.precision == variant.precision;
  });
  return entry->make(config, variant.update, start);
}

}  // namespace leeway::sim
