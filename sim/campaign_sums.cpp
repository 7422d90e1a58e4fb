#include "campaign_sums.hpp"

#include <cstddef>
#include <limits>
#include <type_traits>

namespace leeway::sim {

static_assert(std::is_trivially_copyable_v<CampaignSums>);

void CampaignSums::add(const TrialScore& score) {
  ++trials;
  fused += score.fused;
  gated += score.gated;
  diverged += score.diverged ? 1 : 0;
  if (!score.finite) {
    ++not_finite;
    consider_worst(std::numeric_limits<double>::infinity(), score.seed);
    return;
  }
  consider_worst(score.largest_horizontal_m, score.seed);
  epochs += score.epochs;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    error_sq_n_m2[axis].add(score.error_sq_n_m2[i]);
    variance_n_m2[axis].add(score.variance_n_m2[i]);
  }
  nees.add(score.nees);
  nis.add(score.nis);
  nis_dof += score.nis_dof;
  beyond_r95 += score.beyond_r95;
}

void CampaignSums::add(const CampaignSums& other) {
  if (other.trials == 0) return;
  trials += other.trials;
  not_finite += other.not_finite;
  diverged += other.diverged;
  epochs += other.epochs;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    error_sq_n_m2[axis].add(other.error_sq_n_m2[axis]);
    variance_n_m2[axis].add(other.variance_n_m2[axis]);
  }
  nees.add(other.nees);
  nis.add(other.nis);
  nis_dof += other.nis_dof;
  beyond_r95 += other.beyond_r95;
  fused += other.fused;
  gated += other.gated;
  consider_worst(other.worst_m, other.worst_seed);
}

void CampaignSums::consider_worst(double horizontal_m, std::uint64_t seed) {
  if (horizontal_m < worst_m || (horizontal_m == worst_m && seed > worst_seed)) return;
  worst_m = horizontal_m;
  worst_seed = seed;
}

}  // namespace leeway::sim
