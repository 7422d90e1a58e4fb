#include <algorithm>
#include <array>
#include <cmath>

#include "leeway/model/process_noise.hpp"
#include "sim/analysis/truth_model.hpp"
#include "sim/reduce/reduction_parts.hpp"

namespace leeway::sim {
namespace {

struct TermWords {
  std::string_view name;
  std::string_view substitute;
};

// In the order of ModelTerm.
constexpr std::array<TermWords, 22> kTermWords{{
    {"earth_rotation", "no turn of the Earth in the attitude"},
    {"coriolis", "no Coriolis"},
    {"gravity_beyond_j2", "J2 gravity"},
    {"gravity_beyond_constant", "constant gravity"},
    {"gravity_gradient", "no gravity gradient in Phi"},
    {"coning", "no coning"},
    {"sculling", "no sculling"},
    {"integration_order", "explicit Euler"},
    {"imu_rate_half", "increments added in pairs"},
    {"imu_rate_fifth", "increments added in fives"},
    {"covariance_0_1_s", "P every 0.1 s"},
    {"covariance_1_s", "P every 1 s"},
    {"double_precision", "P in float"},
    {"accelerometer_bias", "no such states"},
    {"gyro_bias", "no such states"},
    {"bias_decay", "biases walk at random"},
    {"bias_drive", "biases are constant"},
    {"lever_arm", "antenna at the IMU"},
    {"latency", "fixes valid at arrival"},
    {"scale_factors", "no filter models them"},
    {"misalignments", "no filter models them"},
    {"g_sensitivity", "no filter models it"},
}};

bool has_gauss_markov(const Scene& scene) {
  const ProcessNoise noise = process_noise(scene.filter.imu);
  return std::isfinite(noise.tau_a_s) || std::isfinite(noise.tau_g_s);
}

bool has_drive(const Scene& scene) {
  const ProcessNoise noise = process_noise(scene.filter.imu);
  return noise.b_a_m2_per_s5 > 0.0 || noise.b_g_rad2_per_s3 > 0.0;
}

bool has_bias(const TriadErrorModel& triad) {
  return triad.bias_sigma > 0.0 || triad.in_run.sigma > 0.0;
}

/// Whether every fix of the scene is valid and arrives at the end of so many increments.
bool divides(const Scene& scene, int divider) {
  const auto is_whole = [&](double t_s) {
    const double n = t_s * scene.imu_rate_hz / divider;
    return std::abs(n - std::round(n)) < 1e-6 * std::max(1.0, n);
  };
  return is_whole(scene.gnss.interval_s) && is_whole(scene.gnss.latency_s);
}

bool has_parameters(const Scene& scene, const std::vector<ErrorSource>& sources) {
  const auto moments = TruthModel::parameter_moments(scene.imu);
  return std::any_of(moments.begin(), moments.end(), [&sources](const auto& moment) {
    return std::find(sources.begin(), sources.end(), moment.first) != sources.end();
  });
}

bool means_something(ModelTerm term, const Scene& scene) {
  switch (term) {
    case ModelTerm::kFullRate:
      return divides(scene, 2);
    case ModelTerm::kFifthRate:
      return divides(scene, 5);
    case ModelTerm::kEachCovariance:
      return scene.imu_rate_hz > 10.0;
    case ModelTerm::kAccelerometerBias:
      return has_bias(scene.filter.imu.accelerometer);
    case ModelTerm::kGyroBias:
      return has_bias(scene.filter.imu.gyro);
    case ModelTerm::kBiasDecay:
      return has_gauss_markov(scene);
    case ModelTerm::kBiasDrive:
      return has_drive(scene);
    case ModelTerm::kLeverArm:
      return !scene.gnss.errors.lever_arm_b_m.isZero(0.0);
    case ModelTerm::kLatency:
      return scene.gnss.latency_s > 0.0;
    default:
      return sources_of(term).empty() || has_parameters(scene, sources_of(term));
  }
}

Scheme without_coning(Scheme scheme) {
  return scheme == Scheme::kTwoSample ? Scheme::kSculling : Scheme::kOneSample;
}

Scheme without_sculling(Scheme scheme) {
  return scheme == Scheme::kTwoSample ? Scheme::kConing : Scheme::kOneSample;
}

EarthRotation without_turn(EarthRotation rotation) {
  return rotation == EarthRotation::kOn ? EarthRotation::kCoriolisAlone : EarthRotation::kOff;
}

EarthRotation without_coriolis(EarthRotation rotation) {
  return rotation == EarthRotation::kOn ? EarthRotation::kTurnAlone : EarthRotation::kOff;
}

void drop_of_strapdown(ModelTerm term, StrapdownPolicy& strapdown) {
  switch (term) {
    case ModelTerm::kEarthTurn:
      strapdown.rotation = without_turn(strapdown.rotation);
      break;
    case ModelTerm::kCoriolis:
      strapdown.rotation = without_coriolis(strapdown.rotation);
      break;
    case ModelTerm::kNormalGravity:
      if (strapdown.gravity == GravityModel::kNormal) strapdown.gravity = GravityModel::kJ2;
      break;
    case ModelTerm::kJ2:
      strapdown.gravity = GravityModel::kConstant;
      break;
    case ModelTerm::kConing:
      strapdown.scheme = without_coning(strapdown.scheme);
      break;
    case ModelTerm::kSculling:
      strapdown.scheme = without_sculling(strapdown.scheme);
      break;
    case ModelTerm::kSecondOrder:
      strapdown.scheme = Scheme::kExplicitEuler;
      break;
    default:
      break;
  }
}

void drop_of_covariance(ModelTerm term, FilterModel& model) {
  double& interval_s = model.config.covariance_interval_s;
  BiasStates& biases = model.config.biases;
  switch (term) {
    case ModelTerm::kGravityGradient:
      model.config.gravity_gradient = false;
      break;
    case ModelTerm::kEachCovariance:
      interval_s = std::max(interval_s, 0.1);
      break;
    case ModelTerm::kTenthCovariance:
      interval_s = std::max(interval_s, 1.0);
      break;
    case ModelTerm::kDoublePrecision:
      model.precision = Precision::kFloat;
      break;
    case ModelTerm::kAccelerometerBias:
      biases.accelerometer = BiasState::kNone;
      break;
    case ModelTerm::kGyroBias:
      biases.gyro = BiasState::kNone;
      break;
    case ModelTerm::kBiasDecay:
      biases = {std::max(biases.accelerometer, BiasState::kRandomWalk),
                std::max(biases.gyro, BiasState::kRandomWalk)};
      break;
    case ModelTerm::kBiasDrive:
      biases = {std::max(biases.accelerometer, BiasState::kConstant),
                std::max(biases.gyro, BiasState::kConstant)};
      break;
    default:
      break;
  }
}

void drop_of_input(ModelTerm term, FilterModel& model) {
  switch (term) {
    case ModelTerm::kFullRate:
      model.imu_divider = std::max(model.imu_divider, 2);
      break;
    case ModelTerm::kFifthRate:
      model.imu_divider = std::max(model.imu_divider, 5);
      break;
    case ModelTerm::kLeverArm:
      model.config.lever_arm_b_m.setZero();
      break;
    case ModelTerm::kLatency:
      model.knows_latency = false;
      break;
    default:
      break;
  }
}

}  // namespace

std::string_view name(ModelTerm term) { return kTermWords[static_cast<std::size_t>(term)].name; }

std::string_view substitute(ModelTerm term) {
  return kTermWords[static_cast<std::size_t>(term)].substitute;
}

std::vector<ErrorSource> sources_of(ModelTerm term) {
  switch (term) {
    case ModelTerm::kScaleFactors:
      return {ErrorSource::kAccelerometerScale, ErrorSource::kGyroScale};
    case ModelTerm::kMisalignments:
      return {ErrorSource::kAccelerometerMisalignment, ErrorSource::kGyroMisalignment};
    case ModelTerm::kGSensitivity:
      return {ErrorSource::kGyroGSensitivity};
    default:
      return {};
  }
}

std::vector<ModelTerm> implied_by(ModelTerm term) {
  switch (term) {
    case ModelTerm::kJ2:
      return {ModelTerm::kNormalGravity};
    case ModelTerm::kSecondOrder:
      return {ModelTerm::kConing, ModelTerm::kSculling};
    case ModelTerm::kFifthRate:
      return {ModelTerm::kFullRate};
    case ModelTerm::kTenthCovariance:
      return {ModelTerm::kEachCovariance};
    case ModelTerm::kBiasDrive:
      return {ModelTerm::kBiasDecay};
    default:
      return {};
  }
}

bool may_be_dropped(ModelTerm term) {
  return term != ModelTerm::kDoublePrecision && term != ModelTerm::kLeverArm &&
         term != ModelTerm::kLatency && sources_of(term).empty();
}

std::vector<ModelTerm> terms_of(const Scene& scene) {
  std::vector<ModelTerm> terms;
  for (std::size_t i = 0; i < kTermWords.size(); ++i) {
    const auto term = static_cast<ModelTerm>(i);
    if (means_something(term, scene)) terms.push_back(term);
  }
  return terms;
}

FilterModel full_model(const Scene& scene) {
  FilterModel full{scene.filter};
  full.config.strapdown = {};
  full.config.biases = {};
  full.config.covariance_interval_s = 0.0;
  full.config.gravity_gradient = true;
  return full;
}

FilterModel without(FilterModel model, const std::vector<ModelTerm>& terms) {
  for (const ModelTerm term : terms) {
    drop_of_strapdown(term, model.config.strapdown);
    drop_of_covariance(term, model);
    drop_of_input(term, model);
  }
  return model;
}

Scene with_model(Scene scene, const FilterModel& model) {
  scene.filter = model.config;
  scene.imu_divider = model.imu_divider;
  return scene;
}

}  // namespace leeway::sim
