/// @file
/// Strapdown mechanization in the Earth-fixed frame [seed (3)-(8)], with the integration scheme and
/// the Earth terms as compile-time policies. Nothing here allocates, throws or logs.
#pragma once

#include <Eigen/Core>
#include <array>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/fields.hpp"
#include "leeway/earth/names.hpp"
#include "leeway/sensors/imu.hpp"
#include "leeway/strapdown/nav_state.hpp"

namespace leeway {

/// Integration schemes: how one increment advances the state. Their errors on a 100 s car drive are
/// in docs/theory/strapdown/strapdown.md.
enum class Scheme {
  kExplicitEuler,      ///< the seed's (3)-(8): first order
  kSemiImplicitEuler,  ///< as the seed, but position from the new velocity: first order
  kTrapezoid,          ///< mean of both ends' attitude and velocity: second order
  kOneSample,          ///< exact for constant rate and force within the increment: second order
  kTwoSample,          ///< + coning, sculling, position curvature over pairs: fourth order on equal
                       ///< intervals, third on unequal ones (default)
  kRungeKutta4,  ///< cubic rates through four increments, RK4: fourth order on any intervals; the
                 ///< reference to judge by, given six increments in a period of the motion
  kConing,       ///< one sample + coning alone of what two samples add
  kSculling,     ///< one sample + sculling and position curvature alone
};
constexpr auto names(Scheme) {
  return std::array{"explicit-euler", "semi-implicit-euler", "trapezoid", "one-sample",
                    "two-sample",     "runge-kutta-4",       "coning",    "sculling"};
}
/// What `leeway fuse --scheme` called kRungeKutta4 once.
constexpr std::optional<Scheme> alias(Scheme, std::string_view word) {
  return word == "rk4" ? std::optional(Scheme::kRungeKutta4) : std::nullopt;
}

/// Terms of the Earth's rotation: the turn of the frame, which the attitude sees, and Coriolis.
enum class EarthRotation { kOff, kOn, kTurnAlone, kCoriolisAlone };
constexpr auto names(EarthRotation) {
  return std::array{"still", "turning", "turn-alone", "coriolis-alone"};
}

/// Recent past that a scheme looks back on. It survives a correction of the state, and is forgotten
/// by itself when the next increment does not follow the last one.
struct ImuHistory {
  static constexpr int kLength = 4;
  std::array<ImuIncrement, kLength>
      recent{};  ///< newest first; kTwoSample uses one, kRungeKutta4 four
  int count{0};  ///< how many of them are valid

  // kTwoSample: what looking back added to the newest step, and whether a second one completes the
  // pair and settles it.
  bool pair_open{false};
  Eigen::Vector3d coning_b_rad{Eigen::Vector3d::Zero()};
  Eigen::Vector3d sculling_b_mps{Eigen::Vector3d::Zero()};
  Eigen::Vector3d dv_e_mps{Eigen::Vector3d::Zero()};  ///< velocity change of the newest step

  // kRungeKutta4: the states before the oldest and after the newest, while count < 4.
  NavState first{};
  NavState last{};
};

/// Motion over a step, for the error model of a filter.
struct StrapdownStep {
  Eigen::Matrix3d C_eb_mean{Eigen::Matrix3d::Identity()};  ///< mean attitude over the step
  Eigen::Vector3d dv_f_e_mps{Eigen::Vector3d::Zero()};     ///< integral of specific force, in ECEF
};

/// Step of the state over one increment. @pre inc.dt_s > 0, inc.time - state.time = inc.dt_s.
template <Scheme scheme = Scheme::kTwoSample, GravityModel gravity = GravityModel::kNormal,
          EarthRotation rotation = EarthRotation::kOn>
StrapdownStep strapdown_step(NavState& state, const ImuIncrement& inc, ImuHistory& history);

/// Policies as values, for programs that choose at run time.
struct StrapdownPolicy {
  Scheme scheme{Scheme::kTwoSample};
  GravityModel gravity{GravityModel::kNormal};
  EarthRotation rotation{EarthRotation::kOn};

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"scheme", c.scheme}, Field{"gravity", c.gravity},
                   Field{"rotation", c.rotation});
  }
};

using StrapdownFunction = StrapdownStep (*)(NavState&, const ImuIncrement&, ImuHistory&);

/// Step of policies chosen at run time: strapdown_step() of the same policies.
StrapdownFunction strapdown_function(const StrapdownPolicy& policy);

}  // namespace leeway
