#include "sim/inspect/imu_scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "leeway/earth/units.hpp"

namespace leeway::sim {
namespace {

constexpr double kWindowS = 1.0;
/// Gyros and accelerometers of less range than 100 deg/s and 1.9 g are not sold for vehicles.
constexpr double kLeastGyroScaleRadps = 100.0 * kRadPerDeg;
constexpr double kLeastForceScaleMps2 = 1.9 * kStandardGravityMps2;
/// Values that differ by less, relative, are one: they are quotients of sums.
constexpr double kRounding = 1e-9;
constexpr std::int64_t kFewSamples = 100;  ///< of which none is called stuck

}  // namespace

void ThinnedMedian::add(double value) {
  if (count_++ % every_ != 0) return;
  values_.push_back(value);
  if (values_.size() < kMost) return;
  for (std::size_t k = 0; k < kMost / 2; ++k) values_[k] = values_[2 * k];
  values_.resize(kMost / 2);
  every_ *= 2;
}

void FullScale::add(const Eigen::Vector3d& value) {
  const double magnitude = value.cwiseAbs().maxCoeff();
  if (magnitude < largest_ * (1.0 - kRounding)) return;
  if (magnitude > largest_ * (1.0 + kRounding)) count_ = 0;
  largest_ = std::max(largest_, magnitude);
  ++count_;
}

ImuScan::ImuScan() : gyro_scale_(kLeastGyroScaleRadps), accelerometer_scale_(kLeastForceScaleMps2) {
  least_.fill(Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()));
  most_.fill(Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity()));
}

void ImuScan::add(const ImuIncrement& inc) {
  times_.add(inc.time);
  ++count_;
  const double per_s = 1.0 / inc.dt_s;
  const std::array values{Eigen::Vector3d(per_s * inc.dtheta_b_rad),
                          Eigen::Vector3d(per_s * inc.dv_b_mps)};
  for (std::size_t k = 0; k < 2; ++k) {
    least_[k] = least_[k].cwiseMin(values[k]);
    most_[k] = most_[k].cwiseMax(values[k]);
  }
  gyro_scale_.add(values[0]);
  accelerometer_scale_.add(values[1]);
  window_s_ += inc.dt_s;
  window_dv_mps_ += inc.dv_b_mps;
  if (window_s_ < kWindowS) return;
  const Eigen::Vector3d f_b_mps2 = window_dv_mps_ / window_s_;
  force_mps2_.add(f_b_mps2.norm());
  force_sum_mps2_ += f_b_mps2;
  magnitude_sum_mps2_ += f_b_mps2.norm();
  window_s_ = 0.0;
  window_dv_mps_.setZero();
}

ImuFigures ImuScan::figures() const {
  ImuFigures f;
  f.time = times_.figures();
  f.specific_force_mps2 = force_mps2_.median();
  if (magnitude_sum_mps2_ > 0.0) {
    f.up_b = force_sum_mps2_.normalized();
    f.steadiness = force_sum_mps2_.norm() / magnitude_sum_mps2_;
  }
  for (std::size_t channel = 0; channel < 6 && count_ > kFewSamples; ++channel) {
    const auto axis = static_cast<Eigen::Index>(channel % 3);
    const double low = least_[channel / 3][axis];
    const double high = most_[channel / 3][axis];
    f.is_stuck[channel] = high - low <= kRounding * std::max(std::abs(low), std::abs(high));
  }
  f.saturated = gyro_scale_.samples() + accelerometer_scale_.samples();
  return f;
}

}  // namespace leeway::sim
