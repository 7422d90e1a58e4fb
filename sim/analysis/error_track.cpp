#include "leeway/sim/analysis/error_track.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/ekf/inertial_estimate.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway::sim {
namespace {

constexpr int kPiecesPerStep = 10;
constexpr double kSlack = 1e-7;  // of a step: times this close are the same

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
    : config_(config) {
  require("error track", "step_s", config.step_s, between(0.01, 100.0));
  require("error track", "duration_s", duration_s, kPositive);
  const double period_s = trajectory.period_s.value_or(duration_s);
  const double span_s = std::min(period_s, duration_s);
  const auto steps = static_cast<std::size_t>(std::ceil(span_s / config.step_s - kSlack));
  step_s_ = span_s / static_cast<double>(steps);
  piece_s_ = step_s_ / kPiecesPerStep;
  pieces_.reserve(steps * kPiecesPerStep);
  MeanMotion mean;
  for (std::size_t k = 0; k < steps * kPiecesPerStep; ++k) {
    const TruthPoint truth = truth_at(trajectory, (static_cast<double>(k) + 0.5) * piece_s_);
    const double window_s = std::max(
        std::min(static_cast<double>(k + 1) * piece_s_, InertialEstimate::kMeanRateS), piece_s_);
    const Eigen::Vector3d acceleration_e_mps2 =
        truth.nav.q_eb * truth.f_ib_b_mps2 + gravity_e(GravityModel::kNormal, truth.nav.r_e_m);
    mean.omega_ib_b_radps += piece_s_ / window_s * (truth.omega_ib_b_radps - mean.omega_ib_b_radps);
    mean.acceleration_e_mps2 +=
        piece_s_ / window_s * (acceleration_e_mps2 - mean.acceleration_e_mps2);
    pieces_.push_back({truth.nav.q_eb.toRotationMatrix(), gravity_gradient_e(truth.nav.r_e_m),
                       truth.f_ib_b_mps2, truth.omega_ib_b_radps, mean});
  }
  Phi_.reserve(steps);
  for (std::size_t step = 0; step < steps; ++step) {
    const Leg whole = part(step, 0.0, step_s_);
    Phi_.push_back(whole.Phi);
    motion_.push_back(whole.motion);
    if (config_.parameters) B_.push_back(whole.B);
  }
}

Leg ErrorTrack::leg(double from_s, double to_s) const {
  const double steps_before = std::floor(from_s / step_s_ + kSlack);
  const std::size_t step = static_cast<std::size_t>(steps_before) % Phi_.size();
  const double start_s = steps_before * step_s_;
  const double offset_s = from_s - start_s;
  const double slack_s = kSlack * step_s_;
  const bool to_the_end = to_s > start_s + step_s_ - slack_s;
  Leg result;
  if (to_the_end && offset_s < slack_s) {
    result.Phi = Phi_[step];
    result.motion = motion_[step];
    if (config_.parameters) result.B = B_[step];
  } else {
    result = part(step, offset_s, to_the_end ? step_s_ : to_s - start_s);
  }
  // The last sliver of a step is no leg of its own.
  result.end_s = to_the_end && to_s > start_s + step_s_ + slack_s ? start_s + step_s_ : to_s;
  return result;
}

void ErrorTrack::extend(Leg& leg, const Piece& piece, double dt_s) const {
  ErrorDynamics dynamics;
  dynamics.dt_s = dt_s;
  dynamics.C_eb_mean = piece.C_eb;
  dynamics.dv_f_e_mps = dt_s * (piece.C_eb * piece.f_b_mps2);
  dynamics.gravity_gradient_e = piece.gravity_gradient_e;
  dynamics.a_a = bias_decay(dt_s, config_.tau_a_s);
  dynamics.g_g = bias_decay(dt_s, config_.tau_g_s);
  advance(leg.Phi, dynamics);
  if (!config_.parameters) return;
  Transition Phi;
  advance(Phi, dynamics);
  const ParameterMatrix half =
      0.5 * dt_s * parameter_input(piece.C_eb, piece.f_b_mps2, piece.omega_ib_b_radps);
  leg.B = times(Phi, leg.B + half) + half;
}

Leg ErrorTrack::part(std::size_t step, double from_s, double to_s) const {
  Leg leg;
  for (std::size_t i = 0; i < kPiecesPerStep; ++i) {
    const double begin_s = std::max(from_s, static_cast<double>(i) * piece_s_);
    const double end_s = std::min(to_s, static_cast<double>(i + 1) * piece_s_);
    if (end_s - begin_s <= kSlack * piece_s_) continue;
    const Piece& piece = pieces_[step * kPiecesPerStep + i];
    extend(leg, piece, end_s - begin_s);
    leg.motion.omega_ib_b_radps += (end_s - begin_s) * piece.motion.omega_ib_b_radps;
    leg.motion.acceleration_e_mps2 += (end_s - begin_s) * piece.motion.acceleration_e_mps2;
  }
  leg.motion.omega_ib_b_radps /= leg.Phi.dt_s;
  leg.motion.acceleration_e_mps2 /= leg.Phi.dt_s;
  return leg;
}

}  // namespace leeway::sim
