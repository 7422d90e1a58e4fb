/// A long drive with everything that goes wrong on one: late, doubled and overtaken fixes,
/// outliers, holes in the IMU data, IMU records twice and out of order, restarts. Prints a row for
/// each hour. Exits with 1, and says why, when the navigator is not finite, not consistent, its
/// covariance not positive definite, or its memory grows.
///
/// usage: leeway_soak [HOURS [SEED]]
#include <unistd.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/navigator/navigator.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/sim/tools/random.hpp"

namespace leeway::sim {
namespace {

constexpr int kRateHz = 200;
constexpr Duration kStep = std::chrono::nanoseconds{1'000'000'000 / kRateHz};
constexpr int kLapS = 240;
constexpr double kFixPhaseS = 0.5037;  // fixes lie between IMU samples
constexpr double kPositionSigmaM = 2.5;
constexpr double kVelocitySigmaMps = 0.05;
constexpr double kSettlingS = 60.0;  // after the start and after a hole
constexpr double kLargestGrowthMB = 1.0;

constexpr double kDuplicates = 0.02;            // of fixes
constexpr double kOutliers = 0.01;              // of fixes
constexpr double kImuDuplicates = 1e-3;         // of records
constexpr double kImuOutOfOrder = 1e-3;         // of records
constexpr double kHoleEveryS = 600.0;           // on average
constexpr double kRestartEveryS = 20.0 * 60.0;  // on average

struct Failure {
  std::string reason;
};

/// The truth at whole seconds of a lap, or between them.
std::array<NavState, kLapS> lap_truth(const Trajectory& trajectory, double phase_s) {
  std::array<NavState, kLapS> truth;
  for (int k = 0; k < kLapS; ++k) {
    truth[static_cast<std::size_t>(k)] = truth_at(trajectory, k + phase_s).nav;
  }
  return truth;
}

/// What the filter's model describes to the letter: no bias but the one that wanders.
ImuErrorModel sensor_model() {
  ImuErrorModel model = automotive_mems_model();
  model.accelerometer.bias_sigma = 0.0;
  model.gyro.bias_sigma = 0.0;
  return model;
}

NavigatorConfig navigator_config() {
  NavigatorConfig config;
  config.filter.imu = sensor_model();
  config.filter.gnss_correlation_s = 0.0;  // the fixes' errors are white
  return config;
}

/// A fix on its way from the receiver.
struct InTransit {
  std::int64_t arrival_step{};
  GnssFix fix{};
};

/// Mean of chi-square variables over their degrees of freedom.
struct Consistency {
  double nis_sum{0.0};
  double dof_sum{0.0};
  double mean() const { return nis_sum / dof_sum; }
  double sigma() const { return std::sqrt(2.0 / dof_sum); }
};

struct Hour {
  Consistency nis{};
  double error_square_m2{0.0};    // horizontal
  double normalized_square{0.0};  // of north and east, by their sigmas
  int seconds{0};
  int holes{0};
  int outliers{0};
};

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  long pages = 0;
  statm >> pages >> pages;
  return static_cast<double>(pages * sysconf(_SC_PAGESIZE)) / 1048576.0;
}

class Soak {
 public:
  Soak(double hours, std::uint64_t seed)
      : steps_(static_cast<std::int64_t>(std::llround(hours * 3600.0)) * kRateHz),
        trajectory_(square_loop()),
        increments_(true_increments(trajectory_, kRateHz, kLapS)),
        at_seconds_(lap_truth(trajectory_, 0.0)),
        at_fixes_(lap_truth(trajectory_, kFixPhaseS)),
        sensor_(sensor_model(), Random(seed, 0, kImuStream)),
        receiver_(seed, 0, kGnssStream),
        faults_(seed, 0, kFirstFreeStream),
        navigator_(navigator_config()),
        snapshot_(navigator_.snapshot_size()) {
    in_transit_.reserve(64);
    Random initial(seed, 0, kInitialStateStream);
    Estimate start;
    start.nav = at_seconds_[0];
    const ErrorMatrix P =
        initial_covariance(start, {0.01, 0.05, 0.1, 3.0}, navigator_config().filter.imu);
    ErrorVector unit;
    for (double& u : unit) u = initial.normal();
    ErrorVector x = Eigen::LLT<ErrorMatrix>(P).matrixL() * unit;
    x.tail<6>().setZero();  // the sensor draws its own biases
    inject(start, -x);
    navigator_.start(start, P);
  }

  void run() {
    print_header();
    for (std::int64_t step = 1; step <= steps_; ++step) {
      advance(step);
      if (step % kRateHz == 0) every_second(step / kRateHz);
    }
    if (hour_.seconds > 0) end_hour(static_cast<double>(steps_) / kRateHz / 3600.0);
  }

