// The data of the catalogue: numbers as printed, in the units they are printed in. What no
// datasheet prints is either assumed, with the reason, or left out and thus zero in the model.
#include <algorithm>
#include <utility>

#include "leeway/sim/sensors/imu_catalogue.hpp"

namespace leeway::sim {

/// The sheets, in a namespace of their own for the short names of enumerators they are written in.
namespace sheets {
namespace {

namespace u = leeway::units;
using enum Grade;
using enum ModelField;
using enum Meaning;
constexpr Triad kA = Triad::kAccelerometer;
constexpr Triad kG = Triad::kGyro;

constexpr const char* kTau = "correlation time: printed nowhere";
constexpr const char* kNoInRun = "in-run drift: not printed, of the order of its kind";
constexpr const char* kNotRead = "none";
constexpr const char* kAsAdis16488 = "bias at turn-on: that of the ADIS16488A";
constexpr const char* kAsMti300 = "bias at turn-on: that of the MTi-300";

constexpr DatasheetValue kConsumerInRun[]{
    {kA, kInRunSigma, 0.1, &u::kMg, kAssumed, kNoInRun},
    {kG, kInRunSigma, 20.0, &u::kDegPerH, kAssumed, kNoInRun}};

struct Sheet {
  ImuPart part{};
  std::vector<DatasheetValue> values{};

