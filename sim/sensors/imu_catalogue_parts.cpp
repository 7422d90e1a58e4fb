// The data of the catalogue: numbers as printed, in the units they are printed in. What no
// datasheet prints is either marked assumed, with the reason, or left out and thus zero in the
// model.
#include <array>

#include "leeway/sim/sensors/imu_catalogue.hpp"

namespace leeway::sim {
namespace {

namespace u = leeway::units;
using enum ModelField;
using enum Meaning;
constexpr Triad kA = Triad::kAccelerometer;
constexpr Triad kG = Triad::kGyro;

constexpr const char* kTau = "correlation time: printed nowhere";
constexpr const char* kNoInRun = "in-run drift: not printed, of the order of its kind";
constexpr const char* kNotRead = "none";

constexpr std::array kMpu9250{
    DatasheetValue{kA, kBiasSigma, 60.0, &u::kMg, kSigma, "initial calibration tolerance, x and y"},
    DatasheetValue{kA, kInRunSigma, 0.1, &u::kMg, kAssumed, kNoInRun},
    DatasheetValue{kA, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kA, kNoise, 300.0, &u::kUgPerSqrtHz, kSigma, "noise power spectral density"},
    DatasheetValue{kA, kScaleSigma, 3.0, &u::kPercent, kSigma, "initial tolerance"},
    DatasheetValue{kA, kMisalignmentSigma, 2.0, &u::kPercent, kSigma, "cross-axis sensitivity"},
    DatasheetValue{kG, kBiasSigma, 5.0, &u::kDegPerS, kSigma, "initial ZRO tolerance"},
    DatasheetValue{kG, kInRunSigma, 20.0, &u::kDegPerH, kAssumed, kNoInRun},
    DatasheetValue{kG, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kG, kNoise, 0.01, &u::kDpsPerSqrtHz, kSigma, "rate noise spectral density"},
    DatasheetValue{kG, kScaleSigma, 3.0, &u::kPercent, kSigma,
                   "sensitivity scale factor tolerance"},
    DatasheetValue{kG, kMisalignmentSigma, 2.0, &u::kPercent, kSigma, "cross-axis sensitivity"}};

constexpr std::array kIcm20948{
    DatasheetValue{kA, kBiasSigma, 50.0, &u::kMg, kSigma, "zero-g initial tolerance, board level"},
    DatasheetValue{kA, kInRunSigma, 0.1, &u::kMg, kAssumed, kNoInRun},
    DatasheetValue{kA, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kA, kNoise, 230.0, &u::kUgPerSqrtHz, kSigma, "noise spectral density"},
    DatasheetValue{kA, kScaleSigma, 0.5, &u::kPercent, kSigma, "sensitivity initial tolerance"},
    DatasheetValue{kA, kMisalignmentSigma, 2.0, &u::kPercent, kSigma, "cross-axis sensitivity"},
    DatasheetValue{kG, kBiasSigma, 5.0, &u::kDegPerS, kSigma, "initial ZRO tolerance"},
    DatasheetValue{kG, kInRunSigma, 20.0, &u::kDegPerH, kAssumed, kNoInRun},
    DatasheetValue{kG, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kG, kNoise, 0.015, &u::kDpsPerSqrtHz, kSigma, "noise spectral density"},
    DatasheetValue{kG, kScaleSigma, 1.5, &u::kPercent, kSigma,
                   "sensitivity scale factor tolerance"},
    DatasheetValue{kG, kMisalignmentSigma, 2.0, &u::kPercent, kSigma, "cross-axis sensitivity"}};

constexpr std::array kBmi160{
    DatasheetValue{kA, kBiasSigma, 40.0, &u::kMg, kSigma, "zero-g offset"},
    DatasheetValue{kA, kInRunSigma, 0.1, &u::kMg, kAssumed, kNoInRun},
    DatasheetValue{kA, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kA, kNoise, 180.0, &u::kUgPerSqrtHz, kSigma, "output noise density"},
    DatasheetValue{kA, kMisalignmentSigma, 1.0, &u::kPercent, kSigma, "cross-axis sensitivity"},
    DatasheetValue{kG, kBiasSigma, 3.0, &u::kDegPerS, kSigma, "zero-rate offset"},
    DatasheetValue{kG, kInRunSigma, 20.0, &u::kDegPerH, kAssumed, kNoInRun},
    DatasheetValue{kG, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kG, kNoise, 0.007, &u::kDpsPerSqrtHz, kSigma, "output noise density"},
    DatasheetValue{kG, kScaleSigma, 3.0, &u::kPercent, kSigma, "sensitivity tolerance"}};

constexpr std::array kBmi088{
    DatasheetValue{kA, kBiasSigma, 20.0, &u::kMg, kSigma, "zero-g offset"},
    DatasheetValue{kA, kInRunSigma, 0.1, &u::kMg, kAssumed, kNoInRun},
    DatasheetValue{kA, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kA, kNoise, 190.0, &u::kUgPerSqrtHz, kSigma, "output noise density, z axis"},
    DatasheetValue{kA, kMisalignmentSigma, 0.5, &u::kPercent, kSigma, "cross-axis sensitivity"},
    DatasheetValue{kG, kBiasSigma, 1.0, &u::kDegPerS, kSigma, "zero-rate offset"},
    DatasheetValue{kG, kInRunSigma, 2.0, &u::kDegPerH, kAllanMinimum, "bias stability, below"},
    DatasheetValue{kG, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kG, kNoise, 0.014, &u::kDpsPerSqrtHz, kSigma, "output noise density"},
    DatasheetValue{kG, kScaleSigma, 1.0, &u::kPercent, kSigma, "sensitivity tolerance"},
    DatasheetValue{kG, kMisalignmentSigma, 1.0, &u::kPercent, kSigma, "cross-axis sensitivity"}};

constexpr std::array kLsm6dso{
    DatasheetValue{kA, kBiasSigma, 20.0, &u::kMg, kSigma, "zero-g level offset accuracy"},
    DatasheetValue{kA, kInRunSigma, 0.1, &u::kMg, kAssumed, kNoInRun},
    DatasheetValue{kA, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kA, kNoise, 70.0, &u::kUgPerSqrtHz, kSigma, "noise density, high performance"},
    DatasheetValue{kA, kScaleSigma, 1.0, &u::kPercent, kSigma, "sensitivity tolerance"},
    DatasheetValue{kG, kBiasSigma, 1.0, &u::kDegPerS, kSigma, "zero-rate level"},
    DatasheetValue{kG, kInRunSigma, 20.0, &u::kDegPerH, kAssumed, kNoInRun},
    DatasheetValue{kG, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kG, kNoise, 3.8, &u::kMdpsPerSqrtHz, kSigma, "rate noise density"},
    DatasheetValue{kG, kScaleSigma, 1.0, &u::kPercent, kSigma, "sensitivity tolerance"}};

constexpr std::array kIcm42688{
    DatasheetValue{kA, kBiasSigma, 20.0, &u::kMg, kSigma, "zero-g initial tolerance, board level"},
    DatasheetValue{kA, kInRunSigma, 0.1, &u::kMg, kAssumed, kNoInRun},
    DatasheetValue{kA, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kA, kNoise, 70.0, &u::kUgPerSqrtHz, kSigma, "noise spectral density"},
    DatasheetValue{kA, kScaleSigma, 0.5, &u::kPercent, kSigma, "sensitivity initial tolerance"},
    DatasheetValue{kA, kMisalignmentSigma, 1.0, &u::kPercent, kSigma, "cross-axis sensitivity"},
    DatasheetValue{kG, kBiasSigma, 0.5, &u::kDegPerS, kSigma, "initial ZRO tolerance"},
    DatasheetValue{kG, kInRunSigma, 20.0, &u::kDegPerH, kAssumed, kNoInRun},
    DatasheetValue{kG, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kG, kNoise, 2.8, &u::kMdpsPerSqrtHz, kSigma, "rate noise spectral density"},
    DatasheetValue{kG, kScaleSigma, 0.5, &u::kPercent, kSigma,
                   "sensitivity scale factor tolerance"},
    DatasheetValue{kG, kMisalignmentSigma, 1.25, &u::kPercent, kSigma, "cross-axis sensitivity"}};

constexpr const char* kAsAdis16488 = "bias at turn-on: that of the ADIS16488A";

constexpr std::array kAdis16470{
    DatasheetValue{kA, kBiasSigma, 16.0, &u::kMg, kAssumed, kAsAdis16488},
    DatasheetValue{kA, kInRunSigma, 13.0, &u::kUg, kAllanMinimum, "in-run bias stability"},
    DatasheetValue{kA, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kA, kNoise, 0.037, &u::kMpsPerSqrtH, kSigma, "velocity random walk"},
    DatasheetValue{kG, kBiasSigma, 0.2, &u::kDegPerS, kAssumed, kAsAdis16488},
    DatasheetValue{kG, kInRunSigma, 8.0, &u::kDegPerH, kAllanMinimum, "in-run bias stability"},
    DatasheetValue{kG, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kG, kNoise, 0.34, &u::kDegPerSqrtH, kSigma, "angular random walk"}};

constexpr std::array kMti300{
    DatasheetValue{kA, kBiasSigma, 0.03, &u::kMps2, kSigma, "bias repeatability, 1 year"},
    DatasheetValue{kA, kInRunSigma, 15.0, &u::kUg, kAllanMinimum, "in-run bias stability"},
    DatasheetValue{kA, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kA, kNoise, 60.0, &u::kUgPerSqrtHz, kSigma, "noise density"},
    DatasheetValue{kA, kMisalignmentSigma, 0.05, &u::kDeg, kSigma, "non-orthogonality"},
    DatasheetValue{kG, kBiasSigma, 0.2, &u::kDegPerS, kSigma, "bias repeatability, 1 year"},
    DatasheetValue{kG, kInRunSigma, 10.0, &u::kDegPerH, kAllanMinimum, "in-run bias stability"},
    DatasheetValue{kG, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kG, kNoise, 0.01, &u::kDpsPerSqrtHz, kSigma, "noise density"},
    DatasheetValue{kG, kMisalignmentSigma, 0.05, &u::kDeg, kSigma, "non-orthogonality"},
    DatasheetValue{kG, kGSensitivitySigma, 0.003, &u::kDegPerSPerG, kSigma, "g-sensitivity"}};

constexpr const char* kAsMti300 = "bias at turn-on: that of the MTi-300";

constexpr std::array kVn100{
    DatasheetValue{kA, kBiasSigma, 0.03, &u::kMps2, kAssumed, kAsMti300},
    DatasheetValue{kA, kInRunSigma, 0.04, &u::kMg, kAllanMinimum, "in-run bias stability, below"},
    DatasheetValue{kA, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kA, kNoise, 0.14, &u::kMgPerSqrtHz, kSigma, "noise density"},
    DatasheetValue{kA, kMisalignmentSigma, 0.05, &u::kDeg, kSigma, "alignment error"},
    DatasheetValue{kG, kBiasSigma, 0.2, &u::kDegPerS, kAssumed, kAsMti300},
    DatasheetValue{kG, kInRunSigma, 10.0, &u::kDegPerH, kAllanMinimum,
                   "in-run bias stability, below"},
    DatasheetValue{kG, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kG, kNoise, 0.0035, &u::kDpsPerSqrtHz, kSigma, "noise density"},
    DatasheetValue{kG, kMisalignmentSigma, 0.05, &u::kDeg, kSigma, "alignment error"}};

constexpr std::array kAdis16488a{
    DatasheetValue{kA, kBiasSigma, 16.0, &u::kMg, kSigma, "bias repeatability, 1 sigma"},
    DatasheetValue{kA, kInRunSigma, 0.07, &u::kMg, kAllanMinimum, "in-run bias stability"},
    DatasheetValue{kA, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kA, kNoise, 0.029, &u::kMpsPerSqrtH, kSigma, "velocity random walk"},
    DatasheetValue{kA, kScaleSigma, 0.5, &u::kPercent, kSigma, "sensitivity repeatability"},
    DatasheetValue{kA, kMisalignmentSigma, 0.035, &u::kDeg, kSigma, "misalignment, axis to axis"},
    DatasheetValue{kG, kBiasSigma, 0.2, &u::kDegPerS, kSigma, "bias repeatability, 1 sigma"},
    DatasheetValue{kG, kInRunSigma, 5.1, &u::kDegPerH, kAllanMinimum, "in-run bias stability"},
    DatasheetValue{kG, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kG, kNoise, 0.26, &u::kDegPerSqrtH, kSigma, "angular random walk"},
    DatasheetValue{kG, kScaleSigma, 1.0, &u::kPercent, kSigma, "sensitivity repeatability"},
    DatasheetValue{kG, kMisalignmentSigma, 0.05, &u::kDeg, kSigma, "misalignment, axis to axis"},
    DatasheetValue{kG, kGSensitivitySigma, 0.009, &u::kDegPerSPerG, kSigma,
                   "linear acceleration effect on bias"}};

constexpr std::array kAdis16495{
    DatasheetValue{kA, kBiasSigma, 16.0, &u::kMg, kAssumed, kAsAdis16488},
    DatasheetValue{kA, kInRunSigma, 3.2, &u::kUg, kAllanMinimum, "in-run bias stability"},
    DatasheetValue{kA, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kA, kNoise, 0.008, &u::kMpsPerSqrtH, kSigma, "velocity random walk"},
    DatasheetValue{kG, kBiasSigma, 0.2, &u::kDegPerS, kAssumed, kAsAdis16488},
    DatasheetValue{kG, kInRunSigma, 0.8, &u::kDegPerH, kAllanMinimum, "in-run bias stability"},
    DatasheetValue{kG, kInRunTau, 500.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kG, kNoise, 0.09, &u::kDegPerSqrtH, kSigma, "angular random walk"},
    DatasheetValue{kG, kMisalignmentSigma, 0.05, &u::kDeg, kSigma, "axis to axis misalignment"}};

constexpr std::array kStim300{
    DatasheetValue{kA, kBiasSigma, 0.75, &u::kMg, kSigma, "bias on/off repeatability, 10 g range"},
    DatasheetValue{kA, kInRunSigma, 0.05, &u::kMg, kAllanMinimum, "bias instability"},
    DatasheetValue{kA, kInRunTau, 1000.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kA, kNoise, 0.06, &u::kMpsPerSqrtH, kSigma, "velocity random walk"},
    DatasheetValue{kA, kScaleSigma, 300.0, &u::kPpm, kSigma, "scale factor accuracy"},
    DatasheetValue{kA, kMisalignmentSigma, 1.0, &u::kMrad, kSigma, "misalignment"},
    DatasheetValue{kG, kBiasSigma, 5.0, &u::kDegPerH, kSigma, "bias error over static temperature"},
    DatasheetValue{kG, kInRunSigma, 0.5, &u::kDegPerH, kAllanMinimum, "bias instability"},
    DatasheetValue{kG, kInRunTau, 1000.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kG, kNoise, 0.15, &u::kDegPerSqrtH, kSigma, "angular random walk"},
    DatasheetValue{kG, kScaleSigma, 500.0, &u::kPpm, kSigma, "scale factor accuracy"},
    DatasheetValue{kG, kMisalignmentSigma, 1.0, &u::kMrad, kSigma, "misalignment"},
    DatasheetValue{kG, kGSensitivitySigma, 1.0, &u::kDegPerHPerG, kSigma,
                   "linear acceleration effect, compensated"}};

constexpr std::array kHg4930{
    DatasheetValue{kA, kBiasSigma, 1.7, &u::kMg, kSigma, "bias repeatability"},
    DatasheetValue{kA, kInRunSigma, 0.025, &u::kMg, kAllanMinimum, "bias in-run stability"},
    DatasheetValue{kA, kInRunTau, 1000.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kA, kNoise, 0.03, &u::kMpsPerSqrtH, kSigma, "velocity random walk"},
    DatasheetValue{kG, kBiasSigma, 7.0, &u::kDegPerH, kSigma, "bias repeatability"},
    DatasheetValue{kG, kInRunSigma, 0.25, &u::kDegPerH, kAllanMinimum, "bias in-run stability"},
    DatasheetValue{kG, kInRunTau, 1000.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kG, kNoise, 0.04, &u::kDegPerSqrtH, kSigma, "angular random walk"}};

constexpr std::array kHg1700{
    DatasheetValue{kA, kBiasSigma, 1.0, &u::kMg, kSigma, "bias, 1 sigma"},
    DatasheetValue{kA, kNoise, 0.065, &u::kFtpsPerSqrtH, kSigma, "velocity random walk, maximum"},
    DatasheetValue{kG, kBiasSigma, 1.0, &u::kDegPerH, kSigma, "bias, 1 sigma"},
    DatasheetValue{kG, kNoise, 0.125, &u::kDegPerSqrtH, kSigma, "angular random walk, maximum"}};

constexpr std::array kKvh1750{
    DatasheetValue{kA, kBiasSigma, 2.0, &u::kMg, kMaximum, "bias offset"},
    DatasheetValue{kA, kInRunSigma, 0.05, &u::kMg, kAllanMinimum, "bias instability, below"},
    DatasheetValue{kA, kInRunTau, 1000.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kA, kNoise, 0.12, &u::kMgPerSqrtHz, kSigma, "velocity random walk"},
    DatasheetValue{kA, kMisalignmentSigma, 1.0, &u::kMrad, kSigma, "axis misalignment"},
    DatasheetValue{kG, kBiasSigma, 2.0, &u::kDegPerH, kMaximum, "bias offset"},
    DatasheetValue{kG, kInRunSigma, 0.05, &u::kDegPerH, kAllanMinimum, "bias instability, typical"},
    DatasheetValue{kG, kInRunTau, 3600.0, &u::kS, kAssumed, kTau},
    DatasheetValue{kG, kNoise, 0.012, &u::kDegPerSqrtH, kSigma, "angle random walk"},
    DatasheetValue{kG, kMisalignmentSigma, 0.4, &u::kMrad, kSigma, "axis misalignment"}};

constexpr std::array kFsas{
    DatasheetValue{kA, kBiasSigma, 1.0, &u::kMg, kSigma, "bias"},
    DatasheetValue{kA, kNoise, 0.03, &u::kMpsPerSqrtH, kSigma, "noise"},
    DatasheetValue{kA, kScaleSigma, 300.0, &u::kPpm, kSigma, "scale factor"},
    DatasheetValue{kG, kBiasSigma, 0.75, &u::kDegPerH, kSigma, "bias"},
    DatasheetValue{kG, kNoise, 0.1, &u::kDegPerSqrtH, kSigma, "noise"},
    DatasheetValue{kG, kScaleSigma, 300.0, &u::kPpm, kSigma, "scale factor"}};

constexpr std::array kLn200{
    DatasheetValue{kA, kBiasSigma, 300.0, &u::kUg, kSigma, "bias repeatability, 1 sigma"},
    DatasheetValue{kA, kNoise, 35.0, &u::kUgPerSqrtHz, kSigma, "white noise"},
    DatasheetValue{kA, kScaleSigma, 300.0, &u::kPpm, kSigma, "scale factor stability"},
    DatasheetValue{kA, kMisalignmentSigma, 0.1, &u::kMrad, kSigma, "axis alignment stability"},
    DatasheetValue{kG, kBiasSigma, 1.0, &u::kDegPerH, kSigma, "bias repeatability, 1 sigma"},
    DatasheetValue{kG, kNoise, 0.07, &u::kDegPerSqrtH, kSigma, "random walk"},
    DatasheetValue{kG, kScaleSigma, 100.0, &u::kPpm, kSigma, "scale factor stability"},
    DatasheetValue{kG, kMisalignmentSigma, 0.1, &u::kMrad, kSigma, "axis alignment stability"}};

constexpr std::array kIsa100c{
    DatasheetValue{kA, kBiasSigma, 1250.0, &u::kUg, kSigma, "bias repeatability"},
    DatasheetValue{kA, kNoise, 100.0, &u::kUgPerSqrtHz, kSigma, "noise, below"},
    DatasheetValue{kA, kScaleSigma, 100.0, &u::kPpm, kSigma, "scale factor"},
    DatasheetValue{kG, kBiasSigma, 0.5, &u::kDegPerH, kSigma, "rate bias"},
    DatasheetValue{kG, kNoise, 0.012, &u::kDegPerSqrtH, kSigma, "angular random walk"},
    DatasheetValue{kG, kScaleSigma, 100.0, &u::kPpm, kSigma, "scale factor"}};

constexpr std::array kHg9900{
    DatasheetValue{kA, kBiasSigma, 25.0, &u::kUg, kSigma, "bias, 1 sigma"},
    DatasheetValue{kA, kNoise, 8.0, &u::kUgPerSqrtHz, kAssumed,
                   "noise: not printed, that of the iNAV-RQH"},
    DatasheetValue{kA, kScaleSigma, 100.0, &u::kPpm, kSigma, "scale factor, 1 sigma"},
    DatasheetValue{kG, kBiasSigma, 0.0035, &u::kDegPerH, kSigma, "bias, 1 sigma"},
    DatasheetValue{kG, kNoise, 0.002, &u::kDegPerSqrtH, kSigma, "angular random walk, maximum"},
    DatasheetValue{kG, kScaleSigma, 5.0, &u::kPpm, kSigma, "scale factor, 1 sigma"}};

constexpr std::array kRqh{
    DatasheetValue{kA, kBiasSigma, 25.0, &u::kUg, kSigma, "bias"},
    DatasheetValue{kA, kNoise, 8.0, &u::kUgPerSqrtHz, kSigma, "noise"},
    DatasheetValue{kG, kBiasSigma, 0.002, &u::kDegPerH, kSigma, "bias stability"},
    DatasheetValue{kG, kNoise, 0.0015, &u::kDegPerSqrtH, kSigma, "random walk"},
    DatasheetValue{kG, kScaleSigma, 5.0, &u::kPpm, kSigma, "scale factor error"}};

using enum Grade;

constexpr std::array kParts{
    ImuPart{"MPU-9250", "InvenSense", kConsumer, "MEMS, MEMS",
            "MPU-9250 Product Specification, PS-MPU-9250A-01 rev. 1.1, 2016", kNotRead, kMpu9250},
    ImuPart{"ICM-20948", "TDK InvenSense", kConsumer, "MEMS, MEMS",
            "ICM-20948 Datasheet, DS-000189 rev. 1.3, 2017", "the accelerometer's", kIcm20948},
    ImuPart{"BMI160", "Bosch Sensortec", kConsumer, "MEMS, MEMS",
            "BMI160 Data sheet, BST-BMI160-DS000", "zero-rate offset", kBmi160},
    ImuPart{"BMI088", "Bosch Sensortec", kConsumer, "MEMS, MEMS",
            "BMI088 Data sheet, BST-BMI088-DS001 rev. 1.4, 2018", "both offsets", kBmi088},
    ImuPart{"LSM6DSO", "STMicroelectronics", kConsumer, "MEMS, MEMS", "LSM6DSO Datasheet, DS12140",
            kNotRead, kLsm6dso},
    ImuPart{"ICM-42688-P", "TDK InvenSense", kConsumer, "MEMS, MEMS",
            "ICM-42688-P Datasheet, DS-000347 v1.7", "both noise densities", kIcm42688},
    ImuPart{"ADIS16470", "Analog Devices", kIndustrial, "MEMS, MEMS", "ADIS16470 Data Sheet",
            kNotRead, kAdis16470},
    ImuPart{"MTi-300", "Movella Xsens", kIndustrial, "MEMS, MEMS",
            "MTi-300 data sheet, 2023; bias repeatability and non-orthogonality: MTi User Manual, "
            "MT0605P",
            "in-run stabilities, noise densities, g-sensitivity", kMti300},
    ImuPart{"VN-100", "VectorNav", kIndustrial, "MEMS, MEMS", "VN-100 Product Brief",
            "both noise densities", kVn100},
    ImuPart{"ADIS16488A", "Analog Devices", kIndustrial, "MEMS, MEMS", "ADIS16488A Data Sheet",
            kNotRead, kAdis16488a},
    ImuPart{"ADIS16495-1", "Analog Devices", kTactical, "MEMS, MEMS",
            "ADIS16495 Data Sheet rev. C, 2020",
            "in-run stabilities, angular random walk, misalignment", kAdis16495},
    ImuPart{"STIM300", "Safran Sensonor", kTactical, "MEMS, MEMS",
            "STIM300 Inertial Measurement Unit datasheet, TS1524 rev. 9", "all", kStim300},
    ImuPart{"HG4930CA51", "Honeywell", kTactical, "MEMS, MEMS",
            "HG4930 Inertial Measurement Unit brochure (CA51)", kNotRead, kHg4930},
    ImuPart{"HG1700", "Honeywell", kTactical, "ring laser, quartz beam",
            "HG1700 Inertial Measurement Unit brochure, N61-1619-000-001", "all", kHg1700},
    ImuPart{"KVH 1750", "KVH Industries", kTactical, "fibre-optic, MEMS",
            "1750 IMU data sheet (10 g)", kNotRead, kKvh1750},
    ImuPart{"iIMU-FSAS", "iMAR Navigation", kTactical, "fibre-optic, quartz servo",
            "iIMU-FSAS data sheet", "all", kFsas},
    ImuPart{"LN-200", "Northrop Grumman", kTactical, "fibre-optic, silicon",
            "LN-200 Fiber Optic Inertial Measurement Unit brochure", kNotRead, kLn200},
    ImuPart{"ISA-100C", "Northrop Grumman LITEF", kTactical, "fibre-optic, MEMS",
            "SPAN IMU-ISA-100C product sheet (NovAtel)", kNotRead, kIsa100c},
    ImuPart{"HG9900", "Honeywell", kNavigation, "ring laser, quartz pendulous",
            "HG9900 Inertial Measurement Unit brochure, N61-1638-000-000", "all", kHg9900},
    ImuPart{"iNAV-RQH", "iMAR Navigation", kNavigation, "ring laser, quartz pendulous",
            "iNAV-RQH data sheet", kNotRead, kRqh}};

}  // namespace

std::span<const ImuPart> imu_parts() { return kParts; }

}  // namespace leeway::sim
