/// @file
/// Models of a bias after turn-on: two readings of the same datasheet figure.
#pragma once

#include <array>
#include <string_view>

#include "leeway/sensors/imu_error_model.hpp"

namespace leeway::sim {

/// Behaviour of a bias after turn-on.
enum class BiasModel {
  kConstant,     ///< keeps its turn-on value
  kGaussMarkov,  ///< wanders, with the same sigma at every moment
};

inline constexpr std::array kBiasModels{BiasModel::kConstant, BiasModel::kGaussMarkov};
inline constexpr double kBiasTauS = 3600.0;  ///< default correlation time of the wandering

std::string_view name(BiasModel model);

/// The bias model of that name. @throws Error listing the known names.
BiasModel bias_model_from_name(std::string_view name);

/// The bias model of an error model: kGaussMarkov where it has an in-run drift.
BiasModel bias_model_of(const ImuErrorModel& model);

/// The error model with the bias model applied: kGaussMarkov turns the turn-on spread into the
/// sigma of an in-run drift.
/// @throws Error when the model states an in-run drift of its own, or tau_s is not > 0.
ImuErrorModel with_bias_model(const ImuErrorModel& model, BiasModel bias, double tau_s = kBiasTauS);

}  // namespace leeway::sim
