#include "sim/inspect/own_velocity.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "leeway/earth/units.hpp"
#include "sim/inspect/known_factors.hpp"

namespace leeway::sim {
namespace {

constexpr double kLongestStepS = 5.0;
constexpr double kWayS = 10.0;
constexpr std::int64_t kFewWindows = 5;
/// A finding is made where it explains away most of the squares, far beyond their scatter.
constexpr double kExplained = 0.75;
constexpr double kGain = 80.0;

/// An explanation of ways by positions: H times those by velocities.
struct Explanation {
  Eigen::MatrixXd H{};
  std::string text{};
  std::string remedy{};
};

/// Sum of squares that an explanation leaves, over the axes from `first`, as many as H has.
double left_m2(const WaySums& sums, Eigen::Index first, const Eigen::MatrixXd& H) {
  const Eigen::Index n = H.rows();
  const auto part = [&](const Eigen::Matrix3d& m) { return m.block(first, first, n, n).eval(); };
  return part(sums.by_positions_m2).trace() - 2.0 * (H.transpose() * part(sums.across_m2)).trace() +
         (H * part(sums.by_velocities_m2) * H.transpose()).trace();
}

std::vector<Explanation> horizontal_explanations(const Geodetic& place) {
  const auto matrix = [](double nn, double ne, double en, double ee) {
    Eigen::MatrixXd H(2, 2);
    H << nn, ne, en, ee;
    return H;
  };
  const double cos_lat = std::cos(place.lat_rad);
  const double cos_lon = std::max(std::cos(place.lon_rad), 0.01);
  return {
      {matrix(0, 1, 1, 0), "north and east of the velocity are exchanged",
       "--column vn=<its name of the east velocity> --column ve=<of the north velocity>"},
      {matrix(0, 1 / cos_lon, cos_lat, 0), "latitude and longitude are exchanged",
       "--column lat=<its name of the longitude> --column lon=<of the latitude>"},
      {matrix(-1, 0, 0, -1), "the velocity has the opposite sign, north and east",
       "--column vn=-<its name> --column ve=-<its name>"},
      {matrix(-1, 0, 0, 1), "the north velocity has the opposite sign", "--column vn=-<its name>"},
      {matrix(1, 0, 0, -1), "the east velocity has the opposite sign", "--column ve=-<its name>"},
      {matrix(1 / kDegPerRad, 0, 0, 1 / kDegPerRad), "latitude and longitude are in radians",
       "name the columns lat_rad and lon_rad"}};
}

std::vector<Explanation> vertical_explanations() {
  const auto scalar = [](double value) { return Eigen::MatrixXd::Constant(1, 1, value); };
  return {{scalar(-1.0), "the vertical velocity is positive upwards, and down is wanted",
           "--column vd=-<its name>"},
          {scalar(1.0 / 0.3048), "the height is in feet", "name the column height_ft"}};
}

/// The velocity in another unit, where one factor explains the ways.
std::optional<Explanation> scaled(const WaySums& sums, Eigen::Index first, Eigen::Index axes) {
  const double factor = sums.by_velocities_m2.block(first, first, axes, axes).trace() /
                        sums.across_m2.block(first, first, axes, axes).trace();
  const auto unit = known_factor(kSpeedFactors, factor, 0.1);
  if (!(factor > 0.0) || !unit) return std::nullopt;
  return Explanation{Eigen::MatrixXd::Identity(axes, axes) / factor,
                     fmt::format("the velocity is {:.3g} times too large: {}?", factor, unit->unit),
                     "name the column with its unit, as vn_kmh"};
}

std::optional<Finding> contradiction(const WaySums& sums, Eigen::Index first, Eigen::Index axes,
                                     std::vector<Explanation> explanations) {
  if (sums.windows < kFewWindows) return std::nullopt;
  if (auto unit = scaled(sums, first, axes)) explanations.push_back(*std::move(unit));
  const double unexplained_m2 = left_m2(sums, first, Eigen::MatrixXd::Identity(axes, axes));
  const auto left = [&](const Explanation& e) { return left_m2(sums, first, e.H); };
  const auto best = std::min_element(
      explanations.begin(), explanations.end(),
      [&](const Explanation& a, const Explanation& b) { return left(a) < left(b); });
  const double left_over_m2 = left(*best);
  const double each_m2 = left_over_m2 / static_cast<double>(axes * sums.windows);
  if (left_over_m2 > (1.0 - kExplained) * unexplained_m2) return std::nullopt;
  if (unexplained_m2 - left_over_m2 < kGain * each_m2) return std::nullopt;
  return Finding{
      Certainty::kCertain, "gnss", first == 0 ? "horizontal-velocity" : "vertical-velocity",
      fmt::format("over {} windows of 10 s the way by positions and the way by velocities differ "
                  "by {:.3g} m RMS, and by {:.2g} m if {}",
                  sums.windows, std::sqrt(unexplained_m2 / static_cast<double>(sums.windows)),
                  std::sqrt(std::max(left_over_m2, 0.0) / static_cast<double>(sums.windows)),
                  best->text),
      best->remedy};
}

Eigen::Vector3d ned_velocity(const GnssFix& fix, const Geodetic& place) {
  return ned_to_ecef(place).transpose() * fix.velocity->v_e_mps;
}

/// To the bit; NaN is not among them.
bool is_repetition(const GnssFix& a, const GnssFix& b) {
  if (!a.position || !b.position || a.velocity.has_value() != b.velocity.has_value()) return false;
  return a.position->r_e_m == b.position->r_e_m &&
         (!a.velocity || a.velocity->v_e_mps == b.velocity->v_e_mps);
}

/// By the way from the fix before.
double speed_between(const std::optional<GnssFix>& before, const GnssFix& fix) {
  if (!before || fix.time <= before->time) return 0.0;
  return (fix.position->r_e_m - before->position->r_e_m).norm() /
         to_seconds(fix.time - before->time);
}

}  // namespace

void OwnVelocity::add(const GnssFix& fix) {
  times_.add(fix.time);
  if (fix.velocity) ++counts_.with_velocity;
  if (last_ && is_repetition(*last_, fix)) {
    ++counts_.repeated;
    return;
  }
  if (!fix.position) return;
  const Geodetic place = geodetic_from_ecef(fix.position->r_e_m);
  if (std::abs(place.lat_rad) < 1e-9 && std::abs(place.lon_rad) < 1e-9) {
    ++counts_.zeros;
    return;
  }
  const std::optional<GnssFix> before = std::exchange(last_, fix);
  const Eigen::Vector3d v_before_mps = v_n_mps_;
  place_ = place;
  if (fix.velocity) v_n_mps_ = ned_velocity(fix, place);
  const double speed_mps = fix.velocity ? v_n_mps_.head<2>().norm() : speed_between(before, fix);
  counts_.fastest_mps = std::max(counts_.fastest_mps, speed_mps);
  const bool is_step = before && before->velocity && fix.velocity &&
                       to_seconds(fix.time - before->time) <= kLongestStepS;
  if (!is_step) {
    way_ = {};
    return;
  }
  if (way_.duration_s == 0.0) way_.first_v_n_mps = v_before_mps;
  add_step(*before, fix);
  if (way_.duration_s >= kWayS) end_window(v_n_mps_);
}

void OwnVelocity::add_step(const GnssFix& before, const GnssFix& fix) {
  const double step_s = to_seconds(fix.time - before.time);
  const Eigen::Matrix3d C_ne = ned_to_ecef(place_).transpose();
  const Eigen::Vector3d by_positions_m = C_ne * (fix.position->r_e_m - before.position->r_e_m);
  const Eigen::Vector3d by_velocities_m =
      0.5 * step_s * (C_ne * (before.velocity->v_e_mps + fix.velocity->v_e_mps));
  way_.by_positions_m += by_positions_m;
  way_.by_velocities_m += by_velocities_m;
  way_.duration_s += step_s;
  ++steps_;
  step_misses_m2_ += (by_positions_m - by_velocities_m).head<2>().squaredNorm();
  claimed_m2_ +=
      0.5 * (C_ne * fix.position->R_e_m2 * C_ne.transpose()).topLeftCorner<2, 2>().trace();
}

void OwnVelocity::end_window(const Eigen::Vector3d& last_v_n_mps) {
  const Eigen::Vector3d& p = way_.by_positions_m;
  const Eigen::Vector3d& v = way_.by_velocities_m;
  ++sums_.windows;
  sums_.by_positions_m2 += p * p.transpose();
  sums_.across_m2 += p * v.transpose();
  sums_.by_velocities_m2 += v * v.transpose();
  const Eigen::Vector2d miss_m = (p - v).head<2>();
  const Eigen::Vector2d change_mps = (last_v_n_mps - way_.first_v_n_mps).head<2>();
  window_misses_m2_ += miss_m.squaredNorm();
  lag_changes_m_mps_ += miss_m.dot(change_mps);
  lag_changes_m2ps2_ += change_mps.squaredNorm();
  way_ = {};
}

double OwnVelocity::lag_sigma_s() const {
  const double explained_m2 = lag_changes_m_mps_ * lag_changes_m_mps_ / lag_changes_m2ps2_;
  const double each_m2 =
      (window_misses_m2_ - explained_m2) / static_cast<double>(2 * sums_.windows);
  return std::sqrt(each_m2 / lag_changes_m2ps2_);
}

FixFigures OwnVelocity::figures() const {
  FixFigures f = counts_;
  f.time = times_.figures();
  if (steps_ == 0) return f;
  // Two axes, and two ends of a step, share each square.
  const auto scatter_m = [](double misses_m2, std::int64_t count) {
    return std::sqrt(misses_m2 / static_cast<double>(4 * count));
  };
  f.claimed_h_m = std::sqrt(claimed_m2_ / static_cast<double>(steps_));
  f.scatter_h_m = scatter_m(step_misses_m2_, steps_);
  if (sums_.windows < kFewWindows) return f;
  f.wander_h_m = scatter_m(window_misses_m2_, sums_.windows);
  if (lag_changes_m2ps2_ > 0.0) {
    f.velocity_lag_s = lag_changes_m_mps_ / lag_changes_m2ps2_;
    f.velocity_lag_sigma_s = lag_sigma_s();
    f.velocity_lag_share = f.velocity_lag_s * lag_changes_m_mps_ / window_misses_m2_;
  }
  return f;
}

std::vector<Finding> OwnVelocity::findings() const {
  std::vector<Finding> found;
  if (auto f = contradiction(sums_, 0, 2, horizontal_explanations(place_))) {
    found.push_back(*std::move(f));
  }
  if (auto f = contradiction(sums_, 2, 1, vertical_explanations())) found.push_back(*std::move(f));
  return found;
}

}  // namespace leeway::sim
