/// @file
/// No more model than a scene needs: what every optional term of the filter's model is worth there,
/// predicted and measured, what it costs, and the cheapest filter that keeps the scene's limit.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "leeway/earth/names.hpp"
#include "leeway/sim/compare/compare.hpp"
#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

/// Terms of the model that can be left out, or taken more coarsely.
enum class ModelTerm {
  kEarthTurn,          ///< the Earth's rotation in the attitude
  kCoriolis,           ///< in the velocity
  kNormalGravity,      ///< what the normal field has beyond J2
  kJ2,                 ///< what the normal field has beyond a constant
  kGravityGradient,    ///< in Phi
  kConing,             ///< of increments in pairs
  kSculling,           ///< of increments in pairs, and the curvature of the position
  kSecondOrder,        ///< integration beyond explicit Euler
  kFullRate,           ///< the IMU's increments one by one, not added in pairs
  kFifthRate,          ///< the same, not added in fives
  kEachCovariance,     ///< P at every increment, not every 0.1 s
  kTenthCovariance,    ///< the same, not every 1 s
  kDoublePrecision,    ///< of P, not float
  kAccelerometerBias,  ///< the states
  kGyroBias,           ///< the states
  kBiasDecay,          ///< Gauss-Markov biases, not random walks of the same drive
  kBiasDrive,          ///< Gauss-Markov biases, not random constants
  kLeverArm,           ///< of the antenna
  kLatency,            ///< fixes act at their own time, not when they arrive
  kScaleFactors,       ///< of the sensors; no filter here models them
  kMisalignments,      ///< likewise
  kGSensitivity,       ///< of the gyros, likewise
};
constexpr auto names(ModelTerm) {
  return std::array{"earth_rotation",    "coriolis",
                    "gravity_beyond_j2", "gravity_beyond_constant",
                    "gravity_gradient",  "coning",
                    "sculling",          "integration_order",
                    "imu_rate_half",     "imu_rate_fifth",
                    "covariance_0_1_s",  "covariance_1_s",
                    "double_precision",  "accelerometer_bias",
                    "gyro_bias",         "bias_decay",
                    "bias_drive",        "lever_arm",
                    "latency",           "scale_factors",
                    "misalignments",     "g_sensitivity"};
}

/// The substitute for a term: what the filter does without it.
std::string_view substitute(ModelTerm term);

/// The terms that mean something in the scene. @param scene  as by reduce_model()
std::vector<ModelTerm> terms_of(const Scene& scene);

/// A filter that a reduction can run.
struct FilterModel {
  EkfConfig config{};
  int imu_divider{1};
  Precision precision{Precision::kDouble};
  bool knows_latency{true};
};

/// The full model: everything on, at the scene's rate. Two samples, normal gravity, the turning
/// Earth, P at every increment in double.
FilterModel full_model(const Scene& scene);

/// The model without some terms.
FilterModel without(FilterModel model, const std::vector<ModelTerm>& terms);

/// Accuracy by a linear analysis: a filter's horizontal errors before scored fixes.
struct PredictedAccuracy {
  double error_m{};         ///< by the scene's metric
  double rms_m{};           ///< root mean square
  double rms_over_sigma{};  ///< over what the filter claims
  double nees{};            ///< expected, of 15 states
  double difference_m{};    ///< root mean square of the difference to the full model's error
  bool is_finite{true};     ///< false: P is not positive, and nothing above means anything
};

/// The same accuracy by trials.
struct MeasuredAccuracy {
  double error_m{};          ///< by the scene's metric, empirical
  double difference_m{};     ///< root mean square of the difference to the full model's error
  CampaignResult figures{};  ///< without NIS and counts of fixes
};

/// Worth of a term: what it contributes to the error when left out, and what it costs.
struct TermWorth {
  ModelTerm term{};
  double predicted_m{};  ///< contribution: PredictedAccuracy::difference_m; NaN: P would not stay
                         ///< positive without the term, and the filter would be lost
  double measured_m{};   ///< likewise
  std::int64_t diverged{0};    ///< trials without the term with an error beyond ten claimed sigmas
  std::optional<Cost> cost{};  ///< that the full model pays for it; none: nothing to save
  bool is_kept{true};          ///< in the reduced model
};

/// Accuracy and cost of a model.
struct ModelWorth {
  FilterModel model{};
  PredictedAccuracy predicted{};
  MeasuredAccuracy measured{};
  Cost cost{};
};

/// Whether prediction and measurement agree: within 20 % of it, or within 1 % of the limit; or the
/// filter would be lost, and some trials were.
bool agrees(const TermWorth& term, double limit_m);

/// Result of a reduction.
struct ModelReduction {
  Scene scene{};  ///< as it was run
  std::vector<TermWorth> terms{};
  ModelWorth full{};
  ModelWorth standard{};      ///< full but for P every 0.1 s: what a filter does by default
  ModelWorth at_full_rate{};  ///< the reduced one, given the IMU's increments one by one
  ModelWorth reduced{};
  bool keeps_limit{};   ///< the reduced model, by trials
  bool is_as_honest{};  ///< likewise: it exceeds its claim by at most kHonesty more than the full
};

/// A reduced model's RMS over sigma, and the root of its NEES over 15, may exceed those of the full
/// one, or 1 where the full one claims too much, by this factor.
inline constexpr double kHonesty = 1.1;

/// The part of the limit that a choice may use: the rest is for the chance of the trials.
inline constexpr double kUsableLimit = 0.9;

/// Options of a reduction.
struct ReductionOptions {
  int repeat{11};  ///< timed runs of every model, 1 to 1000
  int threads{0};  ///< of what is not timed; 0: all processors
  std::function<void(double fraction)> progress{};
};

/// The contribution of every term, and the cheapest model found that keeps scene.limit and stays
/// honest; verified by scene.trials trials. Fixes come without outliers, and are not gated.
/// @throws Error when scene or options are invalid, or a fix arrives after the next one is valid.
ModelReduction reduce_model(const Scene& scene, const ReductionOptions& options = {});

/// The scene with its filter as the model has it, for filter_file(). @pre double precision, latency
/// known
Scene with_model(Scene scene, const FilterModel& model);

}  // namespace leeway::sim
