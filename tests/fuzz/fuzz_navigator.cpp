#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "leeway/model/initial_covariance.hpp"
#include "leeway/navigator/navigator.hpp"

namespace {

using namespace leeway;

/// Takes the fuzzer's bytes for choices. When they are used up, everything is zero.
class Choices {
 public:
  explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool empty() const { return bytes_.empty(); }

  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t first = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return first;
  }

  /// -1 to 1.
  double unit() { return (byte() - 127.5) / 127.5; }

  /// Mostly within the scale of what is plausible; one byte in 16 chooses a wild number.
  double number(double middle, double scale) {
    constexpr double kInf = std::numeric_limits<double>::infinity();
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kWild[] = {kNan, kInf, -kInf, 0.0,   -0.0,   1e308, -1e308, 1e-308,
                                1e30, 1e15, -1e15, 1e100, -1e100, 1e-30, 1e5,    -1.0};
    const std::uint8_t kind = byte();
    if (kind >= 240) return kWild[kind - 240];
    const double reach = kind >= 200 ? 1e3 * scale : kind >= 128 ? scale : 1e-2 * scale;
    return middle + reach * unit();
  }

  Eigen::Vector3d vector(const Eigen::Vector3d& middle, double scale) {
    return {number(middle.x(), scale), number(middle.y(), scale), number(middle.z(), scale)};
  }

