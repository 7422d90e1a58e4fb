#include <spdlog/fmt/fmt.h>

#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/sensors/bias_model.hpp"
#include "leeway/sim/sensors/imu_catalogue.hpp"
#include "leeway/sim/sensors/imu_class_name.hpp"
#include "leeway/sim/sensors/imu_model_file.hpp"
#include "sim/scene/scene_sections.hpp"
#include "sim/scene/scene_units.hpp"
#include "sim/sensors/imu_model_section.hpp"

namespace leeway::sim {
namespace {

constexpr std::string_view kMems = "automotive-mems";
constexpr std::size_t kMostOutages = 10'000;

constexpr Quantity kBiasTau{"bias_tau", kTimes, between(10.0, 1e7)};
constexpr Quantity kInterval{"interval", kTimes, between(1e-3, kLongestSceneS)};
constexpr Quantity kLatency{"latency", kTimes, zero_or(1e-3, 60.0)};
constexpr Quantity kCorrelation{"correlation", kTimes, between(0.1, 1e5)};
constexpr Quantity kOutageStart{"start", kTimes, zero_or(1e-3, kLongestSceneS)};
constexpr Quantity kOutageDuration{"duration", kTimes, between(1e-3, kLongestSceneS)};
constexpr Quantity kVelocitySigma{"velocity_sigma", kSpeeds, between(1e-4, 20.0)};
constexpr Quantity kLeverArm{"lever_arm", kLengths, between(-100.0, 100.0)};
constexpr Quantity kOutlierProbability{"outlier_probability", {}, zero_or(1e-9, 0.5)};
constexpr Quantity kOutlierSigma{"outlier_sigma", kLengths, zero_or(0.1, 1e5)};
constexpr Quantity kTilt{"tilt", kAngles, zero_or(1e-7, 30.0 * kRadPerDeg)};
constexpr Quantity kInitialHeading{"heading", kAngles, zero_or(1e-7, 180.0 * kRadPerDeg)};
constexpr Quantity kInitialVelocity{"velocity", kSpeeds, zero_or(1e-4, 100.0)};
constexpr Quantity kInitialPosition{"position", kLengths, zero_or(1e-3, 1e5)};

/// A sigma of position: horizontal and vertical, or one for each axis.
struct PositionSigma {
  Quantity horizontal{};
  Quantity vertical{};
  Quantity per_axis{};
};
constexpr Range kSigmaLimits = zero_or(1e-3, 1e4);
constexpr PositionSigma kPositionSigma{{"position_sigma_h", kLengths, kSigmaLimits},
                                       {"position_sigma_v", kLengths, kSigmaLimits},
                                       {"position_sigma_ned", kLengths, kSigmaLimits}};
constexpr PositionSigma kCorrelatedSigma{{"correlated_sigma_h", kLengths, kSigmaLimits},
                                         {"correlated_sigma_v", kLengths, kSigmaLimits},
                                         {"correlated_sigma_ned", kLengths, kSigmaLimits}};

constexpr const char* kPerAxis = ", one for each of north, east, down: [n, e, d]";
constexpr const char* kOrPerAxis = ", or one for each of north, east, down: [n, e, d]";
constexpr const char* kForwardRightDown = ", one for each of forward, right, down: [x, y, z]";

NamedImuModel read_class(TomlSection& section, const std::string& wanted) {
  const auto range = section.choice<RangeEnd>("range");
  if (is_same_name(wanted, kMems)) {
    if (range) section.fail_at("range", "is for the Table 1 classes: automotive-mems has none");
    return {std::string(kMems), automotive_mems_model()};
  }
  const auto imu = from_name<ImuClass>(wanted);
  if (!imu) {
    std::vector<std::string_view> classes(kNames<ImuClass>.begin(), kNames<ImuClass>.end());
    classes.push_back(kMems);
    section.fail_unknown_word("class", wanted, classes);
  }
  const RangeEnd end = range.value_or(RangeEnd::kMid);
  return {imu_name({*imu, end}), imu_class_model(*imu, end)};
}

NamedImuModel read_part(const TomlSection& section, const std::string& wanted) {
  const ImuPart& part =
      usable(section, "part", [&]() -> const ImuPart& { return imu_part(wanted); });
  return {std::string(part.name), imu_model(part)};
}

NamedImuModel read_model_file(const TomlSection& section, const std::filesystem::path& folder,
                              const std::string& file) {
  return {file, usable(section, "model", [&] {
            require_text_file(folder / file);
            return read_imu_model(folder / file);
          })};
}

void apply_bias(TomlSection& section, ImuErrorModel& model) {
  const auto bias = section.choice<BiasModel>("bias");
  const auto tau_s = section.number(kBiasTau);
  if (tau_s && bias != BiasModel::kGaussMarkov) {
    section.fail("the bias correlation time needs bias = \"gauss_markov\"");
  }
  if (!bias) return;
  try {
    model = with_bias_model(model, *bias, tau_s.value_or(kBiasTauS));
  } catch (const Error& error) {
    section.fail_at("bias", error.what());
  }
}

void set_sigma(TomlSection& section, const PositionSigma& keys, Eigen::Vector3d& sigma_n_m) {
  const auto horizontal = section.value(keys.horizontal);
  const auto vertical = section.value(keys.vertical);
  const auto per_axis = section.value(keys.per_axis);
  if (per_axis && (horizontal || vertical)) {
    per_axis->fail_at_key(
        "and a sigma of the horizontal or vertical are the same quantity: give "
        "one");
  }
  if (horizontal) sigma_n_m.head<2>().setConstant(horizontal->number());
  if (vertical) sigma_n_m.z() = vertical->number();
  if (per_axis) sigma_n_m = per_axis->vector3(kPerAxis);
}

Outage read_outage(TomlSection& section) {
  Outage outage;
  outage.start_s = section.required(section.number(kOutageStart));
  outage.duration_s = section.required(section.number(kOutageDuration));
  return outage;
}

}  // namespace

NamedImuModel read_imu(TomlSection& section, const std::filesystem::path& folder) {
  const auto by_class = section.text("class");
  const auto part = section.text("part");
  const auto file = section.text("model");
  const bool is_inline = section.has("accelerometer") || section.has("gyro");
  if (by_class.has_value() + part.has_value() + file.has_value() + is_inline != 1) {
    section.fail(
        "an IMU is one of: class = \"tactical\" (or another), part = \"STIM300\" (or another of "
        "the catalogue), model = \"a file.toml\", or sections accelerometer and gyro of its own");
  }
  NamedImuModel imu;
  if (by_class) imu = read_class(section, *by_class);
  if (part) imu = read_part(section, *part);
  if (file) imu = read_model_file(section, folder, *file);
  if (is_inline) imu = {"scene's own", read_imu_model(section)};
  apply_bias(section, imu.model);
  return imu;
}

GnssScenario read_gnss(TomlSection& section, double duration_s, bool leave_out_late_outages) {
  GnssScenario gnss;
  GnssErrorModel& errors = gnss.errors;
  set_sigma(section, kPositionSigma, errors.position_sigma_n_m);
  set_sigma(section, kCorrelatedSigma, errors.correlated_sigma_n_m);
  if (const auto sigma = section.value(kVelocitySigma)) {
    errors.velocity_sigma_n_mps = sigma->is_array()
                                      ? sigma->vector3(kOrPerAxis)
                                      : Eigen::Vector3d::Constant(sigma->number(kOrPerAxis)).eval();
  }
  if (const auto lever = section.value(kLeverArm)) {
    errors.lever_arm_b_m = lever->vector3(kForwardRightDown);
  }
  set(section, kCorrelation, errors.correlation_time_s);
  set(section, kInterval, gnss.interval_s);
  set(section, kLatency, gnss.latency_s);
  set(section, kOutlierProbability, gnss.outlier_probability);
  set(section, kOutlierSigma, gnss.outlier_sigma_m);
  section.tables("outages", [&](TomlSection& entry) {
    if (gnss.outages.size() == kMostOutages) entry.fail("more than 10000 outages");
    const Outage outage = read_outage(entry);
    const bool is_within = outage.start_s + outage.duration_s <= duration_s;
    if (!is_within && !leave_out_late_outages) {
      entry.fail(fmt::format("the outage ends at {:.9g} s, after the scene's end at {:.9g} s",
                             outage.start_s + outage.duration_s, duration_s));
    }
    if (outage.start_s < duration_s) gnss.outages.push_back(outage);
  });
  if (gnss.interval_s > duration_s) {
    section.fail(
        fmt::format("the interval of {:.9g} s is longer than the scene of {:.9g} s: no fix",
                    gnss.interval_s, duration_s));
  }
  if (((errors.position_sigma_n_m + errors.correlated_sigma_n_m).array() <= 0.0).any()) {
    section.fail("position_sigma and correlated_sigma are both 0 on an axis: no receiver is exact");
  }
  return gnss;
}

InitialSigma read_initial(TomlSection& section) {
  InitialSigma sigma;
  sigma.tilt_rad = section.required(section.number(kTilt));
  sigma.heading_rad = section.required(section.number(kInitialHeading));
  sigma.velocity_mps = section.required(section.number(kInitialVelocity));
  sigma.position_m = section.required(section.number(kInitialPosition));
  return sigma;
}

}  // namespace leeway::sim
