#include "sim/sensors/imu_relations.hpp"

namespace leeway::sim {

double stated(const ImuErrorModel& model, Stated quantity) {
  switch (quantity) {
    case Stated::kAccelerometerBiasSigma:
      return model.accelerometer.bias_sigma;
    case Stated::kAccelerometerInRun:
      return model.accelerometer.in_run.sigma;
    case Stated::kAccelerometerNoise:
      return model.accelerometer.noise_density;
    case Stated::kGyroBiasSigma:
      return model.gyro.bias_sigma;
    case Stated::kGyroInRun:
      return model.gyro.in_run.sigma;
    case Stated::kGyroNoise:
      break;
  }
  return model.gyro.noise_density;
}

bool Relation::allows(double over_si, double under_si) const {
  if (over_si == 0.0 || under_si == 0.0) return true;
  return over_si >= low * under_si && over_si <= high * under_si;
}

}  // namespace leeway::sim
