#include "leeway/sim/analysis/error_track.hpp"

#include <algorithm>
#include <cmath>

#include "sim/analysis/motion_samples.hpp"

namespace leeway::sim {
namespace {

constexpr double kSlack = MotionSamples::kSlack;

/// What the parameters add to the error per second. Signs by error_state.hpp: a bias b enters as
/// -C_eb b, and a matrix error acts as the bias M f or M omega.
ParameterMatrix parameter_input(const Eigen::Matrix3d& C_eb, const Eigen::Vector3d& f_b_mps2,
                                const Eigen::Vector3d& omega_ib_b_radps) {
  ParameterMatrix input = ParameterMatrix::Zero();
  for (int column = 0; column < 3; ++column) {
    input.block<3, 3>(kDv, kMa + 3 * column) = -f_b_mps2(column) * C_eb;
    input.block<3, 3>(kPsi, kMg + 3 * column) = -omega_ib_b_radps(column) * C_eb;
    input.block<3, 3>(kPsi, kGg + 3 * column) = -f_b_mps2(column) * C_eb;
  }
  return input;
}

}  // namespace

ErrorTrack::ErrorTrack(const Trajectory& trajectory, double duration_s,
                       const ErrorTrackConfig& config)
    : ErrorTrack(std::make_shared<MotionSamples>(trajectory, duration_s, config.step_s), config) {}

ErrorTrack::ErrorTrack(std::shared_ptr<const MotionSamples> motion, const ErrorTrackConfig& config)
    : config_(config),
      motion_(std::move(motion)),
      steps_(motion_->steps()),
      step_s_(motion_->step_s()) {
  for (std::size_t run = 0; run < motion_->runs().size(); ++run) {
    const Leg whole = part(run, 0.0, step_s_);
    runs_.push_back({whole.Phi, whole.motion});
    if (config_.parameters) B_.emplace_back(whole.B.topRows<kBa>());
  }
}

std::size_t ErrorTrack::run_of(std::size_t step) const { return motion_->run_of(step); }

const GroundPath& ErrorTrack::path() const { return motion_->path(); }

TruthPoint ErrorTrack::truth(const Trajectory& trajectory, double t_s) const {
  return motion_->truth(trajectory, t_s);
}

Leg ErrorTrack::leg(double from_s, double to_s) const {
  const double steps_before = std::floor(from_s / step_s_ + kSlack);
  const std::size_t run = run_of(static_cast<std::size_t>(steps_before) % steps_);
  const double start_s = steps_before * step_s_;
  const double offset_s = from_s - start_s;
  const double slack_s = kSlack * step_s_;
  const bool to_the_end = to_s > start_s + step_s_ - slack_s;
  Leg result;
  if (to_the_end && offset_s < slack_s) {
    result.Phi = runs_[run].Phi;
    result.motion = runs_[run].motion;
    if (config_.parameters) result.B.topRows<kBa>() = B_[run];
  } else {
    result = part(run, offset_s, to_the_end ? step_s_ : to_s - start_s);
  }
  // The last sliver of a step is no leg of its own.
  result.end_s = to_the_end && to_s > start_s + step_s_ + slack_s ? start_s + step_s_ : to_s;
  return result;
}

bool ErrorTrack::is_stationary() const {
  using Piece = MotionSamples::Piece;
  const Piece& first = motion_->pieces().front();
  return std::ranges::all_of(motion_->pieces(), [&first](const Piece& piece) {
    constexpr double kRounding = 1e-9;  // rad, m/s^2
    return piece.q_eb.angularDistance(first.q_eb) < kRounding &&
           (piece.f_b_mps2 - first.f_b_mps2).norm() < kRounding;
  });
}

void ErrorTrack::extend(Leg& leg, const ErrorDynamics& dynamics,
                        const ParameterMatrix& input) const {
  advance(leg.Phi, dynamics);
  if (!config_.parameters) return;
  Transition Phi;
  advance(Phi, dynamics);
  const ParameterMatrix half = 0.5 * dynamics.dt_s * input;
  leg.B = times(Phi, leg.B + half) + half;
}

Leg ErrorTrack::part(std::size_t index, double from_s, double to_s) const {
  const MotionSamples::Run& run = motion_->runs()[index];
  const double piece_s = motion_->piece_s();
  Leg leg;
  ErrorDynamics dynamics;
  dynamics.gravity_gradient_e = run.gravity_gradient_e;
  ParameterMatrix input;
  for (std::size_t i = 0; i < MotionSamples::kPiecesPerStep; ++i) {
    const double begin_s = std::max(from_s, static_cast<double>(i) * piece_s);
    const double dt_s = std::min(to_s, static_cast<double>(i + 1) * piece_s) - begin_s;
    if (dt_s <= MotionSamples::kSlack * piece_s) continue;
    const MotionSamples::Piece& piece = motion_->piece(run, i);
    if (leg.Phi.dt_s == 0.0 || !run.is_steady) {
      dynamics.C_eb_mean = piece.q_eb.toRotationMatrix();
      if (config_.parameters) {
        input = parameter_input(dynamics.C_eb_mean, piece.f_b_mps2, piece.omega_ib_b_radps);
      }
    }
    dynamics.dt_s = dt_s;
    dynamics.dv_f_e_mps = dt_s * (dynamics.C_eb_mean * piece.f_b_mps2);
    dynamics.a_a = bias_decay(dt_s, config_.tau_a_s);
    dynamics.g_g = bias_decay(dt_s, config_.tau_g_s);
    extend(leg, dynamics, input);
    leg.motion.omega_ib_b_radps += dt_s * piece.motion.omega_ib_b_radps;
    leg.motion.acceleration_e_mps2 += dt_s * piece.motion.acceleration_e_mps2;
  }
  leg.motion.omega_ib_b_radps /= leg.Phi.dt_s;
  leg.motion.acceleration_e_mps2 /= leg.Phi.dt_s;
  return leg;
}

}  // namespace leeway::sim
