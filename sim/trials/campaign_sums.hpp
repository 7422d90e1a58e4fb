/// @file
/// What a campaign keeps of its trials: exact sums, in which the order of the trials leaves no
/// trace.
#pragma once

#include <array>
#include <cstdint>

#include "leeway/sim/tools/exact_sum.hpp"
#include "leeway/sim/trials/campaign.hpp"
#include "leeway/sim/trials/trial.hpp"

namespace leeway::sim {

/// Trivially copyable: travels between processes as bytes.
struct CampaignSums {
  std::int64_t trials{0};      ///< all of them; sums leave out those not finite
  std::int64_t not_finite{0};  ///< a part of diverged
  std::int64_t diverged{0};
  std::int64_t epochs{0};
  std::array<ExactSum, 3> error_sq_n_m2{};
  std::array<ExactSum, 3> variance_n_m2{};
  ExactSum nees{};
  ExactSum nis{};
  std::int64_t nis_dof{0};
  std::int64_t beyond_r95{0};
  std::int64_t fused{0};
  std::int64_t gated{0};
  /// The trial with the largest horizontal error, one not finite before all others; of equals the
  /// one with the lowest seed.
  double worst_m{-1.0};
  std::uint64_t worst_seed{};

  void add(const TrialScore& score);
  void add(const CampaignSums& other);

 private:
  void consider_worst(double horizontal_m, std::uint64_t seed);
};

/// What the sums say; `resumed` is not among them.
CampaignResult result_of(const CampaignSums& sums);

}  // namespace leeway::sim
