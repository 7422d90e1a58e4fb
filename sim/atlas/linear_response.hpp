/// @file
/// What an error at the start becomes without fixes: truly, by paired runs of the strapdown, and by
/// the claim of a filter that knows of that error alone.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "leeway/model/error_state.hpp"
#include "leeway/sensors/imu.hpp"
#include "leeway/sim/motion/trajectory.hpp"
#include "sim/atlas/cells.hpp"
#include "sim/atlas/watched_filter.hpp"

namespace leeway::sim {

/// Perfect sensors on a trajectory, and errors that an estimate starts with: each of them one
/// sigma, independent of the others, and small enough for their effect to be linear.
class LinearResponse {
 public:
  LinearResponse(const Trajectory& trajectory, double rate_hz, double duration_s,
                 std::vector<ErrorVector> start_errors);

  const Estimate& start() const { return start_; }

  /// A size of what filters claim at the end, told of no noise, over that of the truth, as a factor
  /// of at least 1. Last the cell of a transition matrix that the library does not have.
  std::vector<AtlasCell> compared(const std::vector<AtlasColumn>& columns,
                                  const std::string& condition,
                                  const std::function<double(const ErrorMatrix& moment)>& size,
                                  const std::string& not_offered, const ErrorMatrix& Phi) const;

 private:
  /// By runs of the strapdown that start wrong and right.
  ErrorMatrix true_moment() const;
  Estimate strapdown_from(const Estimate& start) const;
  ErrorMatrix start_moment() const;

  std::vector<ErrorVector> start_errors_;
  std::vector<ImuIncrement> imu_;
  Estimate start_;
};

/// How far apart a claimed and a true size are, as a factor of at least 1. Infinite unless both are
/// above zero.
double factor_between(double claimed, double truth);

}  // namespace leeway::sim
