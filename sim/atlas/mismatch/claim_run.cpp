#include "sim/atlas/mismatch/claim_run.hpp"

#include <cmath>
#include <set>

namespace leeway::sim {
namespace {

constexpr double kLastS = 60.0;

bool is_right(const FaultEpoch& epoch) {
  constexpr double kSigmas = 10.0;
  constexpr double kRoomM = 10.0;
  const ErrorClaim& horizontal = epoch.claims.front();
  return epoch.has_solution && epoch.finite &&
         horizontal.error <= kRoomM + kSigmas * horizontal.sigma;
}

/// The epochs at which fixes arrive once they are few. Moves each arrival half an epoch on: the
/// epoch of that time is the last one without it.
std::set<long> delay(FaultInputs& inputs) {
  std::set<long> epochs;
  for (Arrival<GnssFix>& a : inputs.fixes) {
    if (to_seconds(a.input.time) > kDenseS) epochs.insert(epoch_at(a.at_s));
    a.at_s += 0.5 * kEpochS;
  }
  return epochs;
}

}  // namespace

void ClaimSums::add(const FaultEpoch& epoch) {
  epochs += 1.0;
  for (std::size_t e = 0; e < epoch.claims.size(); ++e) {
    error_sq[e] += epoch.claims[e].error * epoch.claims[e].error;
    sigma_sq[e] += epoch.claims[e].sigma * epoch.claims[e].sigma;
  }
  if (epoch.sigmas.front() > 3.0) beyond_3 += 1.0;
  if (epoch.sigmas.front() > 5.0) beyond_5 += 1.0;
}

void ClaimSums::add(const ClaimSums& other) {
  epochs += other.epochs;
  for (std::size_t e = 0; e < error_sq.size(); ++e) {
    error_sq[e] += other.error_sq[e];
    sigma_sq[e] += other.sigma_sq[e];
  }
  beyond_3 += other.beyond_3;
  beyond_5 += other.beyond_5;
}

double ClaimSums::ratio(FaultError e) const {
  const auto k = static_cast<std::size_t>(e);
  return std::sqrt(error_sq[k] / sigma_sq[k]);
}

double ClaimSums::rms(FaultError e) const {
  return std::sqrt(error_sq[static_cast<std::size_t>(e)] / epochs);
}

void thin_out(FaultInputs& inputs, int fix_interval_s) {
  int since_dense = 0;
  std::erase_if(inputs.fixes, [&](const Arrival<GnssFix>& a) {
    return to_seconds(a.input.time) > kDenseS && ++since_dense % fix_interval_s != 0;
  });
}

ClaimScore run_claims(const NavigatorConfig& config, FaultInputs inputs, const TrueDrive& way,
                      int fix_interval_s,
                      const std::function<void(const FaultEpoch&)>& before_fix) {
  thin_out(inputs, fix_interval_s);
  const std::set<long> fix_epochs = delay(inputs);
  ClaimScore score{.lost = true};
  bool finite = true;
  Navigator navigator(config);
  constexpr double kEndS = kDenseS + kSparseS;
  run_navigator(navigator, std::move(inputs), way, kEndS, [&](const FaultEpoch& epoch) {
    finite = finite && epoch.finite;
    if (epoch.t_s > kEndS - kLastS && is_right(epoch)) score.lost = false;
    if (epoch.t_s <= kDenseS || !epoch.has_solution || !epoch.finite) return;
    const bool is_before_fix = fix_epochs.contains(epoch_at(epoch.t_s));
    (is_before_fix ? score.before_fixes : score.between).add(epoch);
    if (is_before_fix && before_fix) before_fix(epoch);
  });
  score.lost = score.lost || !finite;
  score.imu_sigma_scale = navigator.health().imu_sigma_scale;
  return score;
}

}  // namespace leeway::sim
