/// @file
/// What the innovations say of a sensor's claimed noise.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "leeway/earth/time.hpp"
#include "leeway/monitors/nis_cusum.hpp"

namespace leeway {

/// A factor on the standard deviations that a receiver claims, learned from how much the
/// innovations change from one fix to the next: that is its noise, while what they have in common
/// is an error that lasts, the receiver's or the filter's. Up to 1000 when the receiver is
/// over-confident; within a band around 1 the claim is left alone. Source:
/// docs/theory/monitors/receiver_noise.md.
class ReceiverNoise {
 public:
  static constexpr int kWindow = 30;  ///< fixes

  /// @param smallest  how far down a modest claim may be scaled, at most 1. Errors that are alike
  ///                  from fix to fix do not show here, and count.
  /// @param shows_imu  whether the IMU's errors change the innovations from fix to fix, as those of
  ///                   velocities
  ReceiverNoise(double smallest, bool shows_imu) : smallest_(smallest), shows_imu_(shows_imu) {}

  double sigma_scale() const { return sigma_scale_; }

  /// Mean of nis / dof over the last 30 fixes or so, by the scaled claim; 1 before any.
  double nis_ratio() const { return nis_ratio_; }

  /// The same over the last 10 fixes or so.
  double recent_nis_ratio() const { return recent_nis_ratio_; }

  /// Whether nis_ratio() is beyond what chance makes of so many fixes.
  bool is_inconsistent() const;

  /// Whether the newest one made the last few larger than chance allows.
  bool is_surprising() const { return is_surprising_; }

  /// Whether errors repeat themselves from fix to fix: over a full window the innovations change by
  /// less than half of what white errors of the claimed size would make them.
  bool errors_last() const;

  /// Whether nis_ratio() is the mean of a full window.
  bool has_full_window() const { return nis_count_ >= kWindow; }

  /// Forgets how consistent the innovations were: another filter claims anew. The scale stays.
  void begin_claims();

  /// Of three components judged with the present scale, fused or gated.
  /// @param innovation  measured - predicted
  /// @param R           as claimed, not scaled
  /// @param is_white    whether the receiver's errors differ from fix to fix: else a row of them is
  ///                    as one, and no surprise
  void note(Time t, const Eigen::Vector3d& innovation, const Eigen::Matrix3d& R, double nis,
            bool is_white);

  /// How consistent an innovation is, and nothing of the receiver: the filter may be the wrong one.
  void note_claim(double nis);

  template <class Archive>
  void visit(Archive& archive) {
    archive(sigma_scale_, nis_ratio_, recent_nis_ratio_, change_ratio_, nis_count_, change_count_,
            previous_, previous_innovation_, surprises_, calms_, cusum_, mean_, is_surprising_);
  }

 private:
  void note_mean(const Eigen::Vector3d& by_R, double nis);

  double smallest_;
  bool shows_imu_;
  double sigma_scale_{1.0};
  double nis_ratio_{1.0};
  double recent_nis_ratio_{1.0};
  double change_ratio_{1.0};  // of squared changes to what the claim lets expect
  std::int64_t nis_count_{0};
  std::int64_t change_count_{0};
  std::optional<Time> previous_{};
  NisCusum cusum_{};
  Eigen::Vector3d mean_{Eigen::Vector3d::Zero()};  // of the innovations, in their own sigmas
  bool is_surprising_{false};
  std::int64_t surprises_{0};  // changes in a row that are far beyond the claim
  std::int64_t calms_{0};      // ... and far below the scaled one
  Eigen::Vector3d previous_innovation_{Eigen::Vector3d::Zero()};
};

}  // namespace leeway
