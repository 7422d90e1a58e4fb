/// @file
/// The one table from variants, chosen at run time, to the types of the filters that run them.
#pragma once

#include <concepts>

#include "leeway/alternatives/dense_kernel.hpp"
#include "leeway/alternatives/invariant_ekf.hpp"
#include "leeway/alternatives/reset_filter.hpp"
#include "leeway/alternatives/ud_kernel.hpp"
#include "leeway/covariance/symmetric_kernel.hpp"
#include "leeway/ekf/ekf.hpp"
#include "leeway/sim/compare/variant.hpp"
#include "sim/trials/trial_score.hpp"

namespace leeway::sim {

/// Gives the visitor the filter over this kernel.
template <class Kernel, class Error, class Visitor>
auto visit_kernel_ekf(const EkfConfig& config, UpdateForm form, const TrialStart& start,
                      Visitor& visitor) {
  using Filter = BasicEkf<Kernel, Error>;
  if constexpr (std::constructible_from<Kernel, const ErrorMatrix&, UpdateForm>) {
    return visitor(Filter(config, start.estimate, Kernel(start.P, form)));
  } else {
    return visitor(Filter(config, start.estimate, Kernel(start.P)));
  }
}

template <template <class> class Kernel, class Visitor>
auto visit_kernel_ekf(const Variant& v, const EkfConfig& config, const TrialStart& start,
                      Visitor& visitor) {
  const bool is_float = v.precision == Precision::kFloat;
  if (v.estimator == Estimator::kInvariantEkf) {
    using Error = InvariantError;
    return is_float ? visit_kernel_ekf<Kernel<float>, Error>(config, v.update, start, visitor)
                    : visit_kernel_ekf<Kernel<double>, Error>(config, v.update, start, visitor);
  }
  using Error = AdditiveError;
  return is_float ? visit_kernel_ekf<Kernel<float>, Error>(config, v.update, start, visitor)
                  : visit_kernel_ekf<Kernel<double>, Error>(config, v.update, start, visitor);
}

/// Makes the variant's filter and gives it to the visitor. The rate of the IMU is the caller's.
/// @param believed  all that the variant does not say
/// @param visitor   takes a filter of any type by value; what it returns has one type
/// @throws Error when the configuration is invalid.
template <class Visitor>
auto visit_variant_filter(const Variant& variant, const EkfConfig& believed,
                          const TrialStart& start, Visitor visitor) {
  EkfConfig config = believed;
  config.strapdown = variant.strapdown;
  config.covariance_interval_s = variant.covariance_interval_s;
  config.gate_probability = 0.0;  // what a variant is lost by is to be seen
  if (variant.estimator == Estimator::kReset) return visitor(ResetFilter(config, start.estimate));
  switch (variant.kernel) {
    case KernelForm::kDense:
      return visit_kernel_ekf<DenseKernel>(variant, config, start, visitor);
    case KernelForm::kUd:
      return visit_kernel_ekf<UdKernel>(variant, config, start, visitor);
    case KernelForm::kSymmetric:
      break;
  }
  return visit_kernel_ekf<SymmetricKernel>(variant, config, start, visitor);
}

}  // namespace leeway::sim
