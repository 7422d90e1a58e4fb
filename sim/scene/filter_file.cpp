#include "leeway/sim/scene/filter_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cstddef>

#include "leeway/earth/error.hpp"
#include "sim/scene/scene_sections.hpp"
#include "sim/scene/scene_units.hpp"

namespace leeway::sim {
namespace {

constexpr Quantity kGateProbability{"gate_probability", {}, zero_or(1e-15, 0.1)};
constexpr Quantity kCovarianceInterval{"covariance_interval", kTimes, zero_or(1e-4, 10.0)};
constexpr Quantity kGnssCorrelation{"gnss_correlation", kTimes, zero_or(0.1, 1e5)};
constexpr std::int64_t kLargestDivider = 1000;

// Each in the order of its enumeration.
constexpr std::array<std::string_view, 8> kSchemeNames{
    "explicit_euler", "semi_implicit_euler", "trapezoid", "one_sample",
    "two_sample",     "runge_kutta_4",       "coning",    "sculling"};
constexpr std::array<std::string_view, 3> kGravityNames{"constant", "j2", "normal"};
constexpr std::array<std::string_view, 4> kBiasStateNames{"modelled", "random_walk", "constant",
                                                          "none"};

template <std::size_t N, class Value>
void set_choice(TomlSection& section, std::string_view key,
                const std::array<std::string_view, N>& names, Value& value) {
  if (const auto index = section.choice(key, names)) value = static_cast<Value>(*index);
}

template <std::size_t N, class Value>
std::string_view word_for(const std::array<std::string_view, N>& names, Value value) {
  return names[static_cast<std::size_t>(value)];
}

bool has_turn(EarthRotation rotation) {
  return rotation == EarthRotation::kOn || rotation == EarthRotation::kTurnAlone;
}

bool has_coriolis(EarthRotation rotation) {
  return rotation == EarthRotation::kOn || rotation == EarthRotation::kCoriolisAlone;
}

EarthRotation earth_rotation_of(bool turn, bool coriolis) {
  if (turn) return coriolis ? EarthRotation::kOn : EarthRotation::kTurnAlone;
  return coriolis ? EarthRotation::kCoriolisAlone : EarthRotation::kOff;
}

void read_earth_rotation(TomlSection& section, EarthRotation& rotation) {
  const auto both = section.boolean("earth_rotation");
  const auto coriolis = section.boolean("coriolis");
  rotation = earth_rotation_of(both.value_or(has_turn(rotation)),
                               coriolis.value_or(both.value_or(has_coriolis(rotation))));
}

}  // namespace

void read_filter(TomlSection& section, Scene& scene) {
  EkfConfig& filter = scene.filter;
  set(section, kGateProbability, filter.gate_probability);
  set(section, kCovarianceInterval, filter.covariance_interval_s);
  set(section, kGnssCorrelation, filter.gnss_correlation_s);
  set_choice(section, "scheme", kSchemeNames, filter.strapdown.scheme);
  set_choice(section, "gravity", kGravityNames, filter.strapdown.gravity);
  read_earth_rotation(section, filter.strapdown.rotation);
  filter.gravity_gradient = section.boolean("gravity_gradient").value_or(filter.gravity_gradient);
  set_choice(section, "accelerometer_bias", kBiasStateNames, filter.biases.accelerometer);
  set_choice(section, "gyro_bias", kBiasStateNames, filter.biases.gyro);
  scene.imu_divider = static_cast<int>(
      section.integer("imu_divider", 1, kLargestDivider).value_or(scene.imu_divider));
}

void read_filter_file(const std::filesystem::path& path, Scene& scene) {
  require_text_file(path);
  TomlDocument::from_file(path).read([&](TomlSection& root) {
    const auto read = [&scene](TomlSection& section) { read_filter(section, scene); };
    if (!root.table("filter", read)) root.fail("the configuration of a filter needs [filter]");
  });
}

std::string filter_file(const Scene& scene, std::string_view comment) {
  std::string text;
  while (!comment.empty()) {
    const std::size_t end = comment.find('\n');
    text += fmt::format("# {}\n", comment.substr(0, end));
    comment.remove_prefix(end == comment.npos ? comment.size() : end + 1);
  }
  const EkfConfig& filter = scene.filter;
  return text +
         fmt::format(
             "[filter]\nscheme = \"{}\"\ngravity = \"{}\"\nearth_rotation = {}\ncoriolis = {}\n"
             "gravity_gradient = {}\ncovariance_interval_s = {}\naccelerometer_bias = \"{}\"\n"
             "gyro_bias = \"{}\"\nimu_divider = {}\n",
             word_for(kSchemeNames, filter.strapdown.scheme),
             word_for(kGravityNames, filter.strapdown.gravity), has_turn(filter.strapdown.rotation),
             has_coriolis(filter.strapdown.rotation), filter.gravity_gradient,
             filter.covariance_interval_s, word_for(kBiasStateNames, filter.biases.accelerometer),
             word_for(kBiasStateNames, filter.biases.gyro), scene.imu_divider);
}

}  // namespace leeway::sim
