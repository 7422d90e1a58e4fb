#include "sim/analysis/scene_covariance.hpp"

#include "leeway/covariance/covariance.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway::sim {
namespace {

Estimate start_of(const Scene& scene) {
  Estimate start;
  start.nav = truth_at(scene.trajectory, 0.0).nav;
  return start;
}

ErrorMatrix without_biases(ErrorMatrix P) {
  P.bottomRightCorner<6, 6>().setZero();
  return P;
}

}  // namespace

SceneCovariance::SceneCovariance(const Scene& scene, bool by_source)
    : imu_(scene.filter.imu),
      noise_(process_noise(scene.filter.imu, scene.filter.biases)),
      P_(initial_covariance(start_of(scene), initial_sigma(scene), scene.filter.imu,
                            scene.filter.biases)),
      truth_(std::in_place, scene, without_biases(P_), std::array{noise_}, by_source) {
  const bool fixes_as_white = scene.filter.gnss_correlation_s == 0.0;
  if (fixes_as_white && truth_->is_known_to(P_, fix_variance(scene.gnss.errors))) {
    truth_.reset();
  }
}

void SceneCovariance::propagate(const Leg& leg) {
  leeway::propagate(P_, leg.Phi, with_motion(noise_, imu_, leg.motion));
  if (truth_) truth_->propagate(leg);
}

void SceneCovariance::update(const FixRows& fix) {
  FixGains<1> gains;
  for (int row = 0; row < fix.H.rows(); ++row) {
    const ErrorVector h = fix.H.row(row).transpose();
    const ErrorVector cross = P_ * h;
    gains.col(row) = cross / (h.dot(cross) + 1.0);
    ErrorVector none = ErrorVector::Zero();
    scalar_update(P_, none, h, 0.0);
  }
  if (truth_) truth_->update(fix, gains);
}

}  // namespace leeway::sim
