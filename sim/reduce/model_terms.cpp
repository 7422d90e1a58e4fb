#include <algorithm>
#include <array>
#include <cmath>

#include "leeway/model/process_noise.hpp"
#include "sim/analysis/truth_model.hpp"
#include "sim/reduce/reduction_parts.hpp"

namespace leeway::sim {
namespace {

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
  const auto moments = parameter_moments(scene.imu);
  return std::any_of(moments.begin(), moments.end(), [&sources](const auto& moment) {
    return std::find(sources.begin(), sources.end(), moment.first) != sources.end();
  });
}

void raise(double& value, double least) { value = std::max(value, least); }

/// BiasState is in the order of what the filter leaves out.
void simplify(BiasStates& biases, BiasState least) {
  biases = {std::max(biases.accelerometer, least), std::max(biases.gyro, least)};
}

/// What a filter does without a term, and where that makes a difference.
struct TermRow {
  std::string_view substitute;
  void (*drop)(FilterModel&){[](FilterModel&) {}};
  bool (*means_something)(const Scene&){[](const Scene&) { return true; }};
};

// In the order of ModelTerm.
constexpr std::array<TermRow, kAll<ModelTerm>.size()> kTerms{{
    {"no turn of the Earth in the attitude",
     [](FilterModel& m) {
       EarthRotation& rotation = m.config.strapdown.rotation;
       rotation =
           rotation == EarthRotation::kOn ? EarthRotation::kCoriolisAlone : EarthRotation::kOff;
     }},
    {"no Coriolis",
     [](FilterModel& m) {
       EarthRotation& rotation = m.config.strapdown.rotation;
       rotation = rotation == EarthRotation::kOn ? EarthRotation::kTurnAlone : EarthRotation::kOff;
     }},
    {"J2 gravity",
     [](FilterModel& m) {
       GravityModel& gravity = m.config.strapdown.gravity;
       if (gravity == GravityModel::kNormal) gravity = GravityModel::kJ2;
     }},
    {"constant gravity",
     [](FilterModel& m) { m.config.strapdown.gravity = GravityModel::kConstant; }},
    {"no gravity gradient in Phi", [](FilterModel& m) { m.config.gravity_gradient = false; }},
    {"no coning",
     [](FilterModel& m) {
       Scheme& scheme = m.config.strapdown.scheme;
       scheme = scheme == Scheme::kTwoSample ? Scheme::kSculling : Scheme::kOneSample;
     }},
    {"no sculling",
     [](FilterModel& m) {
       Scheme& scheme = m.config.strapdown.scheme;
       scheme = scheme == Scheme::kTwoSample ? Scheme::kConing : Scheme::kOneSample;
     }},
    {"explicit Euler", [](FilterModel& m) { m.config.strapdown.scheme = Scheme::kExplicitEuler; }},
    {"increments added in pairs",
     [](FilterModel& m) { m.imu_divider = std::max(m.imu_divider, 2); },
     [](const Scene& scene) { return divides(scene, 2); }},
    {"increments added in fives",
     [](FilterModel& m) { m.imu_divider = std::max(m.imu_divider, 5); },
     [](const Scene& scene) { return divides(scene, 5); }},
    {"P every 0.1 s", [](FilterModel& m) { raise(m.config.covariance_interval_s, 0.1); },
     [](const Scene& scene) { return scene.imu_rate_hz > 10.0; }},
    {"P every 1 s", [](FilterModel& m) { raise(m.config.covariance_interval_s, 1.0); }},
    {"P in float", [](FilterModel& m) { m.precision = Precision::kFloat; }},
    {"no such states", [](FilterModel& m) { m.config.biases.accelerometer = BiasState::kNone; },
     [](const Scene& scene) { return has_bias(scene.filter.imu.accelerometer); }},
    {"no such states", [](FilterModel& m) { m.config.biases.gyro = BiasState::kNone; },
     [](const Scene& scene) { return has_bias(scene.filter.imu.gyro); }},
    {"biases walk at random",
     [](FilterModel& m) { simplify(m.config.biases, BiasState::kRandomWalk); }, has_gauss_markov},
    {"biases are constant", [](FilterModel& m) { simplify(m.config.biases, BiasState::kConstant); },
     has_drive},
    {"antenna at the IMU", [](FilterModel& m) { m.config.lever_arm_b_m.setZero(); },
     [](const Scene& scene) { return !scene.gnss.errors.lever_arm_b_m.isZero(0.0); }},
    {"fixes valid at arrival", [](FilterModel& m) { m.knows_latency = false; },
     [](const Scene& scene) { return scene.gnss.latency_s > 0.0; }},
    {"no filter models them"},
    {"no filter models them"},
    {"no filter models it"},
}};

const TermRow& row_of(ModelTerm term) { return kTerms[static_cast<std::size_t>(term)]; }

bool means_something(ModelTerm term, const Scene& scene) {
  const auto sources = sources_of(term);
  return row_of(term).means_something(scene) && (sources.empty() || has_parameters(scene, sources));
}

}  // namespace

std::string_view substitute(ModelTerm term) { return row_of(term).substitute; }

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
  for (const ModelTerm term : kAll<ModelTerm>) {
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
  for (const ModelTerm term : terms) row_of(term).drop(model);
  return model;
}

Scene with_model(Scene scene, const FilterModel& model) {
  scene.filter = model.config;
  scene.imu_divider = model.imu_divider;
  return scene;
}

}  // namespace leeway::sim
