/// @file
/// What a stretch of time with fixes makes of any covariance, as a map that can be doubled: that of
/// 2^k equal stretches takes k products. Part of covariance_analysis.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace leeway::sim {

/// The covariance that a filter claims, and E[x x^T] of its error.
struct MomentPair {
  Eigen::MatrixXd claimed{};
  Eigen::MatrixXd truth{};
};

/// P' = H + A (P^-1 + G)^-1 A^T: A is the way of an error when nothing is known at the start, G the
/// information about the start that is gained on the way, H what is unknown at the end of a start
/// that is known. The true moment is the derivative of this map in the direction of the true
/// noises: gains that are the best for the claim have no effect of first order on the claim.
/// Source: Chu, Fan, Lin, Wang (2004), the doubling of (A, G, H); Anderson, Moore (1979), section
/// 6.7.
class RiccatiMap {
 public:
  /// The map that changes nothing. @param with_truth  whether the true moment is wanted
  RiccatiMap(Eigen::Index states, bool with_truth);

  /// Adds propagation: P' = Phi P Phi^T + noise.
  /// @param true_noise  ignored without truth
  void propagate(const Eigen::MatrixXd& Phi, const Eigen::MatrixXd& claimed_noise,
                 const Eigen::MatrixXd& true_noise);

  /// Adds a scalar measurement, h x + noise, whose variance the filter takes for 1.
  void measure(const Eigen::VectorXd& h, double true_variance);

  /// Adds what the other map does.
  void then(const RiccatiMap& later);

  /// Both moments at the end, of those at the start.
  MomentPair of(const MomentPair& start) const;

  /// What the errors at the start become, filter at work.
  Eigen::MatrixXd closed_loop(const Eigen::MatrixXd& claimed_at_start) const;

  Eigen::Index states() const { return map_.A.rows(); }
  bool with_truth() const { return tangent_.A.size() > 0; }

 private:
  struct Triple {
    Eigen::MatrixXd A{}, G{}, H{};
  };

  /// The derivative of the later map on top of this one. @param V  (I + H G_later)^-1 of the two
  Triple joint_tangent(const RiccatiMap& later, const Eigen::MatrixXd& V) const;

  Triple map_{};
  Triple tangent_{};  // empty without truth
};

/// So many of these maps in a row.
RiccatiMap repeated(RiccatiMap map, std::int64_t times);

}  // namespace leeway::sim
