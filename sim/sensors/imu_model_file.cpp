#include "leeway/sim/sensors/imu_model_file.hpp"

#include "sim/sensors/imu_model_section.hpp"

namespace leeway::sim {
namespace {

ImuErrorModel read(const TomlDocument& document) {
  ImuErrorModel model;
  document.read([&model](TomlSection& root) {
    model = read_imu_model(root);
    root.finish();
    if (!root.has("accelerometer") && !root.has("gyro")) {
      root.fail("an IMU model needs [accelerometer] or [gyro]: nothing is given");
    }
  });
  return model;
}

}  // namespace

ImuErrorModel read_imu_model(const std::filesystem::path& path) {
  return read(TomlDocument::from_file(path));
}

ImuErrorModel parse_imu_model(std::string_view text, const std::string& name) {
  return read(TomlDocument::from_text(text, name));
}

}  // namespace leeway::sim
