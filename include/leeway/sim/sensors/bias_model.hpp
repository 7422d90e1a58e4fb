/// @file
/// What a bias does after turn-on: two readings of the same datasheet figure.
#pragma once

#include "leeway/earth/names.hpp"
#include "leeway/sensors/imu_error_model.hpp"

namespace leeway::sim {

enum class BiasModel {
  kConstant,     ///< stays what it was at turn-on
  kGaussMarkov,  ///< wanders, with the same sigma at every moment
};
constexpr auto names(BiasModel) { return std::array{"constant", "gauss_markov"}; }

inline constexpr double kBiasTauS = 3600.0;  ///< of the wandering, where nothing else is said

/// kGaussMarkov where the model has an in-run drift.
BiasModel bias_model_of(const ImuErrorModel& model);

/// The model with its biases so: kGaussMarkov makes the turn-on spread the sigma of an in-run
/// drift.
/// @throws Error when the model states an in-run drift of its own, or tau_s is not > 0.
ImuErrorModel with_bias_model(const ImuErrorModel& model, BiasModel bias, double tau_s = kBiasTauS);

}  // namespace leeway::sim
