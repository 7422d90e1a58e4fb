#include <array>
#include <cmath>

#include "lib/logs/layouts/imu_layouts.hpp"
#include "lib/logs/messages/ulog.hpp"

namespace leeway {
namespace {

// Means over the integration time that ends at the time stamp, which counts from the start of the
// system. Axes forward, right, down.
constexpr std::array kSensorCombined{
    UlogNumber{"timestamp"},
    UlogNumber{"gyro_rad", 0},
    UlogNumber{"gyro_rad", 1},
    UlogNumber{"gyro_rad", 2},
    UlogNumber{"accelerometer_m_s2", 0},
    UlogNumber{"accelerometer_m_s2", 1},
    UlogNumber{"accelerometer_m_s2", 2},
};

class UlogImuParser {
 public:
  std::optional<Fault> operator()(std::string_view message, ImuRow& row) {
    if (message.empty()) return end();
    if (!topic_.is_of(message)) {
      if (!is_ulog_head(message)) topic_.learn(message);
      return kNoRow;
    }
    std::array<double, kSensorCombined.size()> values{};
    if (!topic_.read(message, values)) return Fault{LineDamage::kCutShort, "sensor_combined"};
    for (std::size_t k = 0; k < values.size(); ++k) {
      const std::string_view field = kSensorCombined[k].field;
      if (!std::isfinite(values[k])) return Fault{LineDamage::kNotFinite, field};
      const double most = k == 0 ? kMostUlogUs : k < 4 ? angular(0).max : linear(0).max;
      if (std::abs(values[k]) > most) return Fault{LineDamage::kOutOfRange, field};
    }
    row = ImuRow{.time = Time{std::chrono::microseconds{static_cast<std::int64_t>(values[0])}},
                 .angular = Eigen::Map<const Eigen::Vector3d>(values.data() + 1),
                 .linear = Eigen::Map<const Eigen::Vector3d>(values.data() + 4),
                 .is_rate = true,
                 .is_mean = true};
    return std::nullopt;
  }

 private:
  std::optional<Fault> end() const {
    if (topic_.is_logged()) return kNoRow;
    return Fault{LineDamage::kMissingField, "topic sensor_combined, which must be logged"};
  }

  UlogTopic topic_{"sensor_combined", kSensorCombined};
};

RowParser<ImuRow> ulog_imu_parser(LogOpening& log) {
  log.framing = ulog_frame;
  return UlogImuParser{};
}

}  // namespace

ImuLayout imu_ulog() {
  return {"PX4 ULog", "PX4 ULog with sensor_combined", is_ulog, ulog_imu_parser, true};
}

}  // namespace leeway
