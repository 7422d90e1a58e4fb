#include "sim/analysis/doubling/riccati_map.hpp"

#include <Eigen/LU>

namespace leeway::sim {
namespace {

using Eigen::MatrixXd;

/// Rounding would grow from one doubling to the next.
void make_symmetric(MatrixXd& M) { M = (0.5 * (M + M.transpose())).eval(); }

/// M + M^T.
MatrixXd twice_symmetric(const MatrixXd& M) { return M + M.transpose(); }

/// (I + P G)^-1.
MatrixXd inverse_of_sum(const MatrixXd& P, const MatrixXd& G) {
  MatrixXd M = P * G;
  M.diagonal().array() += 1.0;
  return M.inverse();
}

}  // namespace

RiccatiMap::RiccatiMap(Eigen::Index states, bool with_truth) {
  const MatrixXd none = MatrixXd::Zero(states, states);
  map_ = {MatrixXd::Identity(states, states), none, none};
  if (with_truth) tangent_ = {none, none, none};
}

void RiccatiMap::propagate(const MatrixXd& Phi, const MatrixXd& claimed_noise,
                           const MatrixXd& true_noise) {
  map_.A = Phi * map_.A;
  map_.H = Phi * map_.H * Phi.transpose() + claimed_noise;
  make_symmetric(map_.H);
  if (!with_truth()) return;
  tangent_.A = Phi * tangent_.A;
  tangent_.H = Phi * tangent_.H * Phi.transpose() + true_noise;
  make_symmetric(tangent_.H);
}

void RiccatiMap::measure(const Eigen::VectorXd& h, double true_variance) {
  const Eigen::VectorXd Hh = map_.H * h;
  const double s = h.dot(Hh) + 1.0;
  const Eigen::VectorXd K = Hh / s;
  const Eigen::VectorXd a = map_.A.transpose() * h;
  if (with_truth()) {
    Triple& t = tangent_;
    const Eigen::VectorXd tangent_Hh = t.H * h;
    const Eigen::VectorXd tangent_a = t.A.transpose() * h;
    const double tangent_s = h.dot(tangent_Hh) + true_variance;
    const Eigen::VectorXd tangent_K = (tangent_Hh - tangent_s * K) / s;
    t.A -= K * tangent_a.transpose() + tangent_K * a.transpose();
    const Eigen::VectorXd half = (tangent_a - 0.5 * tangent_s / s * a) / s;
    t.G += half * a.transpose() + a * half.transpose();
    // As SourceCovariance has it.
    const Eigen::VectorXd left = tangent_Hh - 0.5 * tangent_s * K;
    t.H -= K * left.transpose() + left * K.transpose();
  }
  map_.A -= K * a.transpose();
  map_.G += a * a.transpose() / s;
  map_.H -= s * K * K.transpose();
}

RiccatiMap::Triple RiccatiMap::joint_tangent(const RiccatiMap& later, const MatrixXd& V) const {
  const Triple& one = map_;
  const Triple& two = later.map_;
  const Triple& d_one = tangent_;
  const Triple& d_two = later.tangent_;
  const MatrixXd dV = -V * (d_one.H * two.G + one.H * d_two.G) * V;
  const MatrixXd AV = two.A * V;
  const MatrixXd GV = two.G * V;
  const MatrixXd VH = V * one.H;
  Triple joint;
  joint.A = d_two.A * V * one.A + two.A * dV * one.A + AV * d_one.A;
  const MatrixXd dGV = d_two.G * V + two.G * dV;
  joint.G =
      d_one.G + one.A.transpose() * dGV * one.A + twice_symmetric(d_one.A.transpose() * GV * one.A);
  const MatrixXd dVH = dV * one.H + V * d_one.H;
  joint.H =
      d_two.H + two.A * dVH * two.A.transpose() + twice_symmetric(d_two.A * VH * two.A.transpose());
  make_symmetric(joint.G);
  make_symmetric(joint.H);
  return joint;
}

void RiccatiMap::then(const RiccatiMap& later) {
  const MatrixXd V = inverse_of_sum(map_.H, later.map_.G);
  if (with_truth()) tangent_ = joint_tangent(later, V);
  const MatrixXd AV = later.map_.A * V;
  map_.G += map_.A.transpose() * later.map_.G * V * map_.A;
  map_.H = later.map_.H + AV * map_.H * later.map_.A.transpose();
  map_.A = AV * map_.A;
  make_symmetric(map_.G);
  make_symmetric(map_.H);
}

MomentPair RiccatiMap::of(const MomentPair& start) const {
  const MatrixXd W = inverse_of_sum(start.claimed, map_.G);
  MatrixXd known = W * start.claimed;  // (P^-1 + G)^-1
  make_symmetric(known);
  MomentPair end;
  end.claimed = map_.H + map_.A * known * map_.A.transpose();
  make_symmetric(end.claimed);
  if (!with_truth()) return end;
  const MatrixXd d_known = W * start.truth * W.transpose() - known * tangent_.G * known;
  end.truth = tangent_.H + map_.A * d_known * map_.A.transpose() +
              twice_symmetric(tangent_.A * known * map_.A.transpose());
  make_symmetric(end.truth);
  return end;
}

MatrixXd RiccatiMap::closed_loop(const MatrixXd& claimed_at_start) const {
  return map_.A * inverse_of_sum(claimed_at_start, map_.G);
}

RiccatiMap repeated(RiccatiMap map, std::int64_t times) {
  RiccatiMap all(map.states(), map.with_truth());
  for (; times > 0; times /= 2) {
    if (times % 2 == 1) all.then(map);
    if (times > 1) map.then(RiccatiMap(map));
  }
  return all;
}

}  // namespace leeway::sim
