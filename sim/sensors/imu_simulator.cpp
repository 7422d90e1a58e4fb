#include "leeway/sim/sensors/imu_simulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>

#include "leeway/earth/error.hpp"

namespace leeway::sim {
namespace {

constexpr double kPanelS = 0.01;
constexpr double kMaxRateHz = 1e6;
constexpr double kEndSlackS = 1e-9;  // times are whole nanoseconds

struct Node {
  double at;  // on -1 to 1
  double weight;
};

// Abramowitz and Stegun, table 25.4, n = 5.
constexpr std::array<Node, 5> kGaussLegendre{{{-0.90617984593866399280, 0.23692688505618908751},
                                              {-0.53846931010568309104, 0.47862867049936646804},
                                              {0.0, 0.56888888888888888889},
                                              {0.53846931010568309104, 0.47862867049936646804},
                                              {0.90617984593866399280, 0.23692688505618908751}}};

// Start and length, not start and end: the difference of two late times has lost the digits that
// the length has.
void add_panel(const Trajectory& trajectory, double from_s, double length_s, ImuIncrement& sum) {
  const double half_s = 0.5 * length_s;
  for (const Node& node : kGaussLegendre) {
    const TruthPoint truth = truth_at(trajectory, from_s + half_s * (1.0 + node.at));
    sum.dtheta_b_rad += half_s * node.weight * truth.omega_ib_b_radps;
    sum.dv_b_mps += half_s * node.weight * truth.f_ib_b_mps2;
  }
}

void add_smooth(const Trajectory& trajectory, double from_s, double length_s, ImuIncrement& sum) {
  // The slack keeps an interval that is a panel long up to rounding in one panel.
  const int count = std::max(1, static_cast<int>(std::ceil(length_s / kPanelS - 1e-6)));
  const double panel_s = length_s / count;
  for (int i = 0; i < count; ++i) add_panel(trajectory, from_s + i * panel_s, panel_s, sum);
}

Eigen::Matrix3d normal_matrix3(Random& random) {
  Eigen::Matrix3d m;
  for (int column = 0; column < 3; ++column) m.col(column) = random.normal3();
  return m;
}

[[noreturn]] void refuse(const Trajectory& trajectory, const std::string& what) {
  std::ostringstream message;
  message << "IMU increments on '" << trajectory.name << "', " << trajectory.duration_s
          << " s long: " << what;
  throw Error(message.str());
}

}  // namespace

ImuIncrement true_increment(const Trajectory& trajectory, double from_s, double to_s) {
  const Time from = time_from_seconds(from_s);
  const Time to = time_from_seconds(to_s);
  if (from.time_since_epoch().count() < 0 || from >= to ||
      to_seconds(to) > trajectory.duration_s + kEndSlackS) {
    refuse(trajectory, "from " + std::to_string(from_s) + " to " + std::to_string(to_s) +
                           " s, must ascend within the trajectory");
  }
  ImuIncrement sum;
  sum.time = to;
  sum.dt_s = to_seconds(to - from);
  double start_s = to_seconds(from);
  double left_s = sum.dt_s;
  const auto& breaks_s = trajectory.breaks_s;
  auto next = std::upper_bound(breaks_s.begin(), breaks_s.end(), start_s);
  for (; next != breaks_s.end() && *next < start_s + left_s; ++next) {
    const double part_s = *next - start_s;
    add_smooth(trajectory, start_s, part_s, sum);
    start_s = *next;
    left_s -= part_s;
  }
  add_smooth(trajectory, start_s, left_s, sum);
  return sum;
}

std::size_t increment_count(const Trajectory& trajectory, double rate_hz, double duration_s) {
  if (!(rate_hz > 0.0 && rate_hz <= kMaxRateHz)) {
    refuse(trajectory, "rate of " + std::to_string(rate_hz) + " Hz, must be > 0 and <= 1e6");
  }
  if (!(duration_s >= 0.0 && duration_s <= trajectory.duration_s)) {
    refuse(trajectory, "duration of " + std::to_string(duration_s) +
                           " s, must be >= 0 and within the trajectory");
  }
  // Rounding must not lose the last increment of a whole number.
  return static_cast<std::size_t>(std::floor(duration_s * rate_hz + 1e-6));
}

std::vector<ImuIncrement> true_increments(const Trajectory& trajectory, double rate_hz,
                                          double duration_s) {
  const std::size_t count = increment_count(trajectory, rate_hz, duration_s);
  std::vector<ImuIncrement> increments;
  increments.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    increments.push_back(true_increment(trajectory, static_cast<double>(k) / rate_hz,
                                        static_cast<double>(k + 1) / rate_hz));
  }
  return increments;
}

