#include "leeway/sim/analysis/interval_spread.hpp"

#include "leeway/sim/sensors/bias_model.hpp"
#include "leeway/sim/sensors/imu_class_name.hpp"

namespace leeway::sim {
std::optional<IntervalSpread> interval_spread(const Scene& scene, const AllowedError& limit,
                                              const IntervalConfig& config) {
  const std::optional<ClassAndRange> own = class_of_name(scene.imu_name);
  if (!own) return {};
  const BiasModel bias = bias_model_of(scene.imu);
  const double tau_s =
      bias == BiasModel::kGaussMarkov ? scene.imu.accelerometer.in_run.tau_s : kBiasTauS;
  const auto at = [&](RangeEnd end) {
    Scene at_end = scene;
    set_imu(at_end, imu_name({own->imu_class, end}),
            with_bias_model(imu_class_model(own->imu_class, end), bias, tau_s));
    return solve_intervals(at_end, {limit}, config).front();
  };
  return IntervalSpread{at(RangeEnd::kLow), at(RangeEnd::kMid), at(RangeEnd::kHigh)};
}

}  // namespace leeway::sim
