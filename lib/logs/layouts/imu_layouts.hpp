/// @file
/// The layouts of IMU logs, one file each. Private to the IMU log reader.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "lib/logs/log_columns.hpp"
#include "lib/logs/log_layout.hpp"
#include "lib/logs/log_source.hpp"

namespace leeway {

/// One line, whatever the layout: sensor axes.
struct ImuRow {
  Time time{};
  Eigen::Vector3d angular{Eigen::Vector3d::Zero()};  ///< rate (rad/s) or increment (rad)
  Eigen::Vector3d linear{Eigen::Vector3d::Zero()};   ///< specific force (m/s^2) or increment (m/s)
  double dt_s{};                                     ///< of an increment; 0: from the row before
  bool is_rate{false};
  bool is_mean{false};  ///< the layout's rates are means, ending at time
};

/// Increments: rotation and velocity that happened. A lost rate costs little.
inline bool carries_over(const ImuRow& row, const ImuRow& before) {
  return !row.is_rate && (row.angular != before.angular || row.linear != before.linear);
}

inline void add_to(ImuRow& row, const ImuRow& carried) {
  row.angular += carried.angular;
  row.linear += carried.linear;
  if (row.dt_s > 0.0) row.dt_s += carried.dt_s;
}

using ImuLayout = LogLayout<ImuRow>;

ImuLayout imu_csv_rates();
ImuLayout imu_csv_increments();
ImuLayout imu_kf_gins();
ImuLayout imu_ubx();
ImuLayout imu_ulog();

/// The table of the layouts (imu_log.cpp).
const std::vector<ImuLayout>& imu_layouts();

// Columns, and the slots that ImuFields reads.
constexpr Column angular(int axis) { return {axis, -1e3, 1e3}; }
constexpr Column linear(int axis) { return {3 + axis, -1e5, 1e5}; }
inline constexpr Column kImuStep{6, kSmallest, 3600.0};

/// The parser of a row whose numbers stand in columns.
struct ImuFields {
  LineParser fields{};
  bool are_rates{false};
  std::optional<WeekUnroller> week{};  ///< where times are seconds of week

  std::optional<Fault> operator()(std::string_view line, ImuRow& row) {
    std::array<double, 7> values{};
    if (auto fault = fields.parse(line, row.time, values)) return fault;
    if (week) row.time = week->unroll(row.time);
    row.angular = Eigen::Map<const Eigen::Vector3d>(values.data());
    row.linear = Eigen::Map<const Eigen::Vector3d>(values.data() + 3);
    row.dt_s = values[6];
    row.is_rate = are_rates;
    return std::nullopt;
  }
};

}  // namespace leeway
