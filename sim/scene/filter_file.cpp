#include "leeway/sim/scene/filter_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <sstream>

#include "lib/earth/field_walk.hpp"
#include "sim/scene/scene_sections.hpp"
#include "sim/scene/scene_units.hpp"

namespace leeway::sim {
namespace {

constexpr std::int64_t kLargestDivider = 1000;

constexpr std::array<Quantity, 3> kNumbers{{{"gate_probability", {}, zero_or(1e-15, 0.1)},
                                            {"covariance_interval", kTimes, zero_or(1e-4, 10.0)},
                                            {"gnss_correlation", kTimes, zero_or(0.1, 1e5)}}};

/// What a filter is told of the sensors and the receiver of a scene: no other scene takes it over.
constexpr std::array kOfTheScene{"imu", "lever_arm_b_m", "gate_probability", "gnss_correlation_s"};

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

std::string key_of(const FieldPath& path) {
  return path.root() == "biases" ? std::string(path.name) + "_bias" : path.name;
}

}  // namespace

void read_filter(TomlSection& section, Scene& scene) {
  walk_fields(scene.filter, [&section](const FieldPath& path, auto& value, const Range&) {
    using Value = std::remove_reference_t<decltype(value)>;
    if (path.root() == "imu") return;  // [filter.imu]
    const std::string key = key_of(path);
    if constexpr (std::is_same_v<Value, EarthRotation>) {
      read_earth_rotation(section, value);
    } else if constexpr (std::is_same_v<Value, bool>) {
      value = section.boolean(key).value_or(value);
    } else if constexpr (NamedEnum<Value>) {
      value = section.choice<Value>(key).value_or(value);
    } else if constexpr (std::is_same_v<Value, double>) {
      for (const Quantity& number : kNumbers) {
        if (key.starts_with(number.name)) set(section, number, value);
      }
    }
  });
  scene.estimator = section.choice<SceneEstimator>("estimator").value_or(scene.estimator);
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
  std::istringstream lines{std::string(comment)};
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  text += "[filter]\n";
  walk_fields(scene.filter, [&text](const FieldPath& path, const auto& value, const Range&) {
    using Value = std::remove_cvref_t<decltype(value)>;
    if (std::ranges::find(kOfTheScene, path.root()) != kOfTheScene.end()) return;
    if constexpr (std::is_same_v<Value, EarthRotation>) {
      text +=
          fmt::format("earth_rotation = {}\ncoriolis = {}\n", has_turn(value), has_coriolis(value));
    } else if constexpr (NamedEnum<Value>) {
      text += fmt::format("{} = \"{}\"\n", key_of(path), name(value));
    } else if constexpr (std::is_arithmetic_v<Value>) {
      text += fmt::format("{} = {}\n", key_of(path), value);
    }
  });
  return text + fmt::format("imu_divider = {}\n", scene.imu_divider);
}

}  // namespace leeway::sim
