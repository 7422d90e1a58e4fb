#include "sim/analysis/sensitivity/factor_search.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/analysis/sensitivity/by_metric.hpp"

namespace leeway::sim {
namespace {

constexpr double kLeastFactor = 1e-3;
constexpr double kTenth = 0.1;
constexpr double kMostFactor = 1e3;
constexpr double kStride = 4.0;
constexpr int kMostSteps = 30;

/// A factor and the error it leaves.
struct FactorTrial {
  double factor{};
  double error_m{};
};

bool by_error(const FactorTrial& a, const FactorTrial& b) { return a.error_m < b.error_m; }

class FactorSearch {
 public:
  FactorSearch(const FactorQuestion& question, const std::vector<Specification>& what)
      : question_(question), what_(what), own_{1.0, question.own.true_m} {
    for (const ErrorBudgetLine& line : question.own.error_budget) {
      const bool is_scaled = std::ranges::any_of(
          what, [&line](Specification s) { return source_of(s) == line.source; });
      (is_scaled ? scaled_n_m2_ : kept_n_m2_) += line.mean_sq_n_m2;
    }
  }

  bool keeps(const FactorTrial& trial) const { return trial.error_m <= question_.limit_m; }

  FactorTrial trial(double factor) const {
    return {factor, analyze(with_factor(question_.scene, what_, factor), question_.track).true_m};
  }

  /// By the error budget, with the gains as they are. NaN: there is none.
  double predicted() const {
    const auto exceeds = [&](double factor) {
      return size_by_metric_m(question_.scene, kept_n_m2_ + factor * factor * scaled_n_m2_) >
             question_.limit_m;
    };
    double low = std::log(kLeastFactor);
    double high = std::log(kMostFactor);
    if (exceeds(std::exp(low)) || !exceeds(std::exp(high))) return std::nan("");
    while (high - low > 1e-4) {
      const double middle = 0.5 * (low + high);
      (exceeds(std::exp(middle)) ? high : low) = middle;
    }
    return std::exp(0.5 * (low + high));
  }

  /// A factor that keeps the limit and one that does not, or at an end of what is tried the same
  /// twice.
  std::pair<FactorTrial, FactorTrial> bracket(double predicted) const {
    if (!keeps(own_)) {
      FactorTrial breaks = own_;
      if (predicted < 1.0) {
        const FactorTrial guess = trial(predicted);
        if (keeps(guess)) return {guess, breaks};
        breaks = guess;
      }
      // A filter that does not know of scale factors may be worse off with ever better biases.
      FactorTrial least = trial(kLeastFactor);
      if (least.error_m > own_.error_m) least = std::min(least, trial(kTenth), by_error);
      return keeps(least) ? std::pair(least, breaks) : std::pair(least, least);
    }
    FactorTrial last = own_;
    while (last.factor < kMostFactor) {
      const FactorTrial next = trial(std::min(kStride * last.factor, kMostFactor));
      if (!keeps(next)) return {last, next};
      last = next;
    }
    return {last, last};
  }

  /// Regula falsi with Illinois weights on the mean square over the square of the factor: a
  /// straight line but for the gains. @returns the last that keeps the limit.
  FactorTrial narrow(FactorTrial keeper, FactorTrial breaker) const {
    const double limit_m2 = question_.limit_m * question_.limit_m;
    double keeper_weight = 1.0;
    double breaker_weight = 1.0;
    for (int i = 0; i < kMostSteps; ++i) {
      if (keeper.error_m >= (1.0 - question_.tolerance) * question_.limit_m) break;
      if (breaker.factor - keeper.factor < question_.tolerance * keeper.factor) break;
      const double low = keeper_weight * (keeper.error_m * keeper.error_m - limit_m2);
      const double high = breaker_weight * (breaker.error_m * breaker.error_m - limit_m2);
      const double from = keeper.factor * keeper.factor;
      const double to = breaker.factor * breaker.factor;
      const FactorTrial next = trial(std::sqrt(from - low * (to - from) / (high - low)));
      const bool is_kept = keeps(next);
      (is_kept ? keeper : breaker) = next;
      (is_kept ? keeper_weight : breaker_weight) = 1.0;
      (is_kept ? breaker_weight : keeper_weight) *= 0.5;
    }
    return keeper;
  }

 private:
  const FactorQuestion& question_;
  const std::vector<Specification>& what_;
  FactorTrial own_;
  Eigen::Matrix3d scaled_n_m2_{Eigen::Matrix3d::Zero()};
  Eigen::Matrix3d kept_n_m2_{Eigen::Matrix3d::Zero()};
};

}  // namespace

NeededFactor needed_factor(const FactorQuestion& question, std::string name,
                           std::vector<Specification> what) {
  NeededFactor needed{std::move(name), std::move(what)};
  const FactorSearch search(question, needed.what);
  needed.predicted_factor = search.predicted();
  const auto [keeper, breaker] = search.bracket(needed.predicted_factor);
  if (keeper.factor == breaker.factor) {
    needed.outcome =
        search.keeps(keeper) ? NeededFactor::Outcome::kAnything : NeededFactor::Outcome::kNotAlone;
    needed.error_m = keeper.error_m;
    return needed;
  }
  const FactorTrial found = search.narrow(keeper, breaker);
  needed.factor = found.factor;
  needed.error_m = found.error_m;
  return needed;
}

}  // namespace leeway::sim
