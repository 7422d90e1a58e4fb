#include "sim/analysis/doubling/riccati_map.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <cmath>

namespace leeway::sim {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A step of a filter and of the truth, one after the other as the textbook has them.
struct Step {
  MatrixXd Phi;
  MatrixXd claimed_noise;
  MatrixXd true_noise;
  VectorXd h;
  double true_variance;

  MomentPair of(MomentPair m) const {
    m.claimed = (Phi * m.claimed * Phi.transpose() + claimed_noise).eval();
    m.truth = (Phi * m.truth * Phi.transpose() + true_noise).eval();
    const VectorXd K = m.claimed * h / (h.dot(m.claimed * h) + 1.0);
    const MatrixXd left = MatrixXd::Identity(h.size(), h.size()) - K * h.transpose();
    m.claimed = (left * m.claimed * left.transpose() + K * K.transpose()).eval();
    m.truth = (left * m.truth * left.transpose() + true_variance * K * K.transpose()).eval();
    return m;
  }

  void add_to(RiccatiMap& map) const {
    map.propagate(Phi, claimed_noise, true_noise);
    map.measure(h, true_variance);
  }
};

/// Position, velocity and a bias that is known better and better.
Step step_of_three(double dt) {
  Step step;
  step.Phi = MatrixXd::Identity(3, 3);
  step.Phi(0, 1) = step.Phi(1, 2) = dt;
  step.Phi(0, 2) = 0.5 * dt * dt;
  step.claimed_noise = MatrixXd::Zero(3, 3);
  step.claimed_noise(1, 1) = 0.02 * dt;
  step.true_noise = 3.0 * step.claimed_noise;
  step.true_noise(0, 0) = 0.01;
  step.h = VectorXd::Zero(3);
  step.h(0) = 0.8;
  step.h(1) = 0.3 * dt;
  step.true_variance = 1.7;
  return step;
}

MomentPair start_of_three() {
  MomentPair start;
  start.claimed = VectorXd::Constant(3, 4.0).asDiagonal();
  start.truth = MatrixXd::Constant(3, 3, 1.0);
  start.truth.diagonal().array() += 1.0;
  return start;
}

double difference(const MatrixXd& a, const MatrixXd& b) { return (a - b).norm() / b.norm(); }

}  // namespace

TEST_CASE("a doubled map does what its steps do one by one, for claim and truth") {
  // 1e-9: a thousand steps of rounding at conditions of 1e5.
  const Step one = step_of_three(0.5);
  const Step other = step_of_three(1.25);
  RiccatiMap map(3, true);
  one.add_to(map);
  other.add_to(map);
  for (const int times : {0, 1, 2, 3, 64, 1000}) {
    MomentPair stepped = start_of_three();
    for (int k = 0; k < times; ++k) stepped = other.of(one.of(stepped));
    const MomentPair doubled = repeated(map, times).of(start_of_three());
    CAPTURE(times);
    CHECK(difference(doubled.claimed, stepped.claimed) < 1e-9);
    CHECK(difference(doubled.truth, stepped.truth) < 1e-9);
  }
}

TEST_CASE("the way of an error is that under the filter's gains") {
  const Step step = step_of_three(0.5);
  RiccatiMap map(3, false);
  MatrixXd way = MatrixXd::Identity(3, 3);
  MomentPair now = start_of_three();
  for (int k = 0; k < 20; ++k) {
    step.add_to(map);
    const MatrixXd P = step.Phi * now.claimed * step.Phi.transpose() + step.claimed_noise;
    const VectorXd K = P * step.h / (step.h.dot(P * step.h) + 1.0);
    way = (step.Phi * way).eval();
    way -= (K * (step.h.transpose() * way)).eval();
    now = step.of(now);
  }
  CHECK(difference(map.closed_loop(start_of_three().claimed), way) < 1e-10);
}

TEST_CASE("a scalar in the steady state has the closed form of its Riccati equation") {
  // After the fix: P = (p + q) / (p + q + 1) has the root below.
  constexpr double kQ = 0.3;
  RiccatiMap map(1, false);
  map.propagate(MatrixXd::Ones(1, 1), MatrixXd::Constant(1, 1, kQ), {});
  map.measure(VectorXd::Ones(1), 0.0);
  const double root = 0.5 * (-kQ + std::sqrt(kQ * kQ + 4.0 * kQ));
  const MomentPair start{MatrixXd::Constant(1, 1, 1e6), {}};
  const double steady = repeated(map, std::int64_t{1} << 20).of(start).claimed(0, 0);
  CHECK(std::abs(steady / root - 1.0) < 1e-12);
}

TEST_CASE("position and velocity that are measured together tend to sqrt(sigma_p sigma_v T)") {
  constexpr double kSigmaP = 2.5;
  constexpr double kSigmaV = 0.05;
  for (const double T : {0.1, 0.5, 1.0}) {
    MatrixXd Phi = MatrixXd::Identity(2, 2);
    Phi(0, 1) = T;
    // A velocity that is known from its fixes alone.
    MatrixXd noise = MatrixXd::Zero(2, 2);
    noise(1, 1) = 1e6;
    RiccatiMap map(2, false);
    map.propagate(Phi, noise, {});
    map.measure(VectorXd{{1.0 / kSigmaP, 0.0}}, 0.0);
    map.measure(VectorXd{{0.0, 1.0 / kSigmaV}}, 0.0);
    const MomentPair start{1e4 * MatrixXd::Identity(2, 2), {}};
    const double after = std::sqrt(repeated(map, 1 << 20).of(start).claimed(0, 0));
    // Each gap then adds (sigma_v T)^2: to first order in T, as docs/theory/analysis/interval.md.
    CAPTURE(T);
    CHECK(std::abs(after / std::sqrt(kSigmaP * kSigmaV * T) - 1.0) <
          0.5 * kSigmaV * T / kSigmaP + 1e-3);
  }
}

}  // namespace leeway::sim
