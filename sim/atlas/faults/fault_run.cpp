#include "sim/atlas/faults/fault_run.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/sim/scene/receiver.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/sim/tools/random.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim {
namespace {

constexpr std::uint64_t kSeed = 1;

template <class T>
void sort_by_arrival(std::vector<Arrival<T>>& arrivals) {
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const Arrival<T>& a, const Arrival<T>& b) { return a.at_s < b.at_s; });
}

bool is_finite(const Solution& s) {
  return s.nav.r_e_m.allFinite() && s.nav.v_e_mps.allFinite() && s.nav.q_eb.coeffs().allFinite() &&
         s.sigma_position_n_m.allFinite() && s.sigma_velocity_n_mps.allFinite() &&
         s.sigma_attitude_rad.allFinite();
}

/// Takes errors and sigmas against this truth.
void set_errors(FaultEpoch& epoch, const Solution& solution, const NavState& truth) {
  const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(truth.r_e_m)).transpose();
  const Eigen::Vector2d position_n_m = (C_ne * (solution.nav.r_e_m - truth.r_e_m)).head<2>();
  const Eigen::Vector3d velocity_n_mps = C_ne * (solution.nav.v_e_mps - truth.v_e_mps);
  const double heading_rad = heading_error_rad({.nav = truth}, {.nav = solution.nav});
  const auto ratio = [](const auto& error, const auto& sigma) {
    return error.cwiseAbs().cwiseQuotient(sigma).maxCoeff();
  };
  epoch.claims = {{{position_n_m.norm(), solution.sigma_position_n_m.head<2>().norm()},
                   {velocity_n_mps.norm(), solution.sigma_velocity_n_mps.norm()},
                   {heading_rad, solution.sigma_attitude_rad.z()}}};
  epoch.sigmas = {ratio(position_n_m, solution.sigma_position_n_m.head<2>()),
                  ratio(velocity_n_mps, solution.sigma_velocity_n_mps),
                  heading_rad / solution.sigma_attitude_rad.z()};
}

void compare(FaultEpoch& epoch, const Solution& solution, const TrueDrive& way, std::size_t k) {
  epoch.finite = is_finite(solution);
  if (!epoch.finite) return;
  set_errors(epoch, solution, way.truth[k]);
  const double own_s = to_seconds(solution.nav.time);
  const bool has_truth = own_s >= 0.0 && own_s <= way.trajectory.duration_s;
  if (epoch.stands_still || !has_truth || std::abs(own_s - epoch.t_s) < 1e-6) return;
  FaultEpoch own = epoch;
  set_errors(own, solution, truth_at(way.trajectory, own_s).nav);
  if (own.worst_sigmas() < epoch.worst_sigmas()) epoch = own;
}

/// Pushes what has arrived; a fix before an increment of the same time.
class Feed {
 public:
  explicit Feed(FaultInputs inputs) : inputs_(std::move(inputs)) {
    sort_by_arrival(inputs_.imu);
    sort_by_arrival(inputs_.fixes);
  }

  void push_until(double t_s, Navigator& navigator) {
    constexpr double kRounding = 1e-6;
    for (; next_ < inputs_.imu.size() && inputs_.imu[next_].at_s <= t_s + kRounding; ++next_) {
      push_fixes_until(inputs_.imu[next_].at_s, navigator);
      navigator.push(inputs_.imu[next_].input);
    }
    push_fixes_until(t_s, navigator);
  }

 private:
  void push_fixes_until(double t_s, Navigator& navigator) {
    while (next_fix_ < inputs_.fixes.size() && inputs_.fixes[next_fix_].at_s <= t_s) {
      navigator.push(inputs_.fixes[next_fix_++].input);
    }
  }

  FaultInputs inputs_;
  std::size_t next_{0};
  std::size_t next_fix_{0};
};

}  // namespace

TrueDrive true_drive(const Trajectory& trajectory, double imu_rate_hz, double duration_s) {
  TrueDrive way{.trajectory = trajectory,
                .increments = true_increments(trajectory, imu_rate_hz, duration_s)};
  for (int k = 0; k * kEpochS <= duration_s; ++k) {
    way.truth.push_back(truth_at(trajectory, k * kEpochS).nav);
  }
  return way;
}

FaultInputs inputs_of(const TrueDrive& way, const ImuErrorModel& imu, const GnssScenario& gnss,
                      double first_fix_s, std::uint64_t seed) {
  FaultInputs inputs;
  ImuErrorSimulator sensor(imu, Random(seed, 0, kImuStream));
  for (const ImuIncrement& inc : way.increments) {
    inputs.imu.push_back({to_seconds(inc.time), sensor.measure(inc)});
  }
  Receiver receiver(way.trajectory, gnss, seed);
  const double end_s = to_seconds(way.increments.back().time);
  for (double t_s = first_fix_s; t_s <= end_s; t_s += gnss.interval_s) {
    inputs.fixes.push_back({t_s + gnss.latency_s, receiver.fix_at(t_s)});
  }
  return inputs;
}

FaultDrive drive_of(const Regime& regime, const Trajectory& trajectory, double duration_s) {
  constexpr double kFirstFixS = 0.5;
  FaultDrive drive{.way = true_drive(trajectory, regime.imu_rate_hz, duration_s)};
  drive.inputs =
      inputs_of(drive.way, regime.imu, {.errors = regime.gnss, .interval_s = regime.fix_interval_s},
                kFirstFixS, kSeed);
  return drive;
}

void run_navigator(Navigator& navigator, FaultInputs inputs, const TrueDrive& way, double end_s,
                   const std::function<void(const FaultEpoch&)>& observe) {
  Feed feed(std::move(inputs));
  Time shown = Time::min();
  for (std::size_t k = 1; k < way.truth.size(); ++k) {
    FaultEpoch epoch{.t_s = static_cast<double>(k) * kEpochS};
    if (epoch.t_s > end_s) return;
    feed.push_until(epoch.t_s, navigator);
    epoch.state = navigator.health().state;
    epoch.has_solution = navigator.aligned();
    if (epoch.has_solution) {
      const Solution solution = navigator.solution();
      epoch.stands_still = solution.nav.time == shown;
      shown = solution.nav.time;
      compare(epoch, solution, way, k);
    }
    observe(epoch);
  }
}

void start_turned(Navigator& navigator, const Regime& regime, const NavState& truth,
                  double heading_error_rad) {
  Estimate start{.nav = truth};
  const Eigen::Vector3d down_e = down_e_at(truth.r_e_m);
  const ErrorMatrix P =
      initial_covariance(start, {0.01, 3.0 * kRadPerDeg, 0.1, 3.0}, regime.config.filter.imu);
  start.nav.q_eb = exp_quaternion(heading_error_rad * down_e) * start.nav.q_eb;
  navigator.start(start, P);
}

}  // namespace leeway::sim
