#include "leeway/sim/sensors/imu_catalogue.hpp"

#include <array>
#include <cctype>

#include "leeway/earth/error.hpp"
#include "sim/tools/closest_name.hpp"

namespace leeway::sim {
namespace {

constexpr double kSigmasOfMaximum = 3.0;

/// Where a field is in a model.
double& field_of(ImuErrorModel& model, Triad which, ModelField field) {
  TriadErrorModel& triad = which == Triad::kGyro ? model.gyro : model.accelerometer;
  double* const in_order[] = {&triad.bias_sigma,
                              &triad.in_run.sigma,
                              &triad.in_run.tau_s,
                              &triad.noise_density,
                              &triad.scale_sigma,
                              &triad.misalignment_sigma_rad,
                              &model.G_g_sigma_radps_per_mps2};
  return *in_order[static_cast<std::size_t>(field)];
}

/// The units in which models that are not of the catalogue are shown.
struct Shown {
  ModelField field;
  const Unit* accelerometer;
  const Unit* gyro;
};

constexpr std::array kShown{Shown{ModelField::kBiasSigma, &units::kMg, &units::kDegPerH},
                            Shown{ModelField::kInRunSigma, &units::kMg, &units::kDegPerH},
                            Shown{ModelField::kInRunTau, &units::kS, &units::kS},
                            Shown{ModelField::kNoise, &units::kUgPerSqrtHz, &units::kDegPerSqrtH},
                            Shown{ModelField::kScaleSigma, &units::kPpm, &units::kPpm},
                            Shown{ModelField::kMisalignmentSigma, &units::kMrad, &units::kMrad},
                            Shown{ModelField::kGSensitivitySigma, nullptr, &units::kDegPerHPerG}};

std::string without_punctuation(std::string_view name) {
  std::string letters;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) letters += static_cast<char>(std::tolower(byte));
  }
  return letters;
}

}  // namespace

double DatasheetValue::si() const {
  const double value = printed * unit->si;
  if (meaning == Meaning::kMaximum) return value / kSigmasOfMaximum;
  return meaning == Meaning::kAllanMinimum ? value / kAllanPeak : value;
}

const ImuPart& imu_part(std::string_view wanted) {
  std::vector<std::string_view> names;
  for (const ImuPart& part : imu_parts()) {
    if (without_punctuation(part.name) == without_punctuation(wanted)) return part;
    names.push_back(part.name);
  }
  throw Error("unknown IMU '" + std::string(wanted) + "': " + did_you_mean(wanted, names));
}

ImuErrorModel imu_model(const ImuPart& part) {
  ImuErrorModel model;
  for (const DatasheetValue& value : part.values) {
    field_of(model, value.triad, value.field) = value.si();
  }
  validate(model);
  return model;
}

std::vector<DatasheetValue> datasheet_values(const ImuErrorModel& model) {
  ImuErrorModel fields = model;
  std::vector<DatasheetValue> values;
  for (const Triad triad : {Triad::kAccelerometer, Triad::kGyro}) {
    for (const Shown& shown : kShown) {
      const Unit* unit = triad == Triad::kGyro ? shown.gyro : shown.accelerometer;
      const bool is_idle =
          unit == nullptr || (shown.field == ModelField::kInRunTau &&
                              field_of(fields, triad, ModelField::kInRunSigma) == 0.0);
      const double si = is_idle ? 0.0 : field_of(fields, triad, shown.field);
      if (si == 0.0) continue;
      values.push_back({triad, shown.field, si / unit->si, unit, Meaning::kSigma, ""});
    }
  }
  return values;
}

}  // namespace leeway::sim
