/// @file
/// The inverse of the correction interval: which IMU keeps the limit when fixes are to be so far
/// apart. What must be better, by what factor, and which parts and classes are good enough.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "leeway/earth/names.hpp"
#include "leeway/sim/analysis/specification.hpp"
#include "leeway/sim/sensors/bias_model.hpp"

namespace leeway::sim {

/// The factor on some specifications at which the error meets the limit.
struct NeededFactor {
  enum class Outcome {
    kFactor,    ///< below 1: so much better it must be; above 1: so much worse it may be
    kNotAlone,  ///< even a thousandth of it, or a tenth, leaves too large an error
    kAnything,  ///< even a thousand times worse keeps the limit
  };
  std::string name{};  ///< of the specification, or "accelerometer", "gyro", "imu", "receiver"
  std::vector<Specification> what{};
  Outcome outcome{Outcome::kFactor};
  double factor{std::numeric_limits<double>::quiet_NaN()};  ///< NaN unless kFactor
  double error_m{};  ///< at the factor; else the least of the two, or that of the thousandfold
  /// What the error budget alone says of it, the filter's gains kept; NaN where it has no answer.
  double predicted_factor{std::numeric_limits<double>::quiet_NaN()};
};
constexpr auto names(NeededFactor::Outcome) {
  return std::array{"factor", "not_alone", "anything"};
}

/// An IMU that could be bought, or a class of them, in the scene at the interval.
struct ImuCandidate {
  std::string name{};  ///< "STIM300"; "tactical/mid" of a class
  bool is_class{};
  double error_m{};  ///< by the scene's metric
  bool keeps_limit{};
};

/// Options of invert().
struct InverseConfig {
  double covariance_step_s{1.0};
  double tolerance{1e-3};  ///< relative, of the error reached
  /// What the biases of the classes do after turn-on.
  BiasModel class_bias{BiasModel::kConstant};
  int threads{0};  ///< 0: as many as there are processors
};

/// The answer for one need.
struct Inverse {
  double interval_s{};
  double limit_m{};
  double error_m{};  ///< of the scene's own IMU; at most the limit where it is good enough
  ErrorBudget error_budget{};
  /// Each specification of the IMU alone, then together: accelerometer, gyro, imu, receiver.
  std::vector<NeededFactor> factors{};
  /// All parts of the catalogue and the three ends of every class, the least error first.
  std::vector<ImuCandidate> candidates{};
};

/// The inverse. The error budget predicts each factor: a source's mean square goes with the square
/// of its specification. Analyses with the filter's gains for the new IMU then settle it.
/// @param interval_s  the time between fixes that is needed
/// @throws Error when the scene is invalid, unless 0.01 <= interval_s <=
/// longest_interval_s(scene), and unless 0 < limit_m <= 1e6.
Inverse invert(const Scene& scene, double interval_s, double limit_m,
               const InverseConfig& config = {});

/// The scene with the specifications of a needed factor multiplied by it.
Scene with_factor(Scene scene, const std::vector<Specification>& what, double factor);

}  // namespace leeway::sim
