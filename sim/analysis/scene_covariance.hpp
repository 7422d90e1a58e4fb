/// @file
/// What a scene's filter claims and what is true, side by side, as it runs. Part of
/// covariance_analysis.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "leeway/covariance/covariance.hpp"
#include "leeway/ekf/held_update.hpp"
#include "leeway/model/heading.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/model/process_noise.hpp"
#include "sim/analysis/aiding_rows.hpp"
#include "sim/analysis/truth_model.hpp"

namespace leeway::sim {

inline ErrorMatrix initial_claim(const Scene& scene) {
  return initial_covariance({truth_at(scene.trajectory, 0.0).nav, {}}, initial_sigma(scene),
                            scene.filter.imu, scene.filter.biases);
}

inline ErrorMatrix without_biases(ErrorMatrix P) {
  P.bottomRightCorner<6, 6>().setZero();
  return P;
}

/// The covariance that a scene's filter claims: of the 15 errors, and of the vehicle's parameters
/// where it estimates them.
template <int kParameters>
class Claim {
 public:
  using Vector = Eigen::Matrix<double, kErrorStates + kParameters, 1>;
  using Matrix = Eigen::Matrix<double, kErrorStates + kParameters, kErrorStates + kParameters>;

  explicit Claim(const Scene& scene)
      : imu_(scene.filter.imu), noise_(process_noise(scene.filter.imu, scene.filter.biases)) {
    P_.template topLeftCorner<kErrorStates, kErrorStates>() = initial_claim(scene);
    if constexpr (kParameters > 0) {
      const VehicleState vehicle = vehicle_state(scene.vehicle->config);
      P_.template bottomRightCorner<kParameters, kParameters>() = vehicle.P;
      walk_per_s_ = vehicle.random_walk_per_s;
    }
  }

  const ProcessNoise& noise() const { return noise_; }
  ErrorMatrix errors() const { return P_.template topLeftCorner<kErrorStates, kErrorStates>(); }

  void propagate(const Leg& leg) {
    ErrorMatrix P = errors();
    leeway::propagate(P, leg.Phi, with_motion(noise_, imu_, leg.motion));
    P_.template topLeftCorner<kErrorStates, kErrorStates>() = P;
    if constexpr (kParameters > 0) {
      const VehicleCross cross =
          times(leg.Phi, P_.template topRightCorner<kErrorStates, kParameters>());
      P_.template topRightCorner<kErrorStates, kParameters>() = cross;
      P_.template bottomLeftCorner<kParameters, kErrorStates>() = cross.transpose();
      P_.diagonal().template tail<kParameters>() += leg.Phi.dt_s * walk_per_s_;
    }
  }

  void propagate(const Stretch& stretch) {
    static_assert(kParameters == 0);
    leeway::propagate(P_, stretch.Phi, ProcessNoise{});
    P_ += stretch.claimed_noise;
  }

  void set_errors(const ErrorMatrix& P) {
    P_.template topLeftCorner<kErrorStates, kErrorStates>() = P;
  }

  /// @returns the gain
  Vector take(const Vector& h) {
    Vector K = Vector::Zero();
    scalar_update(P_, K, h, 1.0);
    return K;
  }

  Vector take(const Vector& h, const HeldDirections& held) {
    Vector K = Vector::Zero();
    held_scalar_update(P_, K, h, 1.0, held);
    return K;
  }

 private:
  ImuErrorModel imu_;
  ProcessNoise noise_;
  Matrix P_{Matrix::Zero()};
  VehicleVector walk_per_s_{VehicleVector::Zero()};
};

/// The covariance that a scene's filter claims and the true one, side by side.
template <int kParameters>
class SceneCovariance {
 public:
  /// At the scene's start.
  /// @param by_source  keeps the sources apart, for error_budget()
  /// @param aiding  of the scene's track; null: nothing but fixes is told
  SceneCovariance(const Scene& scene, bool by_source, std::shared_ptr<const SceneAiding> aiding)
      : scene_(&scene),
        claim_(scene),
        truth_(std::in_place, scene, without_biases(claim_.errors()), std::array{claim_.noise()},
               by_source),
        aiding_(std::move(aiding)) {
    const bool fixes_as_white = scene.filter.gnss_correlation_s == 0.0;
    if constexpr (kParameters == 0) {
      if (!is_aided() && fixes_as_white &&
          truth_->is_known_to(claim_.errors(), fix_variance(scene.gnss.errors))) {
        truth_.reset();
      }
    }
  }