  bool has(Triad triad, ModelField field) const {
    return std::any_of(values.begin(), values.end(), [&](const DatasheetValue& v) {
      return v.triad == triad && v.field == field;
    });
  }
};

/// With what every sheet is silent about: the in-run drift of consumer parts, correlation times.
std::vector<Sheet> completed(std::vector<Sheet> sheets) {
  for (Sheet& sheet : sheets) {
    std::vector<DatasheetValue> values;
    const auto add = [&](const DatasheetValue& value) {
      values.push_back(value);
      if (value.field != kInRunSigma || sheet.has(value.triad, kInRunTau)) return;
      values.push_back({value.triad, kInRunTau, 500.0, &u::kS, kAssumed, kTau});
    };
    for (const DatasheetValue& value : sheet.values) {
      add(value);
      const bool drifts = sheet.part.grade == kConsumer && !sheet.has(value.triad, kInRunSigma);
      if (drifts && value.field == kBiasSigma) add(kConsumerInRun[value.triad == kG ? 1 : 0]);
    }
    sheet.values = std::move(values);
    sheet.part.values = sheet.values;
  }
  return sheets;
}

const std::vector<Sheet> kSheets = completed(
    {{{"MPU-9250", "InvenSense", kConsumer, "MEMS, MEMS",
       "MPU-9250 Product Specification, PS-MPU-9250A-01 rev. 1.1, 2016", kNotRead},
      {{kA, kBiasSigma, 60.0, &u::kMg, kSigma, "initial calibration tolerance, x and y"},
       {kA, kNoise, 300.0, &u::kUgPerSqrtHz, kSigma, "noise power spectral density"},
       {kA, kScaleSigma, 3.0, &u::kPercent, kSigma, "initial tolerance"},
       {kA, kMisalignmentSigma, 2.0, &u::kPercent, kSigma, "cross-axis sensitivity"},
       {kG, kBiasSigma, 5.0, &u::kDegPerS, kSigma, "initial ZRO tolerance"},
       {kG, kNoise, 0.01, &u::kDpsPerSqrtHz, kSigma, "rate noise spectral density"},
       {kG, kScaleSigma, 3.0, &u::kPercent, kSigma, "sensitivity scale factor tolerance"},
       {kG, kMisalignmentSigma, 2.0, &u::kPercent, kSigma, "cross-axis sensitivity"}}},
     {{"ICM-20948", "TDK InvenSense", kConsumer, "MEMS, MEMS",
       "ICM-20948 Datasheet, DS-000189 rev. 1.3, 2017", "the accelerometer's"},
      {{kA, kBiasSigma, 50.0, &u::kMg, kSigma, "zero-g initial tolerance, board level"},
       {kA, kNoise, 230.0, &u::kUgPerSqrtHz, kSigma, "noise spectral density"},
       {kA, kScaleSigma, 0.5, &u::kPercent, kSigma, "sensitivity initial tolerance"},
       {kA, kMisalignmentSigma, 2.0, &u::kPercent, kSigma, "cross-axis sensitivity"},
       {kG, kBiasSigma, 5.0, &u::kDegPerS, kSigma, "initial ZRO tolerance"},
       {kG, kNoise, 0.015, &u::kDpsPerSqrtHz, kSigma, "noise spectral density"},
       {kG, kScaleSigma, 1.5, &u::kPercent, kSigma, "sensitivity scale factor tolerance"},
       {kG, kMisalignmentSigma, 2.0, &u::kPercent, kSigma, "cross-axis sensitivity"}}},
     {{"BMI160", "Bosch Sensortec", kConsumer, "MEMS, MEMS", "BMI160 Data sheet, BST-BMI160-DS000",
       "zero-rate offset"},
      {{kA, kBiasSigma, 40.0, &u::kMg, kSigma, "zero-g offset"},
       {kA, kNoise, 180.0, &u::kUgPerSqrtHz, kSigma, "output noise density"},
       {kA, kMisalignmentSigma, 1.0, &u::kPercent, kSigma, "cross-axis sensitivity"},
       {kG, kBiasSigma, 3.0, &u::kDegPerS, kSigma, "zero-rate offset"},
       {kG, kNoise, 0.007, &u::kDpsPerSqrtHz, kSigma, "output noise density"},
       {kG, kScaleSigma, 3.0, &u::kPercent, kSigma, "sensitivity tolerance"}}},
     {{"BMI088", "Bosch Sensortec", kConsumer, "MEMS, MEMS",
       "BMI088 Data sheet, BST-BMI088-DS001 rev. 1.4, 2018", "both offsets"},
      {{kA, kBiasSigma, 20.0, &u::kMg, kSigma, "zero-g offset"},
       {kA, kNoise, 190.0, &u::kUgPerSqrtHz, kSigma, "output noise density, z axis"},
       {kA, kMisalignmentSigma, 0.5, &u::kPercent, kSigma, "cross-axis sensitivity"},
       {kG, kBiasSigma, 1.0, &u::kDegPerS, kSigma, "zero-rate offset"},
       {kG, kInRunSigma, 2.0, &u::kDegPerH, kAllanMinimum, "bias stability, below"},
       {kG, kNoise, 0.014, &u::kDpsPerSqrtHz, kSigma, "output noise density"},
       {kG, kScaleSigma, 1.0, &u::kPercent, kSigma, "sensitivity tolerance"},
       {kG, kMisalignmentSigma, 1.0, &u::kPercent, kSigma, "cross-axis sensitivity"}}},
     {{"LSM6DSO", "STMicroelectronics", kConsumer, "MEMS, MEMS", "LSM6DSO Datasheet, DS12140",
       kNotRead},
      {{kA, kBiasSigma, 20.0, &u::kMg, kSigma, "zero-g level offset accuracy"},
       {kA, kNoise, 70.0, &u::kUgPerSqrtHz, kSigma, "noise density, high performance"},
       {kA, kScaleSigma, 1.0, &u::kPercent, kSigma, "sensitivity tolerance"},
       {kG, kBiasSigma, 1.0, &u::kDegPerS, kSigma, "zero-rate level"},
       {kG, kNoise, 3.8, &u::kMdpsPerSqrtHz, kSigma, "rate noise density"},
       {kG, kScaleSigma, 1.0, &u::kPercent, kSigma, "sensitivity tolerance"}}},
     {{"ICM-42688-P", "TDK InvenSense", kConsumer, "MEMS, MEMS",
       "ICM-42688-P Datasheet, DS-000347 v1.7", "both noise densities"},
      {{kA, kBiasSigma, 20.0, &u::kMg, kSigma, "zero-g initial tolerance, board level"},
       {kA, kNoise, 70.0, &u::kUgPerSqrtHz, kSigma, "noise spectral density"},
       {kA, kScaleSigma, 0.5, &u::kPercent, kSigma, "sensitivity initial tolerance"},
       {kA, kMisalignmentSigma, 1.0, &u::kPercent, kSigma, "cross-axis sensitivity"},
       {kG, kBiasSigma, 0.5, &u::kDegPerS, kSigma, "initial ZRO tolerance"},
       {kG, kNoise, 2.8, &u::kMdpsPerSqrtHz, kSigma, "rate noise spectral density"},
       {kG, kScaleSigma, 0.5, &u::kPercent, kSigma, "sensitivity scale factor tolerance"},
       {kG, kMisalignmentSigma, 1.25, &u::kPercent, kSigma, "cross-axis sensitivity"}}},
     {{"ADIS16470", "Analog Devices", kIndustrial, "MEMS, MEMS", "ADIS16470 Data Sheet", kNotRead},
      {{kA, kBiasSigma, 16.0, &u::kMg, kAssumed, kAsAdis16488},
       {kA, kInRunSigma, 13.0, &u::kUg, kAllanMinimum, "in-run bias stability"},
       {kA, kNoise, 0.037, &u::kMpsPerSqrtH, kSigma, "velocity random walk"},
       {kG, kBiasSigma, 0.2, &u::kDegPerS, kAssumed, kAsAdis16488},
       {kG, kInRunSigma, 8.0, &u::kDegPerH, kAllanMinimum, "in-run bias stability"},
       {kG, kNoise, 0.34, &u::kDegPerSqrtH, kSigma, "angular random walk"}}},
     {{"MTi-300", "Movella Xsens", kIndustrial, "MEMS, MEMS",
       "MTi-300 data sheet, 2023; bias repeatability and non-orthogonality: MTi User Manual, "
       "MT0605P",
       "in-run stabilities, noise densities, g-sensitivity"},
      {{kA, kBiasSigma, 0.03, &u::kMps2, kSigma, "bias repeatability, 1 year"},
       {kA, kInRunSigma, 15.0, &u::kUg, kAllanMinimum, "in-run bias stability"},
       {kA, kNoise, 60.0, &u::kUgPerSqrtHz, kSigma, "noise density"},
       {kA, kMisalignmentSigma, 0.05, &u::kDeg, kSigma, "non-orthogonality"},
       {kG, kBiasSigma, 0.2, &u::kDegPerS, kSigma, "bias repeatability, 1 year"},
       {kG, kInRunSigma, 10.0, &u::kDegPerH, kAllanMinimum, "in-run bias stability"},
       {kG, kNoise, 0.01, &u::kDpsPerSqrtHz, kSigma, "noise density"},
       {kG, kMisalignmentSigma, 0.05, &u::kDeg, kSigma, "non-orthogonality"},
       {kG, kGSensitivitySigma, 0.003, &u::kDegPerSPerG, kSigma, "g-sensitivity"}}},
     {{"VN-100", "VectorNav", kIndustrial, "MEMS, MEMS", "VN-100 Product Brief",
       "both noise densities"},
      {{kA, kBiasSigma, 0.03, &u::kMps2, kAssumed, kAsMti300},
       {kA, kInRunSigma, 0.04, &u::kMg, kAllanMinimum, "in-run bias stability, below"},
       {kA, kNoise, 0.14, &u::kMgPerSqrtHz, kSigma, "noise density"},
       {kA, kMisalignmentSigma, 0.05, &u::kDeg, kSigma, "alignment error"},
       {kG, kBiasSigma, 0.2, &u::kDegPerS, kAssumed, kAsMti300},
       {kG, kInRunSigma, 10.0, &u::kDegPerH, kAllanMinimum, "in-run bias stability, below"},
       {kG, kNoise, 0.0035, &u::kDpsPerSqrtHz, kSigma, "noise density"},
       {kG, kMisalignmentSigma, 0.05, &u::kDeg, kSigma, "alignment error"}}},
     {{"ADIS16488A", "Analog Devices", kIndustrial, "MEMS, MEMS", "ADIS16488A Data Sheet",
       kNotRead},
      {{kA, kBiasSigma, 16.0, &u::kMg, kSigma, "bias repeatability, 1 sigma"},
       {kA, kInRunSigma, 0.07, &u::kMg, kAllanMinimum, "in-run bias stability"},
       {kA, kNoise, 0.029, &u::kMpsPerSqrtH, kSigma, "velocity random walk"},
       {kA, kScaleSigma, 0.5, &u::kPercent, kSigma, "sensitivity repeatability"},
       {kA, kMisalignmentSigma, 0.035, &u::kDeg, kSigma, "misalignment, axis to axis"},
       {kG, kBiasSigma, 0.2, &u::kDegPerS, kSigma, "bias repeatability, 1 sigma"},
       {kG, kInRunSigma, 5.1, &u::kDegPerH, kAllanMinimum, "in-run bias stability"},
       {kG, kNoise, 0.26, &u::kDegPerSqrtH, kSigma, "angular random walk"},
       {kG, kScaleSigma, 1.0, &u::kPercent, kSigma, "sensitivity repeatability"},
       {kG, kMisalignmentSigma, 0.05, &u::kDeg, kSigma, "misalignment, axis to axis"},
       {kG, kGSensitivitySigma, 0.009, &u::kDegPerSPerG, kSigma,
        "linear acceleration effect on bias"}}},
     {{"ADIS16495-1", "Analog Devices", kTactical, "MEMS, MEMS",
       "ADIS16495 Data Sheet rev. C, 2020",
       "in-run stabilities, angular random walk, misalignment"},
      {{kA, kBiasSigma, 16.0, &u::kMg, kAssumed, kAsAdis16488},
       {kA, kInRunSigma, 3.2, &u::kUg, kAllanMinimum, "in-run bias stability"},
       {kA, kNoise, 0.008, &u::kMpsPerSqrtH, kSigma, "velocity random walk"},
       {kG, kBiasSigma, 0.2, &u::kDegPerS, kAssumed, kAsAdis16488},
       {kG, kInRunSigma, 0.8, &u::kDegPerH, kAllanMinimum, "in-run bias stability"},
       {kG, kNoise, 0.09, &u::kDegPerSqrtH, kSigma, "angular random walk"},
       {kG, kMisalignmentSigma, 0.05, &u::kDeg, kSigma, "axis to axis misalignment"}}},
     {{"STIM300", "Safran Sensonor", kTactical, "MEMS, MEMS",
       "STIM300 Inertial Measurement Unit datasheet, TS1524 rev. 9", "all"},
      {{kA, kBiasSigma, 0.75, &u::kMg, kSigma, "bias on/off repeatability, 10 g range"},
       {kA, kInRunSigma, 0.05, &u::kMg, kAllanMinimum, "bias instability"},
       {kA, kInRunTau, 1000.0, &u::kS, kAssumed, kTau},
       {kA, kNoise, 0.06, &u::kMpsPerSqrtH, kSigma, "velocity random walk"},
       {kA, kScaleSigma, 300.0, &u::kPpm, kSigma, "scale factor accuracy"},
       {kA, kMisalignmentSigma, 1.0, &u::kMrad, kSigma, "misalignment"},
       {kG, kBiasSigma, 5.0, &u::kDegPerH, kSigma, "bias error over static temperature"},
       {kG, kInRunSigma, 0.5, &u::kDegPerH, kAllanMinimum, "bias instability"},
       {kG, kInRunTau, 1000.0, &u::kS, kAssumed, kTau},
       {kG, kNoise, 0.15, &u::kDegPerSqrtH, kSigma, "angular random walk"},
       {kG, kScaleSigma, 500.0, &u::kPpm, kSigma, "scale factor accuracy"},
       {kG, kMisalignmentSigma, 1.0, &u::kMrad, kSigma, "misalignment"},
       {kG, kGSensitivitySigma, 1.0, &u::kDegPerHPerG, kSigma,
        "linear acceleration effect, compensated"}}},
     {{"HG4930CA51", "Honeywell", kTactical, "MEMS, MEMS",
       "HG4930 Inertial Measurement Unit brochure (CA51)", kNotRead},
      {{kA, kBiasSigma, 1.7, &u::kMg, kSigma, "bias repeatability"},
       {kA, kInRunSigma, 0.025, &u::kMg, kAllanMinimum, "bias in-run stability"},
       {kA, kInRunTau, 1000.0, &u::kS, kAssumed, kTau},
       {kA, kNoise, 0.03, &u::kMpsPerSqrtH, kSigma, "velocity random walk"},
       {kG, kBiasSigma, 7.0, &u::kDegPerH, kSigma, "bias repeatability"},
       {kG, kInRunSigma, 0.25, &u::kDegPerH, kAllanMinimum, "bias in-run stability"},
       {kG, kInRunTau, 1000.0, &u::kS, kAssumed, kTau},
       {kG, kNoise, 0.04, &u::kDegPerSqrtH, kSigma, "angular random walk"}}},
     {{"HG1700", "Honeywell", kTactical, "ring laser, quartz beam",
       "HG1700 Inertial Measurement Unit brochure, N61-1619-000-001", "all"},
      {{kA, kBiasSigma, 1.0, &u::kMg, kSigma, "bias, 1 sigma"},
       {kA, kNoise, 0.065, &u::kFtpsPerSqrtH, kSigma, "velocity random walk, maximum"},
       {kG, kBiasSigma, 1.0, &u::kDegPerH, kSigma, "bias, 1 sigma"},
       {kG, kNoise, 0.125, &u::kDegPerSqrtH, kSigma, "angular random walk, maximum"}}},
     {{"KVH 1750", "KVH Industries", kTactical, "fibre-optic, MEMS", "1750 IMU data sheet (10 g)",
       kNotRead},
      {{kA, kBiasSigma, 2.0, &u::kMg, kMaximum, "bias offset"},
       {kA, kInRunSigma, 0.05, &u::kMg, kAllanMinimum, "bias instability, below"},
       {kA, kInRunTau, 1000.0, &u::kS, kAssumed, kTau},
       {kA, kNoise, 0.12, &u::kMgPerSqrtHz, kSigma, "velocity random walk"},
       {kA, kMisalignmentSigma, 1.0, &u::kMrad, kSigma, "axis misalignment"},
       {kG, kBiasSigma, 2.0, &u::kDegPerH, kMaximum, "bias offset"},
       {kG, kInRunSigma, 0.05, &u::kDegPerH, kAllanMinimum, "bias instability, typical"},
       {kG, kInRunTau, 3600.0, &u::kS, kAssumed, kTau},
       {kG, kNoise, 0.012, &u::kDegPerSqrtH, kSigma, "angle random walk"},
       {kG, kMisalignmentSigma, 0.4, &u::kMrad, kSigma, "axis misalignment"}}},
     {{"iIMU-FSAS", "iMAR Navigation", kTactical, "fibre-optic, quartz servo",
       "iIMU-FSAS data sheet", "all"},
      {{kA, kBiasSigma, 1.0, &u::kMg, kSigma, "bias"},
       {kA, kNoise, 0.03, &u::kMpsPerSqrtH, kSigma, "noise"},
       {kA, kScaleSigma, 300.0, &u::kPpm, kSigma, "scale factor"},
       {kG, kBiasSigma, 0.75, &u::kDegPerH, kSigma, "bias"},
       {kG, kNoise, 0.1, &u::kDegPerSqrtH, kSigma, "noise"},
       {kG, kScaleSigma, 300.0, &u::kPpm, kSigma, "scale factor"}}},
     {{"LN-200", "Northrop Grumman", kTactical, "fibre-optic, silicon",
       "LN-200 Fiber Optic Inertial Measurement Unit brochure", kNotRead},
      {{kA, kBiasSigma, 300.0, &u::kUg, kSigma, "bias repeatability, 1 sigma"},
       {kA, kNoise, 35.0, &u::kUgPerSqrtHz, kSigma, "white noise"},
       {kA, kScaleSigma, 300.0, &u::kPpm, kSigma, "scale factor stability"},
       {kA, kMisalignmentSigma, 0.1, &u::kMrad, kSigma, "axis alignment stability"},
       {kG, kBiasSigma, 1.0, &u::kDegPerH, kSigma, "bias repeatability, 1 sigma"},
       {kG, kNoise, 0.07, &u::kDegPerSqrtH, kSigma, "random walk"},
       {kG, kScaleSigma, 100.0, &u::kPpm, kSigma, "scale factor stability"},
       {kG, kMisalignmentSigma, 0.1, &u::kMrad, kSigma, "axis alignment stability"}}},
     {{"ISA-100C", "Northrop Grumman LITEF", kTactical, "fibre-optic, MEMS",
       "SPAN IMU-ISA-100C product sheet (NovAtel)", kNotRead},
      {{kA, kBiasSigma, 1250.0, &u::kUg, kSigma, "bias repeatability"},
       {kA, kNoise, 100.0, &u::kUgPerSqrtHz, kSigma, "noise, below"},
       {kA, kScaleSigma, 100.0, &u::kPpm, kSigma, "scale factor"},
       {kG, kBiasSigma, 0.5, &u::kDegPerH, kSigma, "rate bias"},
       {kG, kNoise, 0.012, &u::kDegPerSqrtH, kSigma, "angular random walk"},
       {kG, kScaleSigma, 100.0, &u::kPpm, kSigma, "scale factor"}}},
     {{"HG9900", "Honeywell", kNavigation, "ring laser, quartz pendulous",
       "HG9900 Inertial Measurement Unit brochure, N61-1638-000-000", "all"},
      {{kA, kBiasSigma, 25.0, &u::kUg, kSigma, "bias, 1 sigma"},
       {kA, kNoise, 8.0, &u::kUgPerSqrtHz, kAssumed, "noise: not printed, that of the iNAV-RQH"},
       {kA, kScaleSigma, 100.0, &u::kPpm, kSigma, "scale factor, 1 sigma"},
       {kG, kBiasSigma, 0.0035, &u::kDegPerH, kSigma, "bias, 1 sigma"},
       {kG, kNoise, 0.002, &u::kDegPerSqrtH, kSigma, "angular random walk, maximum"},
       {kG, kScaleSigma, 5.0, &u::kPpm, kSigma, "scale factor, 1 sigma"}}},
     {{"iNAV-RQH", "iMAR Navigation", kNavigation, "ring laser, quartz pendulous",
       "iNAV-RQH data sheet", kNotRead},
      {{kA, kBiasSigma, 25.0, &u::kUg, kSigma, "bias"},
       {kA, kNoise, 8.0, &u::kUgPerSqrtHz, kSigma, "noise"},
       {kG, kBiasSigma, 0.002, &u::kDegPerH, kSigma, "bias stability"},
       {kG, kNoise, 0.0015, &u::kDegPerSqrtH, kSigma, "random walk"},
       {kG, kScaleSigma, 5.0, &u::kPpm, kSigma, "scale factor error"}}}});

}  // namespace
}  // namespace sheets

std::span<const ImuPart> imu_parts() {
  static const std::vector<ImuPart> kParts = [] {
    std::vector<ImuPart> parts;
    for (const sheets::Sheet& sheet : sheets::kSheets) parts.push_back(sheet.part);
    return parts;
  }();
  return kParts;
}

}  // namespace leeway::sim