TriadErrorSimulator::TriadErrorSimulator(const TriadErrorModel& model, Random& random)
    : model_(model),
      constant_bias_(model.bias + model.bias_sigma * random.normal3()),
      in_run_bias_(model.in_run.sigma * random.normal3()) {
  if (model.scale_sigma > 0.0) model_.M.diagonal() += model.scale_sigma * random.normal3();
  if (model.misalignment_sigma_rad > 0.0) {
    Eigen::Matrix3d spread = model.misalignment_sigma_rad * normal_matrix3(random);
    spread.diagonal().setZero();
    model_.M += spread;
  }
}

void TriadErrorSimulator::set_step(double dt_s) {
  step_dt_s_ = dt_s;
  noise_sigma_ = model_.noise_density * std::sqrt(dt_s);
  in_run_step_ = discretize(model_.in_run, dt_s);
}

Eigen::Vector3d TriadErrorSimulator::integrate_in_run_bias(Random& random) {
  if (model_.in_run.sigma == 0.0) return Eigen::Vector3d::Zero();
  Eigen::Vector3d integral = in_run_step_.integral_gain_s * in_run_bias_;
  if (in_run_step_.sigma_end == 0.0) return integral;  // a random constant
  const Eigen::Vector3d w1 = in_run_step_.sigma_end * random.normal3();
  integral += in_run_step_.integral_slope_s * w1 + in_run_step_.sigma_integral * random.normal3();
  in_run_bias_ = in_run_step_.phi * in_run_bias_ + w1;
  return integral;
}

Eigen::Vector3d TriadErrorSimulator::quantize(const Eigen::Vector3d& increment_b) {
  if (model_.quantum == 0.0) return increment_b;
  residue_ += increment_b;
  const Eigen::Vector3d reported =
      model_.quantum * (residue_ / model_.quantum).array().round().matrix();
  residue_ -= reported;
  return reported;
}

Eigen::Vector3d TriadErrorSimulator::measure(const Eigen::Vector3d& true_b,
                                             const Eigen::Vector3d& cross_b, double dt_s,
                                             Random& random) {
  if (dt_s != step_dt_s_) set_step(dt_s);
  Eigen::Vector3d sensed = model_.M * true_b + cross_b + constant_bias_ * dt_s;
  sensed += integrate_in_run_bias(random);
  if (noise_sigma_ > 0.0) sensed += noise_sigma_ * random.normal3();
  const double limit = model_.range * dt_s;
  return quantize(sensed.cwiseMax(-limit).cwiseMin(limit));
}

ImuErrorSimulator::ImuErrorSimulator(const ImuErrorModel& model, const Random& random)
    : random_(random),
      G_g_((validate(model), model.G_g_radps_per_mps2)),
      accelerometer_(model.accelerometer, random_),
      gyro_(model.gyro, random_) {
  if (model.G_g_sigma_radps_per_mps2 > 0.0) {
    G_g_ += model.G_g_sigma_radps_per_mps2 * normal_matrix3(random_);
  }
}

ImuIncrement ImuErrorSimulator::measure(const ImuIncrement& truth) {
  ImuIncrement reported = truth;
  reported.dv_b_mps =
      accelerometer_.measure(truth.dv_b_mps, Eigen::Vector3d::Zero(), truth.dt_s, random_);
  reported.dtheta_b_rad =
      gyro_.measure(truth.dtheta_b_rad, G_g_ * truth.dv_b_mps, truth.dt_s, random_);
  return reported;
}

}  // namespace leeway::sim
