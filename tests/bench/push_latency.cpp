// How long one push takes at worst: every push of a drive is timed, fixes arrive 500 ms late.
// usage: push_latency [STEPS]
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "leeway/filters/navigator.hpp"
#include "leeway/sim/imu_simulator.hpp"
#include "leeway/sim/trajectories.hpp"

namespace leeway {
namespace {

constexpr double kRateHz = 200.0;
constexpr int kLatencySteps = 100;  // 500 ms
constexpr int kLapSteps = 12'000;   // a minute, once around

struct Timings {
  std::vector<std::uint32_t> ns;

  void print(const char* what) {
    std::sort(ns.begin(), ns.end());
    const auto at = [this](double share) {
      return 1e-3 * ns[static_cast<std::size_t>(share * static_cast<double>(ns.size() - 1))];
    };
    std::printf("%-34s %10zu %9.2f %9.2f %9.2f\n", what, ns.size(), at(0.5), at(0.999), at(1.0));
  }
};

template <class F>
void timed(Timings& timings, F&& f) {
  const auto begin = std::chrono::steady_clock::now();
  f();
  const auto took = std::chrono::steady_clock::now() - begin;
  timings.ns.push_back(static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(took).count()));
}

/// A circle at 20 m/s, its first lap repeated.
void run(const char* what, std::int64_t steps, const VehicleConfig& vehicle, bool late) {
  constexpr double kLapS = kLapSteps / kRateHz;
  const sim::Trajectory circle = sim::circle({.radius_m = 20.0 * kLapS / (2.0 * std::numbers::pi),
                                              .speed_mps = 20.0,
                                              .duration_s = kLapS});
  const auto lap = sim::true_increments(circle, kRateHz, kLapS);
  NavigatorConfig config;
  config.vehicle = vehicle;
  Navigator navigator(config);
  Estimate start;
  start.nav = sim::truth_at(circle, 0.0).nav;
  navigator.start(start, initial_covariance(start, {0.01, 0.05, 0.1, 3.0}, config.filter.imu));

  Timings imu;
  Timings fixes;
  imu.ns.reserve(static_cast<std::size_t>(steps));
  fixes.ns.reserve(static_cast<std::size_t>(steps / 200 + 1));
  const Duration step = duration_from_seconds(1.0 / kRateHz);
  for (std::int64_t k = 1; k <= steps; ++k) {
    ImuIncrement inc = lap[static_cast<std::size_t>((k - 1) % kLapSteps)];
    inc.time = start.nav.time + k * step;
    timed(imu, [&] { navigator.push(inc); });
    const std::int64_t measured = late ? k - kLatencySteps : k;
    if (measured <= 0 || measured % 200 != 0) continue;
    const NavState truth =
        sim::truth_at(circle, static_cast<double>(measured % kLapSteps) / kRateHz).nav;
    GnssFix fix;
    fix.time = start.nav.time + measured * step;
    fix.position = GnssPosition{truth.r_e_m, Eigen::Matrix3d::Identity()};
    fix.velocity = GnssVelocity{truth.v_e_mps, 0.01 * Eigen::Matrix3d::Identity()};
    timed(fixes, [&] { navigator.push(fix); });
  }
  std::printf("%s: %llu fixes fused\n", what,
              static_cast<unsigned long long>(navigator.count(Verdict::kFused)));
  imu.print("  push(ImuIncrement)");
  fixes.print(late ? "  push(GnssFix), 500 ms late" : "  push(GnssFix), on time");
}

}  // namespace
}  // namespace leeway

int main(int argc, char** argv) {
  const std::int64_t steps = argc > 1 ? std::atoll(argv[1]) : 10'000'000;
  std::printf("%-34s %10s %9s %9s %9s\n", "us", "pushes", "median", "p99.9", "max");
  leeway::run("plain, on time", steps, {}, false);
  leeway::run("plain, late", steps, {}, true);
  leeway::run("car, late", steps, leeway::VehicleConfig::car(), true);
}
