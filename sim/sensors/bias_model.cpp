#include "leeway/sim/sensors/bias_model.hpp"

#include "leeway/earth/error.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway::sim {
namespace {

TriadErrorModel wandering(TriadErrorModel triad, double tau_s) {
  triad.in_run = {triad.bias_sigma, tau_s};
  triad.bias_sigma = 0.0;
  return triad;
}

}  // namespace

BiasModel bias_model_of(const ImuErrorModel& model) {
  const bool drifts = model.accelerometer.in_run.sigma > 0.0 || model.gyro.in_run.sigma > 0.0;
  return drifts ? BiasModel::kGaussMarkov : BiasModel::kConstant;
}

ImuErrorModel with_bias_model(const ImuErrorModel& model, BiasModel bias, double tau_s) {
  if (bias_model_of(model) == BiasModel::kGaussMarkov) {
    throw Error(
        "the IMU model states an in-run drift of its own: a bias model (constant, "
        "gauss_markov) can be chosen for the Table 1 classes only");
  }
  require("bias model", "tau_s", tau_s, kPositiveOrInfinite);
  if (bias == BiasModel::kConstant) return model;
  ImuErrorModel changed = model;
  changed.accelerometer = wandering(model.accelerometer, tau_s);
  changed.gyro = wandering(model.gyro, tau_s);
  return changed;
}

}  // namespace leeway::sim
