#include "leeway/sim/compare/variant.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <set>
#include <string_view>

namespace leeway::sim {
namespace {

constexpr std::array kAllSchemes{Scheme::kExplicitEuler, Scheme::kSemiImplicitEuler,
                                 Scheme::kTrapezoid,     Scheme::kOneSample,
                                 Scheme::kTwoSample,     Scheme::kRungeKutta4};
constexpr std::array kAllGravities{GravityModel::kConstant, GravityModel::kJ2,
                                   GravityModel::kNormal};
constexpr std::array kRotations{EarthRotation::kOff, EarthRotation::kOn};
constexpr std::array kKernels{KernelForm::kDense, KernelForm::kSymmetric, KernelForm::kUd};
constexpr std::array kForms{UpdateForm::kSimple, UpdateForm::kJoseph, UpdateForm::kBatch};
constexpr std::array kPrecisions{Precision::kFloat, Precision::kDouble};
constexpr std::array kIntervalsS{0.0, 0.1, 1.0};

std::string_view word(GravityModel gravity) {
  constexpr std::array<std::string_view, kAllGravities.size()> kWords{"constant", "j2", "normal"};
  return kWords[static_cast<std::size_t>(gravity)];
}

std::string_view word(EarthRotation rotation) {
  constexpr std::array<std::string_view, 4> kWords{"still", "turning", "turn-alone",
                                                   "coriolis-alone"};
  return kWords[static_cast<std::size_t>(rotation)];
}

std::string_view word(KernelForm kernel) {
  constexpr std::array<std::string_view, kKernels.size()> kWords{"dense", "symmetric", "ud"};
  return kWords[static_cast<std::size_t>(kernel)];
}

std::string_view word(Precision precision) {
  constexpr std::array<std::string_view, kPrecisions.size()> kWords{"float", "double"};
  return kWords[static_cast<std::size_t>(precision)];
}

std::string_view word(UpdateForm form) {
  constexpr std::array<std::string_view, kForms.size()> kWords{"simple", "joseph", "batch"};
  return kWords[static_cast<std::size_t>(form)];
}

std::string estimator_name(const Variant& v) {
  if (v.estimator == Estimator::kReset) return "reset";
  const std::string error = v.estimator == Estimator::kInvariantEkf ? "invariant/" : "";
  const std::string form = has_update_forms(v.kernel) ? fmt::format("{}/", word(v.update)) : "";
  const std::string interval =
      v.covariance_interval_s == 0.0 ? "each" : fmt::format("{:g}s", v.covariance_interval_s);
  return fmt::format("{}{}/{}{}/{}", error, word(v.kernel), form, word(v.precision), interval);
}

}  // namespace

std::string_view name(Scheme scheme) {
  constexpr std::array<std::string_view, 8> kWords{
      "explicit-euler", "semi-implicit-euler", "trapezoid", "one-sample",
      "two-sample",     "runge-kutta-4",       "coning",    "sculling"};
  return kWords[static_cast<std::size_t>(scheme)];
}

bool has_update_forms(KernelForm kernel) {
  return kernel == KernelForm::kDense || kernel == KernelForm::kSymmetric;
}

std::string name(const Variant& v, double imu_rate_hz) {
  return fmt::format("{}/{}/{}/{:g}Hz {}", name(v.strapdown.scheme), word(v.strapdown.gravity),
                     word(v.strapdown.rotation), imu_rate_hz / v.imu_divider, estimator_name(v));
}

std::vector<Variant> strapdown_variants(const std::vector<int>& imu_dividers) {
  std::vector<Variant> variants;
  for (const Scheme scheme : kAllSchemes) {
    for (const GravityModel gravity : kAllGravities) {
      for (const EarthRotation rotation : kRotations) {
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
  for (const KernelForm kernel : kKernels) {
    for (const Precision precision : kPrecisions) {
      for (const double interval_s : kIntervalsS) {
        for (const UpdateForm form : kForms) {
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
      if (names.insert(name(variant, 1.0)).second) variants.push_back(variant);
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
