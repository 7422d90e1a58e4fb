#include "sim/inspect/findings.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "sim/inspect/known_factors.hpp"

namespace leeway::sim {
namespace {

constexpr double kGpsEpochUnixS = 315964800.0;
constexpr double kLeapS = 18.0;  ///< GPS time less UTC since 2017
constexpr double kWeekS = 604800.0;
constexpr double kHourS = 3600.0;

/// A finding is made of a figure that is so many of its sigmas away.
constexpr double kSigmas = 5.0;
constexpr double kExplainedShare = 0.3;
constexpr double kFactorTolerance = 0.15;
/// Change of acceleration of a vehicle in traffic: what the trapezoid of two velocities leaves.
constexpr double kJerkMps3 = 3.0;

double length_s(const TimeFigures& time) { return time.last_s - time.first_s; }

/// What is known to lie between two time lines so far apart; empty: nothing.
std::string known_difference(double ahead_s, double slack_s) {
  const auto is = [&](double known_s) { return std::abs(std::abs(ahead_s) - known_s) <= slack_s; };
  if (is(kGpsEpochUnixS) || is(kGpsEpochUnixS - kLeapS)) {
    return "; one counts from 1970 (Unix), the other from 1980 (GPS)";
  }
  const double weeks = std::round(std::abs(ahead_s) / kWeekS);
  if (weeks > 0.0 && is(weeks * kWeekS)) {
    return fmt::format("; {:.0f} weeks apart: seconds of week beside a full count", weeks);
  }
  const double hours = std::round(std::abs(ahead_s) / kHourS);
  if (hours > 0.0 && hours <= 14.0 && is(hours * kHourS)) {
    return fmt::format("; {:.0f} h apart: a time zone", hours);
  }
  return "";
}

Finding clock_finding(const SharedFigures& shared) {
  const double sigma_s = shared.clock_offset_sigma_s;
  const double size_s = std::abs(shared.clock_offset_s);
  const bool is_certain = size_s > 0.5 && size_s > 2.0 * kSigmas * sigma_s;
  const bool is_leap = std::abs(size_s - kLeapS) < kSigmas * sigma_s;
  const double offset_s =
      is_leap ? std::copysign(kLeapS, shared.clock_offset_s) : shared.clock_offset_s;
  return {is_certain ? Certainty::kCertain : Certainty::kLikely, "gnss", "clock-offset",
          fmt::format("the receiver's turns are those of the IMU {:+.2f} s later (sigma {:.2f} s): "
                      "the clocks differ{}",
                      shared.clock_offset_s, sigma_s,
                      is_leap ? ", by the leap seconds between GPS time and UTC" : ""),
          fmt::format("--gnss-time-offset-s {:.2f}", offset_s)};
}

Finding rate_finding(Certainty certainty, double factor, const std::string& meaning,
                     std::string remedy) {
  return {certainty, "imu", "gyro-unit",
          fmt::format("the gyros turn {:.3g} times as far as the course: {}", factor, meaning),
          std::move(remedy)};
}

Finding factor_finding(double factor, double imu_step_s) {
  const double size = std::abs(factor);
  const auto near = [size](double value) {
    return std::abs(size / value - 1.0) < kFactorTolerance;
  };
  if (factor < 0.0 && near(1.0)) {
    return rate_finding(Certainty::kCertain, factor,
                        "the gyros or the accelerometers have the opposite sign",
                        "--column gx=-<its name>, and gy, gz alike; or ax, ay, az where the "
                        "accelerometers tell gravity, not the force against it");
  }
  if (const auto unit = known_factor(kRateFactors, size, kFactorTolerance)) {
    return rate_finding(Certainty::kCertain, factor, fmt::format("they are in {}", unit->unit),
                        fmt::format("--gyro-unit {}", unit->unit));
  }
  if (near(1.0 / kDegPerRad)) {
    return rate_finding(Certainty::kCertain, factor, "they are in rad/s", "--gyro-unit rad/s");
  }
  if (near(imu_step_s)) {
    return rate_finding(Certainty::kCertain, factor, "increments stand under a heading of rates",
                        "name the columns dt_s, dtheta_x_rad .., dv_x_mps ..");
  }
  return rate_finding(Certainty::kLikely, factor, "a unit or an axis that is unknown",
                      "--gyro-unit, --axes");
}

}  // namespace

std::vector<Finding> time_line_findings(const TimeFigures& imu, const TimeFigures& gnss) {
  if (imu.records == 0 || gnss.records == 0) return {};
  const bool is_shared = gnss.first_s <= imu.last_s && imu.first_s <= gnss.last_s;
  if (is_shared) return {};
  const double ahead_s = gnss.first_s - imu.first_s;
  const double slack_s = std::max(length_s(imu), length_s(gnss)) + 60.0;
  return {
      {Certainty::kCertain, "gnss", "time-line",
       fmt::format("no fix falls into the time of the IMU data, {:.3f} to {:.3f} s: fixes are from "
                   "{:.3f} s on, and both logs must count from the same moment{}",
                   imu.first_s, imu.last_s, gnss.first_s, known_difference(ahead_s, slack_s)),
       fmt::format("--gnss-time-offset-s {:.3f} if both began together; then look again, for "
                   "what is left",
                   -ahead_s)}};
}

std::vector<Finding> turn_findings(const TurnMatch& turns, const SharedFigures& shared,
                                   double imu_step_s) {
  if (std::abs(turns.correlation) < kSameTurns) return {};
  std::vector<Finding> found;
  const double factor = 1.0 / turns.ratio;
  if (std::abs(factor - 1.0) > kFactorTolerance) {
    found.push_back(factor_finding(factor, imu_step_s));
  }
  const double size_s = std::abs(shared.clock_offset_s);
  if (size_s > 0.05 && size_s > kSigmas * shared.clock_offset_sigma_s) {
    found.push_back(clock_finding(shared));
  }
  return found;
}

std::vector<Finding> fix_findings(const FixFigures& gnss) {
  std::vector<Finding> found;
  const auto add = [&found](Certainty certainty, const char* about, std::string text,
                            std::string remedy) {
    found.push_back({certainty, "gnss", about, std::move(text), std::move(remedy)});
  };
  const std::int64_t records = gnss.time.records;
  if (gnss.repeated * 5 > records) {
    add(Certainty::kLikely, "repeated-fixes",
        fmt::format("{} of {} fixes repeat the one before to the last digit: they are not used",
                    gnss.repeated, records),
        "record each fix once");
  }
  if (gnss.zeros > 0) {
    add(Certainty::kLikely, "zero-fixes",
        fmt::format("{} of {} fixes are at 0 deg, 0 deg: they are not used", gnss.zeros, records),
        "leave out what the receiver says without a fix");
  }
  if (records > 0 && gnss.with_velocity == 0) {
    add(Certainty::kNote, "no-velocity",
        "the fixes have no velocity: the heading is found from positions alone, and later",
        "record the receiver's velocity");
  }
  const double lag_s = gnss.velocity_lag_s;
  const bool is_seen = std::abs(lag_s) > kSigmas * gnss.velocity_lag_sigma_s &&
                       gnss.velocity_lag_share > kExplainedShare;
  if (std::abs(lag_s) > 0.05 && is_seen) {
    add(Certainty::kLikely, "velocity-lag",
        fmt::format("velocities are {:.2f} s later than positions (sigma {:.2f} s)", lag_s,
                    gnss.velocity_lag_sigma_s),
        fmt::format("--velocity-lag-s {:.2f}", lag_s));
  }
  const double turn_m = kJerkMps3 * std::pow(gnss.time.step_s, 3) / 24.0;
  const double expected_m = std::hypot(gnss.claimed_h_m, turn_m);
  if (gnss.scatter_h_m > 3.0 * expected_m) {
    add(Certainty::kLikely, "claims",
        fmt::format("positions scatter by {:.3g} m from one fix to the next, and claim {:.3g} m",
                    gnss.scatter_h_m, gnss.claimed_h_m),
        fmt::format("--gnss-sigma-scale {:.2g},1", gnss.scatter_h_m / gnss.claimed_h_m));
  }
  if (gnss.scatter_h_m > 0.7 * gnss.claimed_h_m && gnss.wander_h_m < 1.3 * gnss.scatter_h_m) {
    add(Certainty::kNote, "white-errors",
        "errors from fix to fix are as large as they claim to be, and independent",
        "--gnss-correlation-s 0");
  }
  return found;
}

std::vector<Finding> odometer_findings(double ratio) {
  if (std::isnan(ratio) || std::abs(ratio - 1.0) < kFactorTolerance) return {};
  const auto unit = known_factor(kSpeedFactors, ratio, kFactorTolerance);
  return {{unit ? Certainty::kCertain : Certainty::kLikely, "odometer", "odometer-unit",
           fmt::format("speeds are {:.3g} times the receiver's{}", ratio,
                       unit ? fmt::format(": {}?", unit->unit) : std::string()),
           "name the column with its unit, as speed_kmh"}};
}

}  // namespace leeway::sim
