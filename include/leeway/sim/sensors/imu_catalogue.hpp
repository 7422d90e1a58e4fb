/// @file
/// A catalogue of real inertial measurement units: the values of their datasheets, and the error
/// models that follow from them.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "leeway/earth/names.hpp"
#include "leeway/earth/units.hpp"
#include "leeway/sensors/imu_error_model.hpp"

namespace leeway::sim {

/// The two triads of sensors of an IMU.
enum class Triad { kAccelerometer, kGyro };
constexpr auto names(Triad) { return std::array{"accelerometer", "gyro"}; }

/// Fields of an error model that a datasheet can fill.
enum class ModelField {
  kBiasSigma,
  kInRunSigma,
  kInRunTau,
  kNoise,
  kScaleSigma,
  kMisalignmentSigma,
  kGSensitivitySigma  ///< of the gyro only
};
constexpr auto names(ModelField) {
  return std::array{"bias_sigma",  "in_run_sigma",       "in_run_tau",         "noise",
                    "scale_sigma", "misalignment_sigma", "g_sensitivity_sigma"};
}

/// Meaning of a printed number, which decides how it is converted to the field.
enum class Meaning {
  kSigma,         ///< 1 sigma, a typical value, or a density: taken as it is
  kMaximum,       ///< a guaranteed bound: three sigma
  kAllanMinimum,  ///< in-run bias (in)stability: the lowest point of the Allan deviation
  kAssumed        ///< printed nowhere: assumed, so that the model is not too good
};
constexpr auto names(Meaning) { return std::array{"", "maximum", "Allan minimum", "assumed"}; }

/// One printed number and the field it fills.
struct DatasheetValue {
  Triad triad{};
  ModelField field{};
  double printed{};
  const Unit* unit{};
  Meaning meaning{};
  std::string_view quantity{};  ///< name in the datasheet; for kAssumed the reason

  /// The value of the field, in SI units.
  double si() const;
};

/// Peak of the Allan deviation of a Gauss-Markov process of sigma 1, at 1.89 of its correlation
/// time. A printed Allan minimum is taken as that peak: a process with a smaller sigma could not
/// hold the deviation at the level where the sensor's stops to fall.
/// Source: the maximum over x of sqrt(2/x (1 - (3 - 4 exp(-x) + exp(-2x)) / (2x))).
inline constexpr double kAllanPeak = 0.6173642831444414;

/// Accuracy grades, as manufacturers use them.
enum class Grade { kConsumer, kIndustrial, kTactical, kNavigation };
constexpr auto names(Grade) {
  return std::array{"consumer", "industrial", "tactical", "navigation"};
}

/// An IMU of the catalogue.
struct ImuPart {
  std::string_view name{};
  std::string_view manufacturer{};
  Grade grade{};
  std::string_view technology{};  ///< of gyro and accelerometer
  std::string_view datasheet{};   ///< title, number or revision, year
  std::string_view checked{};     ///< the numbers that were compared with a copy of it
  std::span<const DatasheetValue> values{};
};

/// All parts, from the least to the most accurate.
std::span<const ImuPart> imu_parts();

/// The part of that name. Case, spaces, dashes and underscores do not matter: "adis-16470" is
/// "ADIS16470".
/// @throws Error with the closest names when there is no such part.
const ImuPart& imu_part(std::string_view name);

/// The error model of a part.
/// @throws Error when the values do not make a valid model; those of the catalogue do.
ImuErrorModel imu_model(const ImuPart& part);

/// The nonzero fields of a model, as values in the units of datasheets.
std::vector<DatasheetValue> datasheet_values(const ImuErrorModel& model);

}  // namespace leeway::sim
