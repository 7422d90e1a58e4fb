#include "leeway/sim/sensors/imu_class_name.hpp"

#include <spdlog/fmt/fmt.h>

namespace leeway::sim {

std::string imu_name(const ClassAndRange& imu) {
  return fmt::format("{}/{}", name(imu.imu_class), name(imu.range));
}

std::optional<ClassAndRange> class_of_name(std::string_view imu) {
  const std::size_t slash = imu.rfind('/');
  if (slash == imu.npos) return {};
  const auto imu_class = from_name<ImuClass>(imu.substr(0, slash));
  const auto range = from_name<RangeEnd>(imu.substr(slash + 1));
  if (!imu_class || !range) return {};
  return ClassAndRange{*imu_class, *range};
}

}  // namespace leeway::sim
