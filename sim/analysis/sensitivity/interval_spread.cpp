#include "leeway/sim/analysis/interval_spread.hpp"

#include <string>

#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/sensors/bias_model.hpp"

namespace leeway::sim {
namespace {

/// The class of "tactical/mid".
std::optional<ImuClass> class_with_range(const std::string& imu) {
  const std::size_t slash = imu.rfind('/');
  if (slash == imu.npos || !from_name<RangeEnd>(imu.substr(slash + 1))) return {};
  return from_name<ImuClass>(imu.substr(0, slash));
}

}  // namespace

std::optional<IntervalSpread> interval_spread(const Scene& scene, const AllowedError& limit,
                                              const IntervalConfig& config) {
  const std::optional<ImuClass> imu_class = class_with_range(scene.imu_name);
  if (!imu_class) return {};
  const BiasModel bias = bias_model_of(scene.imu);
  const double tau_s =
      bias == BiasModel::kGaussMarkov ? scene.imu.accelerometer.in_run.tau_s : kBiasTauS;
  const auto at = [&](RangeEnd end) {
    Scene at_end = scene;
    set_imu(at_end, std::string(name(*imu_class)) + "/" + std::string(name(end)),
            with_bias_model(imu_class_model(*imu_class, end), bias, tau_s));
    return solve_intervals(at_end, {limit}, config).front();
  };
  return IntervalSpread{at(RangeEnd::kLow), at(RangeEnd::kMid), at(RangeEnd::kHigh)};
}

}  // namespace leeway::sim
