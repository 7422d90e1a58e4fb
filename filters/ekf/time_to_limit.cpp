#include "leeway/ekf/time_to_limit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "filters/ekf/error_growth.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {
namespace {

constexpr double kSchulerPeriodS = 5064.0;
constexpr double kLongestFirstStepS = 16.0;   // 1/300 of a Schuler period
constexpr double kLargestFirstTurnRad = 0.1;  // of the axes l within the first step

/// What a horizontal error is held against.
struct HorizontalLimit {
  double limit_m{0.0};
  double log_tail{0.0};  // of the probability allowed beyond it; unused by the other metrics
  HorizontalMetric metric{HorizontalMetric::kR95};

  /// Positive beyond the limit; smooth, the logarithm of a variance ratio. NaN if P or the limit
  /// is.
  double excess(const Eigen::Matrix2d& P_ne_m2) const {
    if (metric == HorizontalMetric::kR95) {
      return std::log(log_tail / std::log(probability_beyond(P_ne_m2, limit_m)));
    }
    return 2.0 * std::log(horizontal_error_m(metric, P_ne_m2) / limit_m);
  }

  /// The sign of excess, for less work where bounds on the probability settle it: the error along
  /// the major axis alone, and a circle with that axis all round. Not a number is beyond.
  bool exceeded(const Eigen::Matrix2d& P_ne_m2) const {
    if (metric == HorizontalMetric::kR95) {
      const double spread = std::hypot(0.5 * (P_ne_m2(0, 0) - P_ne_m2(1, 1)), P_ne_m2(0, 1));
      const double u = 0.5 * limit_m * limit_m / (0.5 * P_ne_m2.trace() + spread);
      if (-u <= log_tail) return false;
      if (std::log(std::erfc(std::sqrt(u))) > log_tail) return true;
    }
    return !(excess(P_ne_m2) <= 0.0);
  }
};

/// The errors of a filter, ahead in time.
class Outlook {
 public:
  Outlook(const Ekf& filter, const HorizontalLimit& limit)
      : limit_(limit),
        motion_(steady_motion(filter)),
        C_e_ne_(ned_to_ecef(geodetic_from_ecef(filter.estimate().nav.r_e_m)).leftCols<2>()),
        P_(filter.covariance()) {}

  TimeToLimit search();

 private:
  static constexpr int kLevels = 5;  // the shortest step is at most 1/16 of the one that passed

  Coasting& level(int k) { return levels_[static_cast<std::size_t>(k % kLevels)]; }
  double turn_period_s() const { return 2.0 * std::numbers::pi / std::abs(motion_.turn_radps); }
  double rough_time_s() const;
  double first_step_s() const;
  int copies(double step_s) const;
  Eigen::Matrix2d after(const Coasting& step, double end_s) const;
  TimeToLimit refined(int k, double t_s);

