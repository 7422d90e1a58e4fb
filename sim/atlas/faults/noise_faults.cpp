#include <cmath>

#include "sim/atlas/faults/fault.hpp"

namespace leeway::sim {
namespace {

Fault claim(std::string name, double duration_s, Damage damage) {
  return {.name = std::move(name), .group = FaultGroup::kReceiver, .duration_s = duration_s,
          .damage = std::move(damage)};
}

/// Claimed deviations times a factor.
Damage sigma_times(double factor) {
  return on_fixes([factor](GnssFix& fix, double) {
    fix.position->R_e_m2 *= factor * factor;
    fix.velocity->R_e_m2ps2 *= factor * factor;
  });
}

void claim_sigma(GnssFix& fix, double sigma) {
  fix.position->R_e_m2 = sigma * sigma * Eigen::Matrix3d::Identity();
  fix.velocity->R_e_m2ps2 = sigma * sigma * Eigen::Matrix3d::Identity();
}

/// Squares of the squares.
void claim_variances_as_sigmas(GnssFix& fix, double) {
  fix.position->R_e_m2 = fix.position->R_e_m2 * fix.position->R_e_m2;
  fix.velocity->R_e_m2ps2 = fix.velocity->R_e_m2ps2 * fix.velocity->R_e_m2ps2;
}

void claim_one_in_ten_perfect(GnssFix& fix, double since_s) {
  if (is_every(10, since_s)) claim_sigma(fix, 1e-11);
}

/// One fix in so many s, from the start on.
Fault a_fix_every(int interval_s) {
  Fault fault = claim("a fix every " + std::to_string(interval_s) + " s", 30.0,
                      [interval_s](FaultInputs& inputs, const FaultWindow& window) {
                        drop_in(inputs.fixes, window,
                                [=](double t_s) { return !is_every(interval_s, t_s); });
                      });
  fault.from_start = true;
  fault.lasts = true;
  return fault;
}

/// What arrives in the window once more, so many times, each later and stamped later.
Damage repeated(int times, double by_s) {
  return [=](FaultInputs& inputs, const FaultWindow& window) {
    const std::vector<Arrival<GnssFix>> before = inputs.fixes;
    for (const Arrival<GnssFix>& a : before) {
      if (!window.has(a.at_s)) continue;
      for (int k = 1; k <= times; ++k) {
        inputs.fixes.push_back({a.at_s + k * by_s, a.input});
        inputs.fixes.back().input.time += duration_from_seconds(k * by_s);
      }
    }
  };
}

Damage every_other() {
  return [](FaultInputs& inputs, const FaultWindow& window) {
    drop_in(inputs.fixes, window, [](double since_s) { return is_every(2, since_s); });
  };
}

Fault position_only() {
  Fault fault = claim("positions alone from then on", 30.0,
                      on_fixes([](GnssFix& fix, double) { fix.velocity.reset(); }));
  fault.lasts = true;
  return fault;
}

}  // namespace

std::vector<Fault> noise_faults() {
  return {
      position_only(),
      claim("velocities alone", 30.0,
            on_fixes([](GnssFix& fix, double) { fix.position.reset(); })),
      claim("sigmas 3 times too small", 60.0, sigma_times(1.0 / 3.0)),
      claim("sigmas 30 times too small", 60.0, sigma_times(1.0 / 30.0)),
      claim("sigmas 300 times too small", 60.0, sigma_times(1.0 / 300.0)),
      claim("sigmas 10 times too large", 60.0, sigma_times(10.0)),
      claim("sigma 1e-11 in every 10th fix", 60.0, on_fixes(claim_one_in_ten_perfect)),
      claim("variances for sigmas", 60.0, on_fixes(claim_variances_as_sigmas)),
      claim("covariance zero", 30.0, sigma_times(0.0)),
      claim("fixes twice", 30.0, repeated(1, 0.0)),
      claim("fixes filled forward to 5 Hz", 30.0, repeated(4, 0.2)),
      claim("every other fix lost", 60.0, every_other()),
      a_fix_every(3),
      a_fix_every(5),
      a_fix_every(10),
      a_fix_every(30),
  };
}

}  // namespace leeway::sim
