#include "leeway/sim/analysis/error_track.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "leeway/earth/error.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/strapdown/strapdown.hpp"

namespace leeway::sim {
namespace {

/// The errors after a stretch, leg by leg.
ErrorVector carried(const ErrorTrack& track, double from_s, double to_s, ErrorVector x,
                    const Eigen::Matrix<double, kSensorParameters, 1>& parameters) {
  while (from_s < to_s) {
    const Leg leg = track.leg(from_s, to_s);
    x = times(leg.Phi, x) + leg.B * parameters;
    from_s = leg.end_s;
  }
  return x;
}

/// What a strapdown makes of sensors with the given matrices, as error at the end.
ErrorVector strapdown_error(const Trajectory& trajectory, double from_s, double to_s,
                            const ErrorVector& start,
                            const Eigen::Matrix<double, kSensorParameters, 1>& parameters) {
  const Eigen::Matrix3d M_a = parameters.segment<9>(kMa).reshaped(3, 3);
  const Eigen::Matrix3d M_g = parameters.segment<9>(kMg).reshaped(3, 3);
  const Eigen::Matrix3d G_g = parameters.segment<9>(kGg).reshaped(3, 3);
  Estimate estimate;
  estimate.nav = truth_at(trajectory, from_s).nav;
  inject(estimate, -start);
  ImuHistory history;
  const int steps = static_cast<int>(std::lround((to_s - from_s) * 100.0));
  for (int k = 0; k < steps; ++k) {
    ImuIncrement inc = true_increment(trajectory, from_s + 0.01 * k, from_s + 0.01 * (k + 1));
    // Without bias, as estimated: measured = (1 + M) true, and the error state's own biases.
    const Eigen::Vector3d dv = inc.dv_b_mps;
    inc.dv_b_mps += M_a * dv + inc.dt_s * start.segment<3>(kBa);
    inc.dtheta_b_rad += M_g * inc.dtheta_b_rad + G_g * dv + inc.dt_s * start.segment<3>(kBg);
    strapdown_step(estimate.nav, inc, history);
  }
  Estimate truth;
  truth.nav = truth_at(trajectory, to_s).nav;
  return difference(truth, estimate);
}

}  // namespace

TEST_CASE("errors and sensor matrices act as on the nonlinear strapdown" *
          doctest::test_suite("heavy")) {
  // From within a step on a straight to within another, over a turn.
  const Trajectory trajectory = square_loop();
  ErrorTrackConfig config;
  config.parameters = true;
  const ErrorTrack track(trajectory, 200.0, config);
  constexpr double kFromS = 43.3;
  constexpr double kToS = 66.7;
  struct Kind {
    int first;
    int count;
    double size;
  };
  for (const Kind& kind : {Kind{kPsi, 3, 1e-5}, Kind{kDv, 3, 1.0}, Kind{kDr, 3, 1.0},
                           Kind{kBa, 3, 1e-4}, Kind{kBg, 3, 1e-6}, Kind{15 + kMa, 9, 1e-5},
                           Kind{15 + kMg, 9, 1e-4}, Kind{15 + kGg, 9, 1e-5}}) {
    Eigen::Matrix<double, kErrorStates, Eigen::Dynamic> exact(kErrorStates, kind.count);
    Eigen::Matrix<double, kErrorStates, Eigen::Dynamic> linear(kErrorStates, kind.count);
    for (int i = 0; i < kind.count; ++i) {
      Eigen::Matrix<double, kErrorStates + kSensorParameters, 1> x;
      x.setZero();
      x(kind.first + i) = kind.size;
      const ErrorVector start = x.head<kErrorStates>();
      const auto parameters = x.tail<kSensorParameters>().eval();
      exact.col(i) = 0.5 * (strapdown_error(trajectory, kFromS, kToS, start, parameters) -
                            strapdown_error(trajectory, kFromS, kToS, -start, -parameters));
      linear.col(i) = carried(track, kFromS, kToS, start, parameters);
    }
    CAPTURE(kind.first);
    for (const int group : {kPsi, kDv, kDr}) {
      // 5e-5 of the largest effect of the kind: pieces of 0.1 s at 9 deg/s err by 1e-5, and
      // position integrates what a turn does to the attitude twice more.
      const double largest = exact.middleRows<3>(group).colwise().norm().maxCoeff();
      const double difference = (linear - exact).middleRows<3>(group).colwise().norm().maxCoeff();
      CHECK(difference <= 5e-5 * largest + 1e-8 * kind.size);
    }
  }
}

TEST_CASE("a trajectory with a period is sampled once, and wraps") {
  const Trajectory trajectory = square_loop();
  const ErrorTrack periodic(trajectory, 1000.0, {});
  Trajectory once = trajectory;
  once.period_s.reset();
  const ErrorTrack full(once, 1000.0, {});
  for (const double from_s : {0.0, 239.4, 480.0, 723.45}) {
    ErrorVector x = ErrorVector::Constant(1e-3);
    const auto none = Eigen::Matrix<double, kSensorParameters, 1>::Zero();
    const ErrorVector a = carried(periodic, from_s, from_s + 12.3, x, none);
    const ErrorVector b = carried(full, from_s, from_s + 12.3, x, none);
    CAPTURE(from_s);
    // Runs of steady legs, cut elsewhere, turn by 1e-4 rad: half of that, a tenth of the error.
    CHECK((a - b).norm() < 1e-5 * b.norm());
  }
}

TEST_CASE("legs end at steps and at the time asked for") {
  const ErrorTrack track(straight(), 10.0, {});
  CHECK(track.leg(0.0, 10.0).end_s == 1.0);
  CHECK(track.leg(3.25, 10.0).end_s == 4.0);
  CHECK(track.leg(3.25, 3.75).end_s == 3.75);
  CHECK(std::abs(track.leg(3.25, 3.75).Phi.dt_s - 0.5) < 1e-12);
  CHECK(track.leg(9.0, 10.0).end_s == 10.0);
}

TEST_CASE("a step out of range is refused") {
  ErrorTrackConfig config;
  config.step_s = 0.0;
  CHECK_THROWS_WITH_AS(ErrorTrack(straight(), 10.0, config),
                       doctest::Contains("must be 0.01 to 100"), Error);
}

}  // namespace leeway::sim