 private:
  void advance(std::int64_t step) {
    const auto k = static_cast<std::size_t>((step - 1) % (kLapS * kRateHz));
    ImuIncrement inc = sensor_.measure(increments_[k]);
    inc.time = Time{step * kStep};
    deliver_fixes(step);
    if (step <= hole_end_step_) return;
    navigator_.push(inc);
    if (faults_.uniform() < kImuDuplicates) navigator_.push(inc);
    if (faults_.uniform() < kImuOutOfOrder) navigator_.push(before_);
    before_ = inc;
  }

  void deliver_fixes(std::int64_t step) {
    for (std::size_t k = 0; k < in_transit_.size();) {
      if (in_transit_[k].arrival_step > step) {
        ++k;
        continue;
      }
      navigator_.push(in_transit_[k].fix);
      in_transit_.erase(in_transit_.begin() + static_cast<std::ptrdiff_t>(k));
      note_update();
    }
  }

  /// The newest fix that reached the filter is judged again when an older one comes in: the last
  /// judgement counts. One that is overtaken by a younger one is not seen at all, whatever it was.
  void note_update() {
    const UpdateOutcome& outcome = navigator_.last_update();
    if (newest_judged_ && newest_judged_->time != outcome.time) book(*newest_judged_);
    newest_judged_ = outcome;
  }

  void book(const UpdateOutcome& outcome) {
    const double t_s = to_seconds(outcome.time);
    if (outcome.outcome != UpdateOutcome::Outcome::kFused || t_s < settled_from_s_) return;
    hour_.nis.nis_sum += outcome.nis;
    hour_.nis.dof_sum += outcome.dof;
  }

  void every_second(std::int64_t second) {
    send_fix(second);
    check(second);
    const std::int64_t step = second * kRateHz;
    if (faults_.uniform() < 1.0 / kHoleEveryS && step > hole_end_step_) {
      const double hole_s = 0.1 + 2.9 * faults_.uniform();
      hole_end_step_ = step + std::llround(hole_s * kRateHz);
      settled_from_s_ = static_cast<double>(second) + hole_s + kSettlingS;
      ++hour_.holes;
    }
    if (faults_.uniform() < 1.0 / kRestartEveryS) restart();
    if (second % 3600 == 0) end_hour(static_cast<double>(second) / 3600.0);
    if (second % 600 == 0) std::fprintf(stderr, "\r%.1f h", static_cast<double>(second) / 3600.0);
  }

  /// The fix of the second that has begun leaves the receiver.
  void send_fix(std::int64_t second) {
    const NavState& truth = at_fixes_[static_cast<std::size_t>(second % kLapS)];
    GnssFix fix;
    fix.time = Time{std::chrono::seconds{second}} + duration_from_seconds(kFixPhaseS);
    fix.position = {truth.r_e_m + kPositionSigmaM * receiver_.normal3(),
                    kPositionSigmaM * kPositionSigmaM * Eigen::Matrix3d::Identity()};
    fix.velocity = {truth.v_e_mps + kVelocitySigmaMps * receiver_.normal3(),
                    kVelocitySigmaMps * kVelocitySigmaMps * Eigen::Matrix3d::Identity()};
    if (faults_.uniform() < kOutliers) {
      const Eigen::Vector3d direction = receiver_.normal3().normalized();
      fix.position->r_e_m += (100.0 + 200.0 * faults_.uniform()) * direction;
      ++hour_.outliers;
    }
    const auto arrival_step = [&] {
      const double latency_s = 0.02 + 1.48 * faults_.uniform();
      return second * kRateHz + std::llround((kFixPhaseS + latency_s) * kRateHz);
    };
    in_transit_.push_back({arrival_step(), fix});
    if (faults_.uniform() < kDuplicates) in_transit_.push_back({arrival_step(), fix});
  }

  void check(std::int64_t second) {
    if (!navigator_.aligned()) throw Failure{"alignment was lost"};
    const Solution s = navigator_.solution();
    const ErrorMatrix P = navigator_.filter().covariance();
    const bool finite = s.nav.q_eb.coeffs().allFinite() && s.nav.v_e_mps.allFinite() &&
                        s.nav.r_e_m.allFinite() && s.b_a_mps2.allFinite() &&
                        s.b_g_radps.allFinite() && P.allFinite();
    if (!finite) throw Failure{"not finite at " + std::to_string(second) + " s"};
    if (Eigen::LLT<ErrorMatrix>(P).info() != Eigen::Success) {
      throw Failure{"covariance not positive definite at " + std::to_string(second) + " s"};
    }
    ++hour_.seconds;
    if (static_cast<double>(second) < settled_from_s_) return;
    const NavState& truth = at_seconds_[static_cast<std::size_t>(second % kLapS)];
    const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(truth.r_e_m)).transpose();
    const Eigen::Vector2d error_m = (C_ne * (s.nav.r_e_m - truth.r_e_m)).head<2>();
    hour_.error_square_m2 += error_m.squaredNorm();
    hour_.normalized_square +=
        0.5 * error_m.cwiseQuotient(s.sigma_position_n_m.head<2>()).squaredNorm();
    ++settled_seconds_;
  }

