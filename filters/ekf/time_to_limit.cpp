#include "leeway/ekf/time_to_limit.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "filters/ekf/error_growth.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/model/horizontal.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {
namespace {

constexpr double kSchulerPeriodS = 5064.0;
constexpr double kLongestFirstStepS = 16.0;   // 1/300 of a Schuler period
constexpr double kLargestFirstTurnRad = 0.1;  // of the axes l within the first step

/// What a horizontal error is held against: a circle that so many errors stay within.
struct CircularLimit {
  static constexpr int kAxes = 2;  // north, east

  double limit_m{0.0};
  double log_tail{0.0};  // of the probability allowed beyond it

  /// Positive beyond the limit; smooth, the logarithm of a variance ratio. NaN if P or the limit
  /// is.
  double excess(const Eigen::Matrix2d& P_m2) const {
    return std::log(log_tail / std::log(probability_beyond(P_m2, limit_m)));
  }

  /// The sign of excess, for less work where bounds on the probability settle it: the error along
  /// the major axis alone, and a circle with that axis all round. Not a number is beyond.
  bool exceeded(const Eigen::Matrix2d& P_m2) const {
    const double u = 0.5 * limit_m * limit_m / principal_variances(P_m2).x();
    if (-u <= log_tail) return false;
    if (std::log(std::erfc(std::sqrt(u))) > log_tail) return true;
    return !(excess(P_m2) <= 0.0);
  }
};

/// What an error is held against by another metric. Axes are north, east and down of the start,
/// which turn with the vehicle: in them it keeps its course.
struct MetricLimit {
  static constexpr int kAxes = 3;

  double limit_m{0.0};
  ErrorMetric metric{ErrorMetric::kDrms};
  double course_rad{0.0};

  double excess(const Eigen::Matrix3d& P_m2) const {
    return 2.0 * std::log(error_size_m(metric, P_m2, course_rad) / limit_m);
  }
  bool exceeded(const Eigen::Matrix3d& P_m2) const { return !(excess(P_m2) <= 0.0); }
};

/// The errors of a filter, ahead in time.
template <class Limit>
class Outlook {
 public:
  Outlook(const Ekf& filter, const Limit& limit)
      : limit_(limit),
        motion_(steady_motion(filter)),
        C_en_(ned_to_ecef(geodetic_from_ecef(filter.estimate().nav.r_e_m)).leftCols<kAxes>()),
        P_(filter.covariance()) {}

  TimeToLimit search();

 private:
  static constexpr int kAxes = Limit::kAxes;
  using Covariance = Eigen::Matrix<double, kAxes, kAxes>;
  static constexpr int kLevels = 5;  // the shortest step is at most 1/16 of the one that passed

  Coasting& level(int k) { return levels_[static_cast<std::size_t>(k % kLevels)]; }
  double turn_period_s() const { return 2.0 * std::numbers::pi / std::abs(motion_.turn_radps); }
  double rough_time_s() const;
  double first_step_s() const;
  int copies(double step_s) const;
  Covariance after(const Coasting& step) const;
  TimeToLimit refined(int k, double t_s);