  /// Mostly diagonal and positive.
  Eigen::Matrix3d covariance(double variance) {
    const std::uint8_t kind = byte();
    Eigen::Matrix3d R = variance * Eigen::Matrix3d::Identity();
    if (kind < 128) return R;
    for (int i = 0; i < 3; ++i) R(i, i) = number(variance, variance);
    if (kind >= 192) R(0, 1) = R(1, 0) = number(0.0, variance);
    if (kind >= 248) R(1, 2) = number(0.0, variance);
    return R;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

void require(bool holds) {
  if (!holds) std::abort();
}

/// A car near 45 deg north, pushed about.
class Drive {
 public:
  explicit Drive(Choices choices) : choices_(choices), config_(config()), navigator_(config_) {
    truth_.position = {45.0 * kRadPerDeg, 37.6 * kRadPerDeg, 100.0};
    truth_.v_n_mps = {10.0, 0.0, 0.0};
  }

  void run() {
    while (!choices_.empty()) {
      operate();
      check();
    }
  }

 private:
  NavigatorConfig config() {
    NavigatorConfig result;
    const std::uint8_t parts = choices_.byte();
    if ((parts & 1) != 0) result.vehicle = VehicleConfig::car();
    if ((parts & 2) != 0) result.C_bs.reset();
    if ((parts & 4) != 0) result.timing.velocity_lag_s = 0.25;
    if ((parts & 8) != 0) result.timing.max_imu_rate_hz = 10.0;
    if ((parts & 16) != 0) result.alignment.heading_from_course = false;
    if ((parts & 32) != 0) result.filter.gate_probability = 0.0;
    if ((parts & 64) != 0) result.filter.lever_arm_b_m = {1.0, 0.5, -1.0};
    return result;
  }

  void operate() {
    const std::uint8_t operation = choices_.byte();
    if (operation < 120) return push_increments(1 + operation % 64);
    if (operation < 140) return push_sample();
    if (operation < 200) return push_fix();
    if (operation < 215) return count(navigator_.push(reading<OdometerSpeed>(10.0, 1.0, 0.2, 0.1)));
    if (operation < 223) {
      return count(navigator_.push(reading<BarometricHeight>(100.0, 5.0, 1.0, 0.5)));
    }
    if (operation < 230) {
      return count(navigator_.push(reading<MeasuredHeading>(0.0, 3.0, 0.05, 0.05)));
    }
    if (operation < 238) return start();
    if (operation < 246) return restore();
    navigator_ = Navigator(navigator_);
  }

  /// Near the newest IMU time, mostly.
  Time some_time() {
    const std::uint8_t kind = choices_.byte();
    if (kind >= 250) {
      constexpr std::int64_t kWild[] = {0,
                                        std::numeric_limits<std::int64_t>::max(),
                                        std::numeric_limits<std::int64_t>::min(),
                                        604'800'000'000'000,
                                        -3'600'000'000'000,
                                        3'600'000'000'000};
      return Time{Duration{kWild[kind - 250]}};
    }
    const double reach_s = kind >= 230 ? 100.0 : kind >= 128 ? 3.0 : 0.02;
    return now_ + duration_from_seconds(reach_s * choices_.unit());
  }

  ImuIncrement straight_ahead() {
    ImuIncrement inc;
    inc.time = now_;
    inc.dt_s = 0.01;
    inc.dv_b_mps.z() = -9.81 * inc.dt_s;
    return inc;
  }

  /// A run of good increments, or a single odd one.
  void push_increments(int n) {
    if (choices_.byte() < 200) {
      for (int k = 0; k < n; ++k) {
        now_ += std::chrono::milliseconds{10};
        count(navigator_.push(straight_ahead()));
      }
      return;
    }
    ImuIncrement inc = straight_ahead();
    inc.time = some_time();
    inc.dt_s = choices_.number(0.01, 0.01);
    inc.dtheta_b_rad = choices_.vector(Eigen::Vector3d::Zero(), 0.01);
    inc.dv_b_mps = choices_.vector({0.0, 0.0, -0.1}, 0.1);
    const Verdict verdict = navigator_.push(inc);
    if (verdict == Verdict::kAccepted || verdict == Verdict::kClockJump) now_ = inc.time;
    count(verdict);
  }

  void push_sample() {
    ImuSample sample;
    now_ += std::chrono::milliseconds{10};
    sample.time = choices_.byte() < 200 ? now_ : some_time();
    sample.omega_ib_b_radps = choices_.vector(Eigen::Vector3d::Zero(), 1.0);
    sample.f_ib_b_mps2 = choices_.vector({0.0, 0.0, -9.81}, 10.0);
    count(navigator_.push(sample));
  }

  void push_fix() {
    GnssFix fix;
    fix.time = some_time();
    const std::uint8_t parts = choices_.byte();
    const NavState state = nav_state_from_ned(truth_);
    const Eigen::Vector3d way_m = to_seconds(fix.time) * state.v_e_mps;
    const Eigen::Vector3d r_e_m =
        way_m.norm() < 1e5 ? Eigen::Vector3d(state.r_e_m + way_m) : state.r_e_m;
    if (parts % 8 != 1) fix.position = {choices_.vector(r_e_m, 10.0), choices_.covariance(6.0)};
    if (parts % 8 != 2) {
      fix.velocity = {choices_.vector(state.v_e_mps, 1.0), choices_.covariance(0.01)};
    }
    count(navigator_.push(fix));
  }

  /// What an aiding sensor reads.
  template <class R>
  R reading(double value, double value_spread, double sigma, double sigma_spread) {
    return R{some_time(), choices_.number(value, value_spread),
             choices_.number(sigma, sigma_spread)};
  }

  void start() {
    Estimate estimate;
    truth_.time = now_;
    estimate.nav = nav_state_from_ned(truth_);
    const double heading_rad = choices_.byte() / 64.0;
    navigator_.start(
        estimate, initial_covariance(estimate, {0.01, heading_rad, 0.1, 3.0}, config_.filter.imu));
  }

  void restore() {
    std::vector<std::byte> bytes(navigator_.snapshot_size());
    navigator_.snapshot(bytes);
    if (choices_.byte() >= 200) {
      const std::size_t place = choices_.byte() * std::size_t{256} + choices_.byte();
      bytes[place % bytes.size()] ^= std::byte{1};
      require(Navigator(config_).restore(bytes) != Restore::kRestored);
      return;
    }
    Navigator other(config_);
    require(other.restore(bytes) == Restore::kRestored);
    navigator_ = other;
  }

  void count(Verdict verdict) {
    require(static_cast<std::size_t>(verdict) < kVerdicts);
    ++pushed_;
  }

  /// A measurement that waits has no verdict yet, and one cut in two counts once: never more
  /// verdicts than inputs.
  void check() const {
    std::uint64_t verdicts = 0;
    for (std::size_t k = 0; k < kVerdicts; ++k)
      verdicts += navigator_.count(static_cast<Verdict>(k));
    require(verdicts <= pushed_);
    const Health health = navigator_.health();
    require(std::isfinite(health.coasting_s) && std::isfinite(health.gating_s));
    if (!navigator_.aligned()) return;
    const Solution s = navigator_.solution();
    require(s.nav.q_eb.coeffs().allFinite() && s.nav.v_e_mps.allFinite() &&
            s.nav.r_e_m.allFinite() && s.b_a_mps2.allFinite() && s.b_g_radps.allFinite() &&
            s.sigma_position_n_m.allFinite() && s.sigma_velocity_n_mps.allFinite() &&
            s.sigma_attitude_rad.allFinite());
  }

  Choices choices_;
  NavigatorConfig config_;
  Navigator navigator_;
  NavStateNed truth_{};
  Time now_{};
  std::uint64_t pushed_{0};
};

}  // namespace

/// Whatever is pushed in whatever order: no crash, nothing that is not finite, no more verdicts
/// than inputs. Bytes are operations, so that a mutation is another sequence of pushes.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Drive(Choices({data, size})).run();
  return 0;
}
