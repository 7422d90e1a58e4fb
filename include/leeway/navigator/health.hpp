/// @file
/// How well a navigator is, for the software that depends on it.
#pragma once

#include <cstdint>

#include "leeway/earth/names.hpp"

namespace leeway {

struct Health {
  enum class State : std::uint8_t {
    kAligning,      ///< no solution yet
    kHeadingOpen,   ///< several states are possible, of heading mostly: sigmas span them all
    kAligned,       ///< as it should be
    kCoasting,      ///< no fix was fused for longer than 2 s
    kGating,        ///< fixes come, and are refused
    kInconsistent,  ///< innovations are larger than the filter claims, the IMU cannot be right, or
                    ///< something contradicted the filter within the last 60 s
  };

  State state{State::kAligning};
  double coasting_s{0.0};  ///< since the newest fix that was fused
  double gating_s{0.0};    ///< since the first of the fixes refused in a row; 0 when none is
  /// Mean of NIS / dof over the last 30 fixes or so; 1 is consistent, below 1 modest.
  double position_nis_ratio{1.0};
  double velocity_nis_ratio{1.0};
  double optimistic_by{1.0};         ///< square root of the larger of them, at least 1
  double position_sigma_scale{1.0};  ///< what the receiver's deviations are multiplied by
  double velocity_sigma_scale{1.0};
  double imu_sigma_scale{1.0};  ///< what the deviations of the IMU's noise are multiplied by
  /// By how much fixes are older than their stamps on the IMU's clock, with what is taken out; its
  /// sigma is 1 s while nothing shows it.
  double clock_offset_s{0.0};
  double clock_offset_sigma_s{1.0};
  bool clock_offset_detected{false};     ///< it is beyond chance
  bool clock_offset_of_velocity{false};  ///< of the velocities alone: the positions are right
  /// Position errors repeat themselves from fix to fix while they are fused as white: sigmas are
  /// too small. To be mended by EkfConfig::gnss_correlation_s.
  bool correlated_fixes{false};
  bool mount_known{true};
  bool at_rest{false};            ///< by the detector of the vehicle aiding
  std::uint32_t repairs{0};       ///< of a covariance that was no longer positive definite
  std::uint32_t resets{0};        ///< refused fixes proved right: their state took over
  std::uint32_t realignments{0};  ///< of everything
};

constexpr auto names(Health::State) {
  return std::array{"aligning", "heading_open", "aligned", "coasting", "gating", "inconsistent"};
}
}  // namespace leeway
