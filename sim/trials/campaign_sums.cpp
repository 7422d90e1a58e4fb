#include "sim/trials/campaign_sums.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "leeway/model/chi_square.hpp"
#include "leeway/model/error_state.hpp"

namespace leeway::sim {
namespace {

double root_mean(double sum, std::int64_t count) {
  return std::sqrt(sum / static_cast<double>(count));
}

}  // namespace

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

CampaignResult result_of(const CampaignSums& sums) {
  CampaignResult r;
  r.trials = sums.trials;
  r.epochs = sums.epochs;
  const auto epochs = static_cast<double>(sums.epochs);
  ExactSum error_sq_m2 = sums.error_sq_n_m2[0];
  error_sq_m2.add(sums.error_sq_n_m2[1]);
  ExactSum variance_m2 = sums.variance_n_m2[0];
  variance_m2.add(sums.variance_n_m2[1]);
  r.rms_horizontal_m = root_mean(error_sq_m2.value(), sums.epochs);
  r.sigma_horizontal_m = root_mean(variance_m2.value(), sums.epochs);
  r.rms_over_sigma = r.rms_horizontal_m / r.sigma_horizontal_m;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    r.rms_n_m[i] = root_mean(sums.error_sq_n_m2[axis].value(), sums.epochs);
    r.sigma_n_m[i] = root_mean(sums.variance_n_m2[axis].value(), sums.epochs);
  }
  r.mean_nees = sums.nees.value() / epochs;
  const std::int64_t scored = sums.trials - sums.not_finite;
  const int dof = kErrorStates * static_cast<int>(std::max<std::int64_t>(scored, 1));
  r.nees_low = kErrorStates * chi_square_threshold(0.975, dof) / dof;
  r.nees_high = kErrorStates * chi_square_threshold(0.025, dof) / dof;
  r.nis_over_dof = sums.nis.value() / static_cast<double>(sums.nis_dof);
  r.beyond_r95 = static_cast<double>(sums.beyond_r95) / epochs;
  r.fused = sums.fused;
  r.gated = sums.gated;
  r.diverged = sums.diverged;
  r.not_finite = sums.not_finite;
  r.worst_horizontal_m = sums.worst_m;
  r.worst_seed = sums.worst_seed;
  return r;
}

}  // namespace leeway::sim
