#include "leeway/sim/scene/filter_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <type_traits>

#include "leeway/earth/error.hpp"
#include "sim/scene/scene_sections.hpp"
#include "sim/scene/scene_units.hpp"

namespace leeway::sim {
namespace {

constexpr std::int64_t kLargestDivider = 1000;

/// Numbers that a file may state, in fewer sizes than a filter can run with.
struct Plausible {
  std::string_view field{};
  Range limits{};
};
constexpr std::array<Plausible, 3> kPlausible{{{"gate_probability", zero_or(1e-15, 0.1)},
                                               {"covariance_interval_s", zero_or(1e-4, 10.0)},
                                               {"gnss_correlation_s", zero_or(0.1, 1e5)}}};

/// What is told of a receiver, and not handed from scene to scene.
constexpr std::array<std::string_view, 2> kOfTheScene{"gate_probability", "gnss_correlation_s"};

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

/// Hands each field that [filter] has, with its key, to io. The IMU and the lever arm are told
/// elsewhere in a scene.
template <class T, class Io>
void for_key(const Field<T>& field, Io& io) {
  using Value = std::remove_const_t<T>;
  if constexpr (std::is_same_v<Value, BiasState>) {
    io(std::string(field.name) + "_bias", field);
  } else if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
    io(field.name, field);
  } else if constexpr (!std::is_same_v<Value, ImuErrorModel> &&
                       !std::is_same_v<Value, Eigen::Vector3d>) {
    for_each_key(field.value, io);
  }
}

template <class T, class Io>
void for_each_key(T& config, Io& io) {
  config.visit(config, [&io](const auto&... fields) { (for_key(fields, io), ...); });
}

class KeyReader {
 public:
  explicit KeyReader(TomlSection& section) : section_(section) {}

  void operator()(std::string_view, const Field<double>& field) {
    std::string_view key = field.name;
    const bool is_time = key.ends_with("_s");
    if (is_time) key.remove_suffix(2);
    const auto* const known = std::find_if(kPlausible.begin(), kPlausible.end(),
                                           [&](const auto& p) { return p.field == field.name; });
    const Range& limits = known != kPlausible.end() ? known->limits : field.range;
    set(section_, {key, is_time ? kTimes : decltype(kTimes){}, limits}, field.value);
  }
  void operator()(std::string_view key, const Field<bool>& field) {
    field.value = section_.boolean(key).value_or(field.value);
  }
  void operator()(std::string_view, const Field<EarthRotation>& field) {
    const auto both = section_.boolean("earth_rotation");
    const auto coriolis = section_.boolean("coriolis");
    field.value = earth_rotation_of(both.value_or(has_turn(field.value)),
                                    coriolis.value_or(both.value_or(has_coriolis(field.value))));
  }
  template <NamedEnum Enum>
  void operator()(std::string_view key, const Field<Enum>& field) {
    field.value = section_.choice<Enum>(key).value_or(field.value);
  }

 private:
  TomlSection& section_;
};

class KeyWriter {
 public:
  explicit KeyWriter(std::string& text) : text_(text) {}

  template <class T>
  void operator()(std::string_view key, const Field<T>& field) {
    if (std::find(kOfTheScene.begin(), kOfTheScene.end(), key) != kOfTheScene.end()) return;
    text_ += fmt::format("{} = {}\n", key, field.value);
  }
  void operator()(std::string_view, const Field<const EarthRotation>& field) {
    text_ += fmt::format("earth_rotation = {}\ncoriolis = {}\n", has_turn(field.value),
                         has_coriolis(field.value));
  }
  template <NamedEnum Enum>
  void operator()(std::string_view key, const Field<const Enum>& field) {
    text_ += fmt::format("{} = \"{}\"\n", key, name(field.value));
  }

 private:
  std::string& text_;
};

}  // namespace

void read_filter(TomlSection& section, Scene& scene) {
  KeyReader reader(section);
  for_each_key(scene.filter, reader);
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
  text += "[filter]\n";
  KeyWriter writer(text);
  for_each_key(scene.filter, writer);
  return text + fmt::format("imu_divider = {}\n", scene.imu_divider);
}

}  // namespace leeway::sim
