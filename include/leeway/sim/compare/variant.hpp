/// @file
/// One way of running the filter: every choice that costs time or accuracy, as values.
#pragma once

#include <string>
#include <vector>

#include "leeway/covariance/covariance_kernel.hpp"
#include "leeway/earth/names.hpp"
#include "leeway/strapdown/strapdown.hpp"

namespace leeway::sim {

/// Estimators that a variant can run.
enum class Estimator {
  kEkf,           ///< BasicEkf (default)
  kInvariantEkf,  ///< InvariantEkf: the same on the error of SE_2(3)
  kReset,         ///< ResetFilter: the seed's separate scheme
};
constexpr auto names(Estimator) { return std::array{"ekf", "invariant", "reset"}; }

/// One way of running the filter; the default is that of the library.
struct Variant {
  Estimator estimator{Estimator::kEkf};
  StrapdownPolicy strapdown{};
  int imu_divider{1};  ///< so many of the scene's increments are added to one
  // Of the EKFs:
  double covariance_interval_s{0.1};  ///< 0: at every increment
  KernelForm kernel{KernelForm::kSymmetric};
  Precision precision{Precision::kDouble};
  UpdateForm update{UpdateForm::kJoseph};  ///< of the dense and the symmetric kernel
};

/// Whether the kernel has a choice of update forms.
bool has_update_forms(KernelForm kernel);

/// The name of a variant: every choice that it has, and no other. Two of a name run alike.
/// "two-sample/normal/turning/50Hz symmetric/joseph/double/0.1s". No comma, no quote.
std::string variant_name(const Variant& variant, double imu_rate_hz);

/// Every scheme, gravity, Earth rotation and IMU rate, on the default covariance.
std::vector<Variant> strapdown_variants(const std::vector<int>& imu_dividers);

/// Every kernel, precision, update form and interval (each increment, 0.1 s, 1 s), on the default
/// strapdown. Not long double, which no vehicle needs.
std::vector<Variant> covariance_variants();

/// The invariant EKF on the default strapdown and kernel, at every IMU rate and interval.
std::vector<Variant> invariant_variants(const std::vector<int>& imu_dividers);

/// The separate scheme on the default strapdown and on the cheapest, at every IMU rate.
std::vector<Variant> reset_variants(const std::vector<int>& imu_dividers);

/// The four lists above, each name once.
std::vector<Variant> sensible_variants(const std::vector<int>& imu_dividers);

/// The strapdown and IMU rate of the one with the covariance of the other.
Variant combined(const Variant& strapdown, const Variant& covariance);

}  // namespace leeway::sim
