/// @file
/// IMU data. The canonical input is the increment; rate samples are converted once, on entry.
#pragma once

#include <Eigen/Core>
#include <utility>

#include "leeway/earth/names.hpp"
#include "leeway/earth/time.hpp"

namespace leeway {

/// Integrals over (time - dt, time], component by component in the turning body axes. An ideal
/// rate-integrating sensor delivers them; they have no coning or sculling correction.
struct ImuIncrement {
  Time time{};                                            ///< end of the interval
  double dt_s{};                                          ///< length, > 0
  Eigen::Vector3d dtheta_b_rad{Eigen::Vector3d::Zero()};  ///< integral of omega_ib_b
  Eigen::Vector3d dv_b_mps{Eigen::Vector3d::Zero()};      ///< integral of f_ib_b
};

/// Angular rate and specific force as a sensor with rate output reports them.
struct ImuSample {
  Time time{};
  Eigen::Vector3d omega_ib_b_radps{Eigen::Vector3d::Zero()};
  Eigen::Vector3d f_ib_b_mps2{Eigen::Vector3d::Zero()};
};

/// Meaning of a rate sample. The choice matters: on the same 100 s drive explicit Euler errs by 135
/// m on point samples and by 1.5 m on means.
enum class RateMeaning {
  kMean,       ///< mean over the interval that ends at the sample (MEMS with a low-pass filter)
  kPoint,      ///< value at its time; the increment is the trapezoid of two samples
  kPointHeld,  ///< value at its time, held until the next sample: the seed's explicit Euler
};
constexpr auto names(RateMeaning) { return std::array{"mean", "point", "held"}; }

/// The increment between two consecutive samples. @pre from.time < to.time.
ImuIncrement increment_between(const ImuSample& from, const ImuSample& to, RateMeaning meaning);

/// Sum of two increments, component by component: the same sensor read less often.
/// @pre later.time - later.dt_s = sum.time, or sum is new.
void append(ImuIncrement& sum, const ImuIncrement& later);

/// Two parts of an increment, before and after t, the rates taken as constant within it. A fix can
/// so be applied at its own time. @pre inc.time - inc.dt_s < t < inc.time.
std::pair<ImuIncrement, ImuIncrement> split(const ImuIncrement& inc, Time t);

}  // namespace leeway
