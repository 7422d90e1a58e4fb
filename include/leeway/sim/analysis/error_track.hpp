/// @file
/// The linearized error dynamics along a trajectory, computed once and shared by every study of it:
/// what a navigation error, and an unmodelled sensor parameter, become later.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <limits>
#include <memory>
#include <utility>

#include "leeway/covariance/transition.hpp"
#include "leeway/model/process_noise.hpp"
#include "leeway/sim/motion/ground_path.hpp"
#include "leeway/sim/motion/trajectory.hpp"

namespace leeway::sim {

/// The elements of the sensors' matrices of [seed (1)-(2)], column by column: M_a, M_g, G_g.
/// Constants that a 15-state filter does not know.
inline constexpr int kSensorParameters = 27;
inline constexpr int kMa = 0;
inline constexpr int kMg = 9;
inline constexpr int kGg = 18;
using ParameterMatrix = Eigen::Matrix<double, kErrorStates, kSensorParameters>;

/// The dynamics over a stretch of time: error' = Phi error + B parameters.
struct Leg {
  double end_s{};
  Transition Phi{};
  ParameterMatrix B{ParameterMatrix::Zero()};  ///< stays zero unless the track has parameters
  MeanMotion motion{};
};

/// Options of an error track.
struct ErrorTrackConfig {
  double step_s{1.0};                                       ///< longest leg
  bool parameters{false};                                   ///< whether B is wanted
  double tau_a_s{std::numeric_limits<double>::infinity()};  ///< of the filter's bias states
  double tau_g_s{std::numeric_limits<double>::infinity()};
};

class MotionSamples;
class SceneAiding;

/// The dynamics along a trajectory. Attitude, rates and gravity gradient are taken at the middle of
/// pieces a tenth of a leg long and held over the piece: on a turn of 9 deg/s legs of 1 s err by
/// 1e-5 of their effect. Where the motion is steady the middle of a run of up to 64 legs stands for
/// all of them: while it turns by less than 1e-4 rad. A trajectory with a period is sampled over
/// one period.
class ErrorTrack {
 public:
  /// @throws Error unless 0.01 <= step_s <= 100 and 0 < duration_s.
  ErrorTrack(const Trajectory& trajectory, double duration_s, const ErrorTrackConfig& config);

  /// On a motion that was sampled already, config.step_s apart at most.
  ErrorTrack(std::shared_ptr<const MotionSamples> motion, const ErrorTrackConfig& config);

  /// The leg from one time to the other, or to the end of the step that from_s is in, whichever is
  /// earlier.
  /// @pre 0 <= from_s < to_s <= duration.
  Leg leg(double from_s, double to_s) const;

  /// Legs of the whole span, or of one period.
  std::size_t steps() const { return steps_; }
  double step_s() const { return step_s_; }
  bool has_parameters() const { return config_.parameters; }

  /// What the scene's vehicle tells along the way; null where nothing asks for it.
  const std::shared_ptr<const SceneAiding>& aiding() const { return aiding_; }
  void set_aiding(std::shared_ptr<const SceneAiding> aiding) { aiding_ = std::move(aiding); }

  /// Whether the dynamics are the same all the time: at rest on the Earth.
  bool is_stationary() const;

  /// The truth at a time: that of the trajectory, or where it is steady what its middle tells,
  /// within 1e-4 rad and 1 m.
  TruthPoint truth(const Trajectory& trajectory, double t_s) const;

  /// The run that a leg belongs to: legs of the same run are the same.
  std::size_t run_of(std::size_t step) const;

  /// The way along the trajectory.
  const GroundPath& path() const;

  /// Walk from one time to the other: f is called with each leg.
  /// @pre 0 <= from_s, to_s <= duration.
  template <class F>
  void follow(double from_s, double to_s, F&& f) const {
    while (from_s < to_s) {
      const Leg next = leg(from_s, to_s);
      f(next);
      from_s = next.end_s;
    }
  }

 private:
  /// Of a whole leg of a run.
  struct RunDynamics {
    Transition Phi{};
    MeanMotion motion{};
  };
  /// Its rows of attitude, velocity and position; parameters leave the biases alone.
  using RunParameters = Eigen::Matrix<double, kBa, kSensorParameters>;

  void extend(Leg& leg, const ErrorDynamics& dynamics, const ParameterMatrix& input) const;
  Leg part(std::size_t run, double from_s, double to_s) const;

  ErrorTrackConfig config_;
  std::shared_ptr<const MotionSamples> motion_;
  std::size_t steps_;
  double step_s_;  // config_.step_s or a little less: whole steps in the span
  std::deque<RunDynamics> runs_{};
  std::deque<RunParameters> B_{};  // of the runs
  std::shared_ptr<const SceneAiding> aiding_{};
};

}  // namespace leeway::sim
