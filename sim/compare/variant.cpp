#include "leeway/sim/compare/variant.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <set>

namespace leeway::sim {
namespace {

constexpr std::array kIntervalsS{0.0, 0.1, 1.0};

/// Whether it has one of two terms that belong together: for the study of model terms alone.
constexpr bool is_half(const StrapdownPolicy& policy) {
  return policy.scheme == Scheme::kConing || policy.scheme == Scheme::kSculling ||
         policy.rotation == EarthRotation::kTurnAlone ||
         policy.rotation == EarthRotation::kCoriolisAlone;
}

std::string estimator_name(const Variant& v) {
  if (v.estimator == Estimator::kReset) return std::string(name(v.estimator));
  const std::string error =
      v.estimator == Estimator::kEkf ? "" : fmt::format("{}/", name(v.estimator));
  const std::string form = has_update_forms(v.kernel) ? fmt::format("{}/", name(v.update)) : "";
  const std::string interval =
      v.covariance_interval_s == 0.0 ? "each" : fmt::format("{:g}s", v.covariance_interval_s);
  return fmt::format("{}{}/{}{}/{}", error, name(v.kernel), form, name(v.precision), interval);
}

}  // namespace

bool has_update_forms(KernelForm kernel) {
  return kernel == KernelForm::kDense || kernel == KernelForm::kSymmetric;
}

std::string variant_name(const Variant& v, double imu_rate_hz) {
  return fmt::format("{}/{}/{}/{:g}Hz {}", name(v.strapdown.scheme), name(v.strapdown.gravity),
                     name(v.strapdown.rotation), imu_rate_hz / v.imu_divider, estimator_name(v));
}

std::vector<Variant> strapdown_variants(const std::vector<int>& imu_dividers) {
  std::vector<Variant> variants;
  for (const Scheme scheme : kAll<Scheme>) {
    for (const GravityModel gravity : kAll<GravityModel>) {
      for (const EarthRotation rotation : kAll<EarthRotation>) {
        if (is_half({scheme, gravity, rotation})) continue;
        for (const int divider : imu_dividers) {
          variants.push_back({.strapdown = {scheme, gravity, rotation}, .imu_divider = divider});
        }
      }
    }
  }
  return variants;
}

std::vector<Variant> covariance_variants() {
  std::vector<Variant> variants;
  for (const KernelForm kernel : kAll<KernelForm>) {
    for (const Precision precision : kAll<Precision>) {
      for (const double interval_s : kIntervalsS) {
        for (const UpdateForm form : kAll<UpdateForm>) {
          if (!has_update_forms(kernel) && form != UpdateForm::kJoseph) continue;
          variants.push_back({.covariance_interval_s = interval_s,
                              .kernel = kernel,
                              .precision = precision,
                              .update = form});
        }
      }
    }
  }
  return variants;
}

std::vector<Variant> invariant_variants(const std::vector<int>& imu_dividers) {
  std::vector<Variant> variants;
  for (const int divider : imu_dividers) {
    for (const double interval_s : kIntervalsS) {
      variants.push_back({.estimator = Estimator::kInvariantEkf,
                          .imu_divider = divider,
                          .covariance_interval_s = interval_s});
    }
  }
  return variants;
}

std::vector<Variant> reset_variants(const std::vector<int>& imu_dividers) {
  constexpr StrapdownPolicy kCheapest{Scheme::kExplicitEuler, GravityModel::kConstant,
                                      EarthRotation::kOff};
  std::vector<Variant> variants;
  for (const StrapdownPolicy& policy : {StrapdownPolicy{}, kCheapest}) {
    for (const int divider : imu_dividers) {
      variants.push_back(
          {.estimator = Estimator::kReset, .strapdown = policy, .imu_divider = divider});
    }
  }
  return variants;
}

std::vector<Variant> sensible_variants(const std::vector<int>& imu_dividers) {
  std::vector<Variant> variants;
  std::set<std::string> names;
  for (const auto& list : {strapdown_variants(imu_dividers), covariance_variants(),
                           invariant_variants(imu_dividers), reset_variants(imu_dividers)}) {
    for (const Variant& variant : list) {
      if (names.insert(variant_name(variant, 1.0)).second) variants.push_back(variant);
    }
  }
  return variants;
}

Variant combined(const Variant& strapdown, const Variant& covariance) {
  Variant both = covariance;
  both.strapdown = strapdown.strapdown;
  both.imu_divider = strapdown.imu_divider;
  return both;
}

}  // namespace leeway::sim
