#include <memory>

#include "filters/ekf/basic_ekf.hpp"
#include "leeway/model/process_noise.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/trials.hpp"
#include "sim/atlas/watched_ekf.hpp"

namespace leeway::sim::scenes {
namespace {

/// A kernel whose gain leaves attitude and gyro bias alone: what is done to keep a filter from
/// learning what it cannot know.
class EditedGainKernel {
 public:
  using Number = double;

  explicit EditedGainKernel(const ErrorMatrix& P, UpdateForm form = UpdateForm::kJoseph)
      : P_(P), form_(form) {}
  ErrorMatrix matrix() const { return P_; }
  void propagate(const Transition& Phi, const ProcessNoise& noise) {
    leeway::propagate(P_, Phi, noise);
  }

  double update(ErrorVector& x_hat, const ErrorVector& h, double z) {
    const ErrorVector Ph = P_.lazyProduct(h);
    const double variance = h.dot(Ph) + 1.0;
    ErrorVector K = Ph / variance;
    K.segment<3>(kPsi).setZero();
    K.segment<3>(kBg).setZero();
    x_hat += (z - h.dot(x_hat)) * K;
    const ErrorMatrix left = ErrorMatrix::Identity() - K * h.transpose();
    P_ = left.lazyProduct(P_).eval();
    if (form_ == UpdateForm::kJoseph) {
      P_ = P_.lazyProduct(left.transpose()).eval() + K * K.transpose();
    }
    P_ = (0.5 * (P_ + P_.transpose())).eval();
    return variance;
  }

  double update(ErrorVector& x_hat, const MeasurementRows& H, const MeasurementValues& z) {
    return update_in_sequence(*this, x_hat, H, z);
  }

 private:
  ErrorMatrix P_;
  UpdateForm form_;
};

AtlasColumn edited_column(const std::string& name, UpdateForm form) {
  return {AtlasGroup::kNotOffered, name, [form](const EkfConfig& config, const TrialStart& start) {
            EkfConfig ungated = config;
            ungated.gate_probability = 0.0;
            return std::make_unique<WatchedEkf<EditedGainKernel, AdditiveError>>(
                BasicEkf(ungated, start.estimate, EditedGainKernel(start.P, form)));
          }};
}

std::vector<AtlasCell> run_edited_gain(const AtlasOptions& options) {
  const Scene scene =
      drive_scene(circle({.duration_s = 120.0}), 20.0,
                  {.tilt_rad = 1e-3, .heading_rad = 5e-3, .velocity_mps = 0.1, .position_m = 2.5},
                  imu_class_model(ImuClass::kTactical, RangeEnd::kMid));
  std::vector<AtlasColumn> columns = claiming(few_atlas_columns());
  // What the library offers for it: a Schmidt update.
  columns.push_back(
      ekf_column(AtlasGroup::kEkf, "Ekf with heading held", {.held = Held::kHeadingAndTurn}));
  columns.push_back(edited_column("edited gain in Joseph's form", UpdateForm::kJoseph));
  columns.push_back(edited_column("edited gain in the short form", UpdateForm::kSimple));
  return scored(columns, scene.filter, recorded_trials(scene, options.brief ? 4 : 20), {},
                score_after(60.0, &ErrorSums::sigma_ratio));
}

}  // namespace

AtlasScene edited_gain() {
  return {.place = 20,
          .key = "edited-gain",
          .title = "A gain edited by hand",
          .figure = "errors over claims: root of NEES over 15",
          .limits = {1.3, 2.0,
                     "of 1, by how much few trials scatter; at 2 the claim of 95 % is one of 67 %"},
          .run = run_edited_gain};
}

}  // namespace leeway::sim::scenes
