#include "sim/sensors/imu_model_section.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "leeway/earth/units.hpp"
#include "sim/sensors/imu_relations.hpp"

namespace leeway::sim {
namespace {

namespace u = leeway::units;

/// What a section can state of a triad, and within which limits: no real sensor is outside, what is
/// outside is a slip of the unit. A constant that is known may be of any size below the upper one.
struct TriadQuantities {
  Quantity bias{};
  Quantity bias_sigma{};
  Quantity in_run_sigma{};
  Quantity in_run_tau{"in_run_tau", {&u::kS}, between(1e-3, 1e8)};
  Quantity noise{};
  Quantity scale{"scale", {&u::kPpm, &u::kPercent}, between(-0.2, 0.2)};
  Quantity scale_sigma{"scale_sigma", {&u::kPpm, &u::kPercent}, zero_or(1e-7, 0.2)};
  Quantity misalignment{"misalignment", {&u::kMrad, &u::kDeg, &u::kArcsec}, between(-0.2, 0.2)};
  Quantity misalignment_sigma{
      "misalignment_sigma", {&u::kMrad, &u::kDeg, &u::kArcsec}, zero_or(1e-7, 0.2)};
  Quantity quantum{};
  Quantity range{};
};

using UnitList = std::array<const Unit*, 4>;
constexpr UnitList kAccelerationUnits{&u::kMps2, &u::kMg, &u::kUg};
constexpr UnitList kRate{&u::kDegPerH, &u::kDegPerS, &u::kRadps};
constexpr UnitList kGSensitivity{&u::kDegPerHPerG, &u::kDegPerSPerG};

constexpr TriadQuantities kAccelerometer{
    .bias = {"bias", kAccelerationUnits, between(-2.0 * u::kG, 2.0 * u::kG)},
    .bias_sigma = {"bias_sigma", kAccelerationUnits, zero_or(0.1 * u::kUg.si, u::kG)},
    .in_run_sigma = {"in_run_sigma", kAccelerationUnits, zero_or(0.01 * u::kUg.si, u::kG)},
    .noise = {"noise",
              {&u::kUgPerSqrtHz, &u::kMpsPerSqrtH},
              zero_or(0.05 * u::kUgPerSqrtHz.si, 2e4 * u::kUgPerSqrtHz.si)},
    .quantum = {"quantum", {&u::kMps}, zero_or(1e-9, 1.0)},
    .range = {"range", {&u::kMps2, &u::kStandardG}, between(0.1 * u::kG, 1e4 * u::kG)},
};

constexpr TriadQuantities kGyro{
    .bias = {"bias", kRate, between(-30.0 * u::kDegPerS.si, 30.0 * u::kDegPerS.si)},
    .bias_sigma = {"bias_sigma", kRate, zero_or(1e-6 * u::kDegPerH.si, 10.0 * u::kDegPerS.si)},
    .in_run_sigma = {"in_run_sigma", kRate, zero_or(1e-6 * u::kDegPerH.si, 10.0 * u::kDegPerS.si)},
    .noise = {"noise",
              {&u::kDegPerSqrtH, &u::kDpsPerSqrtHz},
              zero_or(1e-5 * u::kDegPerSqrtH.si, 100.0 * u::kDegPerSqrtH.si)},
    .quantum = {"quantum", {&u::kRad, &u::kArcsec}, zero_or(1e-12, 0.1)},
    .range = {"range", {&u::kDegPerS}, between(u::kDegPerS.si, 1e5 * u::kDegPerS.si)},
};

constexpr Quantity kGyroG{"g_sensitivity", kGSensitivity,
                          between(-1e5 * u::kDegPerHPerG.si, 1e5 * u::kDegPerHPerG.si)};
constexpr Quantity kGyroGSigma{"g_sensitivity_sigma", kGSensitivity,
                               zero_or(1e-5 * u::kDegPerHPerG.si, 1e5 * u::kDegPerHPerG.si)};

constexpr const char* kEachAxis = ", one for each axis: [x, y, z]";
constexpr const char* kOrEachAxis = ", or one for each axis: [x, y, z]";
constexpr const char* kOrMatrix = ", or 3 x 3";
constexpr const char* kSix =
    ", six of them: [xy, xz, yx, yz, zx, zy], or 3 x 3 with a zero diagonal";

Eigen::Matrix3d matrix3(const TomlValue& value, const char* otherwise) {
  const std::vector<TomlValue> rows = value.entries(3, otherwise);
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i) {
    m.row(i) = rows[static_cast<std::size_t>(i)].vector3(otherwise).transpose();
  }
  return m;
}

Eigen::Matrix3d misalignment(const TomlValue& value) {
  if (value.size() == 3) {
    const Eigen::Matrix3d m = matrix3(value, kSix);
    if (!m.diagonal().isZero(0.0)) {
      value.fail("has a diagonal: scale factor errors belong to scale_ppm");
    }
    return m;
  }
  const std::vector<double> v = value.numbers(6, kSix);
  Eigen::Matrix3d m;
  m << 0.0, v[0], v[1], v[2], 0.0, v[3], v[4], v[5], 0.0;
  return m;
}

Eigen::Matrix3d diagonal(double value) { return value * Eigen::Matrix3d::Identity(); }

double number(const std::optional<TomlValue>& value) { return value ? value->number() : 0.0; }

/// One model while it is read, with what was written where.
class ModelSection {
 public:
  ImuErrorModel read(TomlSection& parent) {
    parent.table("accelerometer", [this](TomlSection& section) {
      read_triad(section, kAccelerometer, model_.accelerometer, Stated::kAccelerometerBiasSigma);
    });
    parent.table("gyro", [this](TomlSection& section) {
      read_triad(section, kGyro, model_.gyro, Stated::kGyroBiasSigma);
      if (const auto g = section.value(kGyroG)) {
        model_.G_g_radps_per_mps2 =
            g->is_array() ? matrix3(*g, kOrMatrix) : diagonal(g->number(kOrMatrix));
      }
      model_.G_g_sigma_radps_per_mps2 = section.number(kGyroGSigma).value_or(0.0);
    });
    for (const Relation& relation : kRelations) check(relation);
    validate(model_);
    return model_;
  }

