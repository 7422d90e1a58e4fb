/// @file
/// Speed against accuracy: what each way of running the filter costs in a scene, measured now, and
/// how much it errs.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "leeway/earth/names.hpp"
#include "leeway/sim/compare/variant.hpp"
#include "leeway/sim/scene/scene.hpp"
#include "leeway/sim/trials/campaign.hpp"

namespace leeway::sim {

/// Options of a comparison. Its trials are the scene's, with seeds from first_seed on.
struct CompareOptions {
  int repeat{5};   ///< timed runs of every variant, 1 to 1000
  int threads{0};  ///< of the runs that are not timed; 0: all processors
  std::function<void(double fraction)> progress{};
};

/// Time of the filter alone per second of IMU data: median and range of the timed runs.
struct Cost {
  double median_ns_per_s{};
  double least_ns_per_s{};
  double most_ns_per_s{};
};

/// Accuracy of a variant: its errors before scored fixes, over all trials.
struct Accuracy {
  CampaignResult figures{};  ///< of claims only where there are any; no NIS, no counts of fixes
  double r95_m{};            ///< 95 % of the horizontal errors are within; NaN without any
  bool has_claim{true};      ///< false: the estimator claims nothing, and cannot be consistent
};

/// Verdict on what a filter claims.
enum class Consistency {
  kNoClaim,
  kConsistent,   ///< mean NEES within its band
  kOptimistic,   ///< above
  kPessimistic,  ///< below
  kDiverged,     ///< a trial with an error beyond ten claimed sigmas
  kNotFinite,    ///< a trial that ended in numbers that are none, or with P not positive
};
constexpr auto names(Consistency) {
  return std::array{"no claim",    "consistent", "optimistic",
                    "pessimistic", "diverged",   "not finite"};
}

/// The verdict on an accuracy.
Consistency consistency_of(const Accuracy& accuracy);

/// A variant with its cost and accuracy.
struct Compared {
  Variant variant{};
  std::string name{};
  Cost cost{};
  Accuracy accuracy{};
  std::optional<std::size_t> dominated_by{};  ///< an index of Comparison::variants
  bool on_front{false};
};

/// Result of a comparison.
struct Comparison {
  Scene scene{};                     ///< as it was run
  std::vector<int> imu_dividers{};   ///< of the rates that its fixes allow
  std::vector<Compared> variants{};  ///< by median cost, ascending
};

/// The scene as variants are compared in it: fixes come without latency and without outliers,
/// because the plain filter has neither a history nor a gate.
Scene comparable(const Scene& scene);

/// The accuracy of these variants, in their order. The same bits on any number of threads.
/// @throws Error when the scene is invalid, or a divider does not fit its fixes.
std::vector<Accuracy> accuracy_of(const std::vector<Variant>& variants, const Scene& scene,
                                  int threads = 0,
                                  const std::function<void(double)>& progress = {});

/// The comparison of sensible_variants() and combinations of the cheapest survivors: the rules are
/// in docs/theory/compare/compare.md. Accuracies are the same bits for the same scene; costs are of
/// this run.
/// @throws Error when scene or options are invalid.
Comparison compare(const Scene& scene, const CompareOptions& options = {});

}  // namespace leeway::sim