  void restart() {
    navigator_.snapshot(snapshot_);
    Navigator fresh(navigator_config());
    if (fresh.restore(snapshot_) != Restore::kRestored) throw Failure{"a snapshot was refused"};
    navigator_ = fresh;
    ++restarts_;
  }

  static void print_header() {
    std::printf(
        "NIS: mean over the degrees of freedom, with the band that holds 95 %% of the hours; fixes "
        "within %.0f s of the start\nor of a hole's end are not in it, nor in the errors "
        "(horizontal RMS; RMS over sigma of north and east).\n\n"
        "  hour   fused  gated outliers  late  dupl. holes restarts    NIS   95 %% band     RMS m "
        "RMS/sigma repairs resets  RSS MB\n",
        kSettlingS);
  }

  std::uint64_t since_hour_before(Verdict verdict) {
    std::uint64_t& before = counts_[static_cast<std::size_t>(verdict)];
    const std::uint64_t now = navigator_.count(verdict);
    const std::uint64_t result = now - before;
    before = now;
    return result;
  }

  void end_hour(double hour) {
    const Health health = navigator_.health();
    const double rss_mb = resident_mb();
    const double n = std::max(1, settled_seconds_);
    const double band = 1.96 * hour_.nis.sigma();
    const auto fused = since_hour_before(Verdict::kFused);
    const auto gated = since_hour_before(Verdict::kGated);
    const auto late = since_hour_before(Verdict::kLate);
    const auto duplicate = since_hour_before(Verdict::kDuplicate);
    std::printf(
        "\r%6.2f %7lu %6lu %8d %5lu %6lu %5d %8d  %.4f %.3f-%.3f %9.2f %9.3f %7u %6u %7.2f\n", hour,
        fused, gated, hour_.outliers, late, duplicate, hour_.holes, restarts_, hour_.nis.mean(),
        1.0 - band, 1.0 + band, std::sqrt(hour_.error_square_m2 / n),
        std::sqrt(hour_.normalized_square / n), health.repairs, health.resets, rss_mb);
    std::fflush(stdout);
    if (!(std::abs(hour_.nis.mean() - 1.0) <= 3.2905 * hour_.nis.sigma())) {
      failures_.push_back("hour " + std::to_string(hour) + ": NIS outside its 99.9 % band");
    }
    if (!first_hour_mb_) first_hour_mb_ = rss_mb;
    if (rss_mb > *first_hour_mb_ + kLargestGrowthMB) throw Failure{"memory has grown"};
    hour_ = Hour{};
    settled_seconds_ = 0;
    restarts_ = 0;
  }

 public:
  const std::vector<std::string>& failures() const { return failures_; }

 private:
  std::int64_t steps_;
  Trajectory trajectory_;
  std::vector<ImuIncrement> increments_;
  std::array<NavState, kLapS> at_seconds_;
  std::array<NavState, kLapS> at_fixes_;
  ImuErrorSimulator sensor_;
  Random receiver_;
  Random faults_;
  Navigator navigator_;
  std::vector<std::byte> snapshot_;
  std::vector<InTransit> in_transit_{};
  ImuIncrement before_{};
  std::int64_t hole_end_step_{0};
  double settled_from_s_{kSettlingS};
  int settled_seconds_{0};
  int restarts_{0};
  std::optional<UpdateOutcome> newest_judged_{};
  Hour hour_{};
  std::array<std::uint64_t, kVerdicts> counts_{};
  std::optional<double> first_hour_mb_{};
  std::vector<std::string> failures_{};
};

}  // namespace
}  // namespace leeway::sim

int main(int argc, char** argv) {
  const double hours = argc > 1 ? std::strtod(argv[1], nullptr) : 24.0;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  if (!(hours > 0.0 && hours <= 1e4)) {
    std::fprintf(stderr, "usage: leeway_soak [HOURS [SEED]]\n");
    return 1;
  }
  try {
    leeway::sim::Soak soak(hours, seed);
    soak.run();
    for (const std::string& reason : soak.failures()) {
      std::fprintf(stderr, "\nsoak: %s\n", reason.c_str());
    }
    return soak.failures().empty() ? 0 : 1;
  } catch (const leeway::sim::Failure& failure) {
    std::fprintf(stderr, "\nsoak: %s\n", failure.reason.c_str());
  } catch (const leeway::Error& error) {
    std::fprintf(stderr, "\nsoak: %s\n", error.what());
  }
  return 1;
}