 private:
  /// @param bias_sigma  the first of the three quantities that relations are about
  void read_triad(TomlSection& section, const TriadQuantities& q, TriadErrorModel& triad,
                  Stated bias_sigma) {
    auto* const given = &given_[static_cast<std::size_t>(bias_sigma)];
    if (const auto bias = section.value(q.bias)) triad.bias = bias->vector3(kEachAxis);
    triad.bias_sigma = number(given[0] = section.value(q.bias_sigma));
    triad.in_run.sigma = number(given[1] = section.value(q.in_run_sigma));
    const auto tau = section.value(q.in_run_tau);
    if (tau.has_value() != given[1].has_value()) {
      (tau ? tau : given[1])
          ->fail_at_key(
              "is half of an in-run bias, which needs both in_run_sigma_<unit> and in_run_tau_s");
    }
    if (tau) triad.in_run.tau_s = tau->number();
    triad.noise_density = number(given[2] = section.value(q.noise));
    read_matrix(section, q, triad);
    triad.quantum = section.number(q.quantum).value_or(triad.quantum);
    triad.range = section.number(q.range).value_or(triad.range);
  }

  static void read_matrix(TomlSection& section, const TriadQuantities& q, TriadErrorModel& triad) {
    if (const auto scale = section.value(q.scale)) {
      triad.M += scale->is_array() ? Eigen::Matrix3d(scale->vector3(kOrEachAxis).asDiagonal())
                                   : diagonal(scale->number(kOrEachAxis));
    }
    triad.scale_sigma = section.number(q.scale_sigma).value_or(0.0);
    if (const auto value = section.value(q.misalignment)) triad.M += misalignment(*value);
    triad.misalignment_sigma_rad = section.number(q.misalignment_sigma).value_or(0.0);
  }

  void check(const Relation& relation) const {
    const auto& over = given_[static_cast<std::size_t>(relation.over)];
    const auto& under = given_[static_cast<std::size_t>(relation.under)];
    if (!over || !under || relation.allows(over->number(), under->number())) return;
    std::vector<std::string> likely =
        over->likely_keys([&](double si) { return relation.allows(si, under->number()); });
    for (std::string& key :
         under->likely_keys([&](double si) { return relation.allows(over->number(), si); })) {
      likely.push_back(std::move(key));
    }
    under->fail_at_key("= " + under->text() + " does not go with '" + std::string(over->key()) +
                       "' = " + over->text() + ": no real sensor has both" + likely_intent(likely));
  }

  std::array<std::optional<TomlValue>, kStated> given_{};
  ImuErrorModel model_{};
};

}  // namespace

ImuErrorModel read_imu_model(TomlSection& parent) { return ModelSection().read(parent); }

}  // namespace leeway::sim
