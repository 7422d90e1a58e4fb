/// @file
/// A trajectory as linear analyses see it, taken as densely as it changes: what the error tracks of
/// all IMUs on it share.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

#include "leeway/model/process_noise.hpp"
#include "leeway/sim/motion/ground_path.hpp"
#include "leeway/sim/motion/trajectory.hpp"

namespace leeway::sim {

class MotionSamples {
 public:
  static constexpr int kPiecesPerStep = 10;
  static constexpr double kSlack = 1e-7;  // of a step: times this close are the same

  /// The motion at the middle of a piece of a step.
  struct Piece {
    Eigen::Quaterniond q_eb;
    Eigen::Vector3d f_b_mps2;
    Eigen::Vector3d omega_ib_b_radps;
    MeanMotion motion;  // as the filter's, over the seconds before
  };

  /// Steps in a row with the same motion: one step of many pieces, or many of one.
  struct Run {
    std::size_t first_piece{};
    bool is_steady{};
    Eigen::Matrix3d gravity_gradient_e{Eigen::Matrix3d::Zero()};
    TruthPoint middle{};
    double middle_s{};
    Eigen::Vector3d gain_e_mps2{Eigen::Vector3d::Zero()};  // of velocity over the run
  };

  /// @param step_s  the longest step
  /// @throws Error unless 0.01 <= step_s <= 100 and 0 < duration_s.
  MotionSamples(const Trajectory& trajectory, double duration_s, double step_s);

  /// Steps of the whole span, or of one period.
  std::size_t steps() const { return run_of_.size(); }
  double step_s() const { return step_s_; }
  double piece_s() const { return step_s_ / kPiecesPerStep; }
  const GroundPath& path() const { return path_; }

  /// By index: the run that a step belongs to, all runs, and the pieces of a run.
  std::size_t run_of(std::size_t step) const { return run_of_[step]; }
  const std::deque<Run>& runs() const { return runs_; }
  const Piece& piece(const Run& run, std::size_t index) const {
    return pieces_[run.first_piece + (run.is_steady ? 0 : index)];
  }
  const std::deque<Piece>& pieces() const { return pieces_; }

  /// The truth at a time: that of the trajectory, or where it is steady what its middle tells,
  /// within 1e-4 rad and 1 m.
  TruthPoint truth(const Trajectory& trajectory, double t_s) const;

  /// The truth at the start and the ends of steps, in one lap after the other up to a time; worked
  /// out when it is first asked for, and kept. Safe to share between threads.
  const std::vector<TruthPoint>& ends(const Trajectory& trajectory, double until_s) const;

 private:
  class Sampler;

  double step_s_;  // the longest or a little less: whole steps in the span
  GroundPath path_;
  std::deque<Piece> pieces_{};
  std::deque<Run> runs_{};
  std::vector<std::uint32_t> run_of_{};
  mutable std::once_flag has_ends_{};
  mutable std::vector<TruthPoint> ends_{};
};

}  // namespace leeway::sim