  void propagate(const Leg& leg) {
    claim_.propagate(leg);
    if (truth_) truth_->propagate(leg);
    if (is_aided()) aid(leg.end_s);
  }

  /// Whether stretches of many legs may be taken, and fixes that hold nothing be doubled.
  bool takes_stretches() const {
    return kParameters == 0 && !is_aided() && (!truth_ || truth_->takes_stretches());
  }

  /// @pre takes_stretches()
  void propagate(const Stretch& stretch) {
    claim_.propagate(stretch);
    if (truth_) truth_->propagate(stretch);
  }

  Claim<kParameters>& claim() { return claim_; }
  /// None where the claim is the truth.
  std::optional<TruthModel<1, kParameters>>& truth_model() { return truth_; }

  /// Takes the fix into both with the filter's gains.
  void update(const FixRows& fix, Held held, double t_s) {
    FixGains<1, kParameters> gains;
    const HeldDirections U = directions(held, t_s);
    for (int row = 0; row < fix.H.rows(); ++row) {
      typename Claim<kParameters>::Vector h = Claim<kParameters>::Vector::Zero();
      h.template head<kErrorStates>() = fix.H.row(row).transpose();
      gains.col(row) = held == Held::kNothing ? claim_.take(h) : claim_.take(h, U);
    }
    if (truth_) truth_->update(fix, gains);
  }

  ErrorMatrix claimed() const { return claim_.errors(); }
  ErrorMatrix truth() const {
    if (!truth_) return claimed();
    return truth_->covariance().template topLeftCorner<kErrorStates, kErrorStates>();
  }

  /// Whether rest or even motion cannot tell the heading better than it is known. @pre has aiding
  bool heading_is_hidden(double t_s) const {
    return rest_hides_heading(scene_->filter.imu, aiding_->truth(t_s), claim_.errors());
  }

  /// As CovariancePoint has it.
  Eigen::Matrix3d innovation_n_m2(const Eigen::Matrix3d& C_en) const {
    if (truth_) return truth_->innovation_n_m2(C_en);
    Eigen::Matrix3d moment = C_en.transpose() * claimed().template block<3, 3>(kDr, kDr) * C_en;
    moment.diagonal() += fix_variance(scene_->gnss.errors).template head<3>();
    return moment;
  }

  /// @pre made by source.
  ErrorBudget error_budget(const Eigen::Matrix3d& C_en) const { return truth_->error_budget(C_en); }

 private:
  bool is_aided() const { return aiding_ && aiding_->has_rows(); }

  HeldDirections directions(Held held, double t_s) const {
    if (held == Held::kNothing) return HeldDirections::Zero();
    return directions_of(held, aiding_->truth(t_s));
  }

  void aid(double to_s) {
    const auto rows = aiding_->rows(to_s);
    if (rows.empty()) return;
    const bool hides = rows.front().held != Held::kNothing && heading_is_hidden(to_s);
    for (const AidingRow& row : rows) {
      const Held held = hides ? row.held : Held::kNothing;
      RowGain<1, kParameters> gain{row.kind, row.per_sigma};
      gain.h = row.h.template head<kErrorStates + kParameters>();
      gain.K = held == Held::kNothing ? claim_.take(gain.h)
                                      : claim_.take(gain.h, directions(held, to_s));
      truth_->update(gain);
    }
  }

  const Scene* scene_;
  Claim<kParameters> claim_;
  /// None: the filter knows all there is, its claim is the truth.
  std::optional<TruthModel<1, kParameters>> truth_;
  std::shared_ptr<const SceneAiding> aiding_;
};

}  // namespace leeway::sim