  Limit limit_;
  SteadyMotion motion_;
  Eigen::Matrix<double, 3, kAxes> C_en_;
  ErrorMatrix P_;  // at the latest time known to be inside the limit
  std::array<Coasting, kLevels> levels_{};
};

/// When independent errors would grow past the limit: within a small factor of the answer.
template <class Limit>
double Outlook<Limit>::rough_time_s() const {
  constexpr double g = kStandardGravityMps2;
  const auto variance = [this](int i) { return P_.diagonal().segment<3>(i).sum(); };
  const ProcessNoise& q = motion_.noise;
  const double limit_sq_m2 = limit_.limit_m * limit_.limit_m;
  // A third: (R95 / DRMS)^2 of a circle.
  const double room_m2 =
      std::max(limit_sq_m2 / 3.0 - after(Coasting{}).trace(), limit_sq_m2 / 100.0);
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
template <class Limit>
double Outlook<Limit>::first_step_s() const {
  const double step_s = std::min({rough_time_s() / 16.0, kLongestFirstStepS,
                                  kLargestFirstTurnRad / motion_.omega_el_radps.norm()});
  const double period_s = turn_period_s();
  if (period_s > kLeewayHorizonS) return step_s;
  return period_s / std::exp2(std::ceil(std::log2(period_s / step_s)));
}

/// How many of a step make the next longer one: two, but four where steps reach a quarter of a
/// period in which errors may grow and shrink, to look into that period.
template <class Limit>
int Outlook<Limit>::copies(double step_s) const {
  const auto is_quarter = [step_s](double period_s) {
    return step_s < 0.26 * period_s && 0.26 * period_s <= 2.0 * step_s;
  };
  return is_quarter(kSchulerPeriodS) || is_quarter(turn_period_s()) ? 4 : 2;
}

/// Covariance of the position at the end of a step from where P_ is. Its axes, north and east of
/// the start, have turned with the vehicle: of the metrics only a course asks for north, and it has
/// too.
template <class Limit>
auto Outlook<Limit>::after(const Coasting& step) const -> Covariance {
  const Transition& Phi = step.Phi;
  const auto C_ne = C_en_.transpose();
  const Eigen::Matrix<double, kAxes, kErrorStates> rows =
      C_ne * Phi.r.template leftCols<kErrorStates>();
  const Eigen::Matrix<double, kAxes, kErrorStates> rows_P = rows.lazyProduct(P_);
  return rows_P.lazyProduct(rows.transpose()) +
         C_ne * step.Q.template block<3, 3>(kDr, kDr) * C_en_;
}

template <class Limit>
TimeToLimit Outlook<Limit>::search() {
  if (limit_.exceeded(after(Coasting{}))) return {};
  level(0) = first_step(motion_, first_step_s());
  if (limit_.exceeded(after(level(0)))) return refined(0, 0.0);
  for (int k = 0; level(k).Phi.dt_s < kLeewayHorizonS; ++k) {
    Coasting reach = level(k);
    for (int copy = copies(reach.Phi.dt_s); copy > 1; --copy) {
      const double t_s = reach.Phi.dt_s;
      const Coasting longer = compose(started_later(level(k), motion_, t_s), reach);
      if (limit_.exceeded(after(longer))) {
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
template <class Limit>
TimeToLimit Outlook<Limit>::refined(int k, double t_s) {
  const int shortest = std::max(0, k - kLevels + 1);
  for (--k; k >= shortest; --k) {
    for (int copy = copies(level(k).Phi.dt_s); copy > 1; --copy) {
      const Coasting step = started_later(level(k), motion_, t_s);
      if (limit_.exceeded(after(step))) break;
      apply(step, P_);
      t_s += step.Phi.dt_s;
    }
  }
  const Coasting step = started_later(level(shortest), motion_, t_s);
  const double before = limit_.excess(after(Coasting{}));
  const double beyond = limit_.excess(after(step));
  const double fraction = before / (before - beyond);
  if (fraction >= 0.0 && fraction <= 1.0) t_s += fraction * step.Phi.dt_s;
  return t_s < kLeewayHorizonS ? TimeToLimit{t_s, false} : TimeToLimit{kLeewayHorizonS, true};
}

template <class Limit>
TimeToLimit time_to(const Ekf& filter, const Limit& limit) {
  return limit.limit_m > 0.0 ? Outlook<Limit>(filter, limit).search() : TimeToLimit{};
}

}  // namespace

TimeToLimit time_to_limit(const Ekf& filter, double limit_m, double probability) {
  if (!(probability > 0.0 && probability < 1.0)) return {};
  return time_to(filter, CircularLimit{limit_m, std::log1p(-probability)});
}

TimeToLimit time_to_limit(const Ekf& filter, double limit_m, ErrorMetric metric) {
  const double probability = radius_probability(metric);
  if (probability > 0.0) return time_to_limit(filter, limit_m, probability);
  return time_to(filter,
                 MetricLimit{limit_m, metric, course_over_ground_rad(filter.estimate().nav)});
}

}  // namespace leeway
