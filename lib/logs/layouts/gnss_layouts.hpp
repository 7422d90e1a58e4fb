/// @file
/// The layouts of GNSS logs, one file each. Private to the GNSS log reader.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "leeway/sensors/gnss_fix.hpp"
#include "lib/logs/csv_header.hpp"
#include "lib/logs/log_columns.hpp"
#include "lib/logs/log_layout.hpp"
#include "lib/logs/log_source.hpp"

namespace leeway {

using GnssLayout = LogLayout<GnssFix>;

GnssLayout gnss_csv();
GnssLayout gnss_phone();
GnssLayout gnss_kf_gins();
GnssLayout rtklib_pos();
GnssLayout nmea();
GnssLayout gnss_ubx();
GnssLayout gnss_ulog();

/// The table of the layouts (gnss_log.cpp).
const std::vector<GnssLayout>& gnss_layouts();

// Columns, and the slots that GnssFields reads. KF-GINS text has them in this order.
inline constexpr std::array kPositionColumns{
    NamedColumn{"t_s", kTimeColumn},
    NamedColumn{"lat_deg", {0, -90.0, 90.0}},
    NamedColumn{"lon_deg", {1, -360.0, 360.0}},
    NamedColumn{"height_m", {2, -kMaxHeightM, kMaxHeightM}},
    NamedColumn{"pos_std_n_m", sigma_column(3)},
    NamedColumn{"pos_std_e_m", sigma_column(4)},
    NamedColumn{"pos_std_d_m", sigma_column(5)}};
inline constexpr std::array kVelocityColumns{NamedColumn{"vn_mps", velocity_column(6)},
                                             NamedColumn{"ve_mps", velocity_column(7)},
                                             NamedColumn{"vd_mps", velocity_column(8)},
                                             NamedColumn{"vel_std_n_mps", sigma_column(9, true)},
                                             NamedColumn{"vel_std_e_mps", sigma_column(10, true)},
                                             NamedColumn{"vel_std_d_mps", sigma_column(11, true)}};

/// Used where a log has both; an empty sigma is the default one.
inline constexpr std::array kHeadingColumns{
    NamedColumn{"heading_deg", {12, -360.0, 360.0, true}},
    NamedColumn{"heading_sigma_deg", {13, 0.0, 360.0, true}}};

/// The parser of a fix whose numbers stand in those columns.
struct GnssFields {
  static constexpr std::size_t kSlots = 14;

  LineParser fields{};
  std::optional<WeekUnroller> week{};  ///< where times are seconds of week
  std::size_t told_sigmas{0};          ///< LogFormat::gnss_sigma, which replaces the log's

  std::optional<Fault> operator()(std::string_view line, GnssFix& fix);
};

}  // namespace leeway
