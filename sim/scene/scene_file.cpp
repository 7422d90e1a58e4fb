#include "leeway/sim/scene/scene_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <system_error>

#include "sim/scene/scene_sections.hpp"
#include "sim/scene/scene_units.hpp"

namespace leeway::sim {
namespace {

constexpr Quantity kDuration{"duration", kTimes, between(kShortestSceneS, kLongestSceneS)};
constexpr Quantity kImuRate{"imu_rate", {&units::kHz}, between(1.0, 1e4)};
constexpr Quantity kSettle{"settle", kTimes, zero_or(1.0, kLongestSceneS)};
constexpr Quantity kSettleInterval{"settle_interval", kTimes, between(1e-3, kLongestSceneS)};
constexpr std::int64_t kMostSceneTrials = 1'000'000;

/// A scene while it is read.
class SceneReader {
 public:
  SceneReader(const std::filesystem::path& path, std::optional<double> duration_s)
      : folder_(path.parent_path()), wanted_duration_s_(duration_s), duration_s_(duration_s) {
    scene_.name = path.stem().string();
  }

  Scene read(TomlSection& root) {
    root.table("scene", [this](TomlSection& section) { read_scene_section(section); });
    require(root, "trajectory", [this](TomlSection& section) {
      scene_.trajectory = read_trajectory(section, folder_, duration_s_);
      const double length_s = scene_.trajectory.duration_s;
      if (!kDuration.limits.contains(length_s)) {
        section.fail(fmt::format("the motion takes {:.9g} s, must be 1 to 1e6 s", length_s));
      }
    });
    scene_.duration_s = scene_.trajectory.duration_s;
    require(root, "imu", [this](TomlSection& section) {
      const NamedImuModel imu = read_imu(section, folder_);
      set_imu(scene_, imu.name, imu.model);
    });
    root.table("gnss", [this](TomlSection& section) {
      scene_.gnss = read_gnss(section, scene_.duration_s, wanted_duration_s_.has_value());
      settle_s_ = section.number(kSettle);
      GnssScenario& gnss = scene_.gnss;
      gnss.settle_interval_s = std::min(gnss.settle_interval_s, gnss.interval_s);
      set(section, kSettleInterval, gnss.settle_interval_s);
      require_step(section);
    });
    root.table("vehicle", [this](TomlSection& section) { scene_.vehicle = read_vehicle(section); });
    if (scene_.vehicle) scene_.estimator = SceneEstimator::kNavigator;
    believe_the_receiver();
    root.table("filter", [this](TomlSection& section) {
      read_filter(section, scene_);
      section.table("imu",
                    [this](TomlSection& imu) { scene_.filter.imu = read_imu(imu, folder_).model; });
    });
    scene_.gnss.settle_s = settle_s_.value_or(default_settle_s());
    root.table("initial", [this](TomlSection& section) { scene_.initial = read_initial(section); });
    read_limit_section(root);
    return scene_;
  }

  bool uses_old_name() const { return uses_old_name_; }

 private:
  static void require(TomlSection& root, std::string_view name, const TomlSection::Reader& read) {
    if (!root.table(name, read)) root.fail("a scene needs [" + std::string(name) + "]");
  }

  void read_scene_section(TomlSection& section) {
    scene_.name = section.text("name").value_or(scene_.name);
    const auto duration_s = section.number(kDuration);
    if (!wanted_duration_s_) duration_s_ = duration_s;
    set(section, kImuRate, scene_.imu_rate_hz);
    scene_.trials =
        static_cast<int>(section.integer("trials", 1, kMostSceneTrials).value_or(scene_.trials));
    constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();
    scene_.first_seed =
        static_cast<std::uint64_t>(section.integer("first_seed", 0, kLargest)
                                       .value_or(static_cast<std::int64_t>(scene_.first_seed)));
  }

  /// Older files call it [budget].
  void read_limit_section(TomlSection& root) {
    const auto read = [this](TomlSection& section) { scene_.limit = read_limit(section); };
    uses_old_name_ = root.has("budget");
    if (uses_old_name_ && root.has("limit")) {
      root.fail_at("budget", "is the old name of [limit], also there: keep one");
    }
    root.table(uses_old_name_ ? "budget" : "limit", read);
  }

  void require_step(const TomlSection& section) const {
    if (scene_.gnss.interval_s * scene_.imu_rate_hz >= 1.0 - 1e-9) return;
    section.fail(
        fmt::format("the interval of {:.9g} s is shorter than the step of an IMU at {:.9g} Hz: "
                    "raise imu_rate_hz in [scene]",
                    scene_.gnss.interval_s, scene_.imu_rate_hz));
  }

  /// What a filter is told of the receiver, unless [filter] says otherwise.
  void believe_the_receiver() {
    const GnssErrorModel& errors = scene_.gnss.errors;
    scene_.filter.lever_arm_b_m = errors.lever_arm_b_m;
    scene_.filter.gnss_correlation_s =
        errors.correlated_sigma_n_m.isZero(0.0) ? 0.0 : errors.correlation_time_s;
  }

  /// A navigator that has been running: five minutes, as far as the scene and its outages allow.
  double default_settle_s() const {
    constexpr double kUsualS = 300.0;
    if (scene_.estimator == SceneEstimator::kEkf) return 0.0;
    double settle_s = std::min(kUsualS, 0.5 * scene_.duration_s);
    for (const Outage& outage : scene_.gnss.outages) {
      settle_s = std::min(settle_s, outage.start_s);
    }
    return settle_s;
  }

  std::filesystem::path folder_;
  std::optional<double> wanted_duration_s_;
  std::optional<double> settle_s_{};
  std::optional<double> duration_s_;
  Scene scene_{};
  bool uses_old_name_{false};
};

Scene read(const TomlDocument& document, const std::filesystem::path& path,
           std::optional<double> duration_s, std::vector<std::string>* notes) {
  if (duration_s && !kDuration.limits.contains(*duration_s)) {
    throw Error(
        fmt::format("the duration of a scene is {:.9g} s, must be 1 to 1e6 s", *duration_s));
  }
  SceneReader reader(path, duration_s);
  Scene scene;
  document.read([&](TomlSection& root) { scene = reader.read(root); });
  validate(scene);
  if (notes != nullptr && reader.uses_old_name()) {
    notes->push_back(path.string() + ": [budget] is now called [limit]");
  }
  return scene;
}

}  // namespace

void require_text_file(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw Error(path.string() + ": cannot be read: " + error.message());
  if (size > kLongestSceneFile) {
    throw Error(fmt::format("{}: {} bytes are too long for a TOML file", path.string(), size));
  }
}

Scene read_scene(const std::filesystem::path& path, std::optional<double> duration_s,
                 std::vector<std::string>* notes) {
  require_text_file(path);
  return read(TomlDocument::from_file(path), path, duration_s, notes);
}

Scene parse_scene(std::string_view text, const std::string& name, std::optional<double> duration_s,
                  std::vector<std::string>* notes) {
  if (text.size() > kLongestSceneFile) throw Error(name + ": longer than a scene file can be");
  return read(TomlDocument::from_text(text, name), name, duration_s, notes);
}

}  // namespace leeway::sim
