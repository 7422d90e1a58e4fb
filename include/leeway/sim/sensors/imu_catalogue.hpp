/// @file
/// Real inertial measurement units: what their datasheets print, and the error models that follow.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "leeway/earth/names.hpp"
#include "leeway/earth/units.hpp"
#include "leeway/sensors/imu_error_model.hpp"

namespace leeway::sim {

enum class Triad { kAccelerometer, kGyro };
constexpr auto names(Triad) { return std::array{"accelerometer", "gyro"}; }

/// The numbers of an error model that a datasheet can fill.
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

/// What a printed number is, which decides how it becomes the field (see sigma_of).
enum class Meaning {
  kSigma,         ///< 1 sigma, a typical value, or a density: taken as it is
  kMaximum,       ///< a guaranteed bound: three sigma
  kAllanMinimum,  ///< in-run bias (in)stability: the lowest point of the Allan deviation
  kAssumed        ///< printed nowhere: stands in so that the model is not too good
};
constexpr auto names(Meaning) { return std::array{"", "maximum", "Allan minimum", "assumed"}; }

/// One printed number and the field it fills.
struct DatasheetValue {
  Triad triad{};
  ModelField field{};
  double printed{};
  const Unit* unit{};
  Meaning meaning{};
  std::string_view quantity{};  ///< what the datasheet calls it; why, where it is assumed

  /// The number in the field, in SI.
  double si() const;
};

/// A Gauss-Markov process of sigma 1 has an Allan deviation that is highest, kAllanPeak, at 1.89 of
/// its correlation time. A printed Allan minimum is read as that level: no smaller process could
/// keep the deviation up where the sensor's ends to fall.
/// Source: the maximum over x of sqrt(2/x (1 - (3 - 4 exp(-x) + exp(-2x)) / (2x))).
inline constexpr double kAllanPeak = 0.6173642831444414;

enum class Grade { kConsumer, kIndustrial, kTactical, kNavigation };
constexpr auto names(Grade) {
  return std::array{"consumer", "industrial", "tactical", "navigation"};
}

struct ImuPart {
  std::string_view name{};
  std::string_view manufacturer{};
  Grade grade{};
  std::string_view technology{};  ///< of gyro and accelerometer
  std::string_view datasheet{};   ///< title, number or revision, year
  std::string_view checked{};     ///< which of the numbers were compared with a copy of it
  std::span<const DatasheetValue> values{};
};

/// All parts, from the least to the most accurate.
std::span<const ImuPart> imu_parts();

/// Case, spaces, dashes and underscores do not matter: "adis-16470" is "ADIS16470".
/// @throws Error with the closest names when there is no such part.
const ImuPart& imu_part(std::string_view name);

/// @throws Error when values do not make a valid model, which no part of the catalogue does.
ImuErrorModel imu_model(const ImuPart& part);

/// The fields of a model that are not zero, as values in the units of datasheets.
std::vector<DatasheetValue> datasheet_values(const ImuErrorModel& model);

}  // namespace leeway::sim