  HorizontalLimit limit_;
  SteadyMotion motion_;
  Eigen::Matrix<double, 3, 2> C_e_ne_;
  ErrorMatrix P_;  // at the latest time known to be inside the limit
  std::array<Coasting, kLevels> levels_{};
};

/// When independent errors would grow past the limit: within a small factor of the answer.
double Outlook::rough_time_s() const {
  constexpr double g = kStandardGravityMps2;
  const auto variance = [this](int i) { return P_.diagonal().segment<3>(i).sum(); };
  const ProcessNoise& q = motion_.noise;
  const double limit_sq_m2 = limit_.limit_m * limit_.limit_m;
  // A third: (R95 / DRMS)^2 of a circle.
  const double room_m2 =
      std::max(limit_sq_m2 / 3.0 - after(Coasting{}, 0.0).trace(), limit_sq_m2 / 100.0);
  const double by_t4 = (g * g * variance(kPsi) + variance(kBa)) / 4.0;
  const double by_t5 = (g * g * q.attitude_rad2_per_s + q.b_a_m2_per_s5) / 20.0;
  const auto growth_m2 = [&](double t) {
    const double by_t2 = variance(kDv) + t * q.velocity_m2_per_s3 / 3.0;
    const double by_t6 = g * g * (variance(kBg) + t * q.b_g_rad2_per_s3 / 7.0) / 36.0;
    const double t2 = t * t;
    return t2 * (by_t2 + t2 * (by_t4 + t * by_t5 + t2 * by_t6));
  };
  double t_s = std::ldexp(1.0, -14);
  while (t_s < kLeewayHorizonS && growth_m2(t_s) <= room_m2) t_s *= 2.0;
  return t_s;
}

/// Short against the answer and the motion; a turn, where there is one, is a power of two of it, so
/// that whole turns are steps.
double Outlook::first_step_s() const {
  const double step_s = std::min({rough_time_s() / 16.0, kLongestFirstStepS,
                                  kLargestFirstTurnRad / motion_.omega_el_radps.norm()});
  const double period_s = turn_period_s();
  if (period_s > kLeewayHorizonS) return step_s;
  return period_s / std::exp2(std::ceil(std::log2(period_s / step_s)));
}

/// How many of a step make the next longer one: two, but four where steps reach a quarter of a
/// period in which errors may grow and shrink, to look into that period.
int Outlook::copies(double step_s) const {
  const auto is_quarter = [step_s](double period_s) {
    return step_s < 0.26 * period_s && 0.26 * period_s <= 2.0 * step_s;
  };
  return is_quarter(kSchulerPeriodS) || is_quarter(turn_period_s()) ? 4 : 2;
}

/// North and east components of the covariance at the end of a step from where P_ is.
Eigen::Matrix2d Outlook::after(const Coasting& step, double end_s) const {
  const Transition& Phi = step.Phi;
  const auto C_ne_e = C_e_ne_.transpose();
  const Eigen::Matrix<double, 2, kErrorStates> rows = C_ne_e * Phi.r.leftCols<kErrorStates>();
  const Eigen::Matrix<double, 2, kErrorStates> rows_P = rows.lazyProduct(P_);
  const Eigen::Matrix2d P_l =
      rows_P.lazyProduct(rows.transpose()) + C_ne_e * step.Q.block<3, 3>(kDr, kDr) * C_e_ne_;
  if (limit_.metric != HorizontalMetric::kAxis) return P_l;
  // The axes l have turned with the vehicle; the other metrics do not ask where north is.
  const Eigen::Matrix2d C_nl = Eigen::Rotation2Dd(motion_.turn_radps * end_s).toRotationMatrix();
  return C_nl * P_l * C_nl.transpose();
}

TimeToLimit Outlook::search() {
  if (limit_.exceeded(after(Coasting{}, 0.0))) return {};
  level(0) = first_step(motion_, first_step_s());
  if (limit_.exceeded(after(level(0), level(0).Phi.dt_s))) return refined(0, 0.0);
  for (int k = 0; level(k).Phi.dt_s < kLeewayHorizonS; ++k) {
    Coasting reach = level(k);
    for (int copy = copies(reach.Phi.dt_s); copy > 1; --copy) {
      const double t_s = reach.Phi.dt_s;
      const Coasting longer = compose(started_later(level(k), motion_, t_s), reach);
      if (limit_.exceeded(after(longer, longer.Phi.dt_s))) {
        apply(reach, P_);
        return refined(k, t_s);
      }
      reach = longer;
    }
    level(k + 1) = reach;
  }
  return {kLeewayHorizonS, true};
}

/// P_ is that of t_s, inside the limit; a step of level k later it is beyond.
TimeToLimit Outlook::refined(int k, double t_s) {
  const int shortest = std::max(0, k - kLevels + 1);
  for (--k; k >= shortest; --k) {
    for (int copy = copies(level(k).Phi.dt_s); copy > 1; --copy) {
      const Coasting step = started_later(level(k), motion_, t_s);
      const double end_s = t_s + step.Phi.dt_s;
      if (limit_.exceeded(after(step, end_s))) break;
      apply(step, P_);
      t_s = end_s;
    }
  }
  const Coasting step = started_later(level(shortest), motion_, t_s);
  const double before = limit_.excess(after(Coasting{}, t_s));
  const double beyond = limit_.excess(after(step, t_s + step.Phi.dt_s));
  const double fraction = before / (before - beyond);
  if (fraction >= 0.0 && fraction <= 1.0) t_s += fraction * step.Phi.dt_s;
  return t_s < kLeewayHorizonS ? TimeToLimit{t_s, false} : TimeToLimit{kLeewayHorizonS, true};
}

TimeToLimit time_to(const Ekf& filter, const HorizontalLimit& limit) {
  return limit.limit_m > 0.0 ? Outlook(filter, limit).search() : TimeToLimit{};
}

}  // namespace

TimeToLimit time_to_limit(const Ekf& filter, double limit_m, double probability) {
  if (!(probability > 0.0 && probability < 1.0)) return {};
  return time_to(filter, {limit_m, std::log1p(-probability), HorizontalMetric::kR95});
}

TimeToLimit time_to_limit(const Ekf& filter, double limit_m, HorizontalMetric metric) {
  if (metric == HorizontalMetric::kR95) return time_to_limit(filter, limit_m, 0.95);
  return time_to(filter, {limit_m, 0.0, metric});
}

}  // namespace leeway
