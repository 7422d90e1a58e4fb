/// @file
/// Models of a bias after turn-on: two readings of the same datasheet figure.
#pragma once

#include "leeway/earth/names.hpp"
#include "leeway/sensors/imu_error_model.hpp"

namespace leeway::sim {

/// Behaviour of a bias after turn-on.
enum class BiasModel {
  kConstant,     ///< keeps its turn-on value
  kGaussMarkov,  ///< wanders, with the same sigma at every moment
};
constexpr auto names(BiasModel) { return std::array{"constant", "gauss_markov"}; }

inline constexpr double kBiasTauS = 3600.0;  ///< default correlation time of the wandering

/// The bias model of an error model: kGaussMarkov where it has an in-run drift.
BiasModel bias_model_of(const ImuErrorModel& model);

/// The error model with the bias model applied: kGaussMarkov turns the turn-on spread into the
/// sigma of an in-run drift.
/// @throws Error when the model states an in-run drift of its own, or tau_s is not > 0.
ImuErrorModel with_bias_model(const ImuErrorModel& model, BiasModel bias, double tau_s = kBiasTauS);

}  // namespace leeway::sim
