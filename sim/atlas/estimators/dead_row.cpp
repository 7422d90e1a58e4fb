#include <algorithm>
#include <cmath>

#include "filters/covariance/cholesky.hpp"
#include "leeway/covariance/covariance_kernel.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "sim/atlas/linear_response.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kRowPriorM = 10.0;
constexpr double kPriorMps = 1.0;
constexpr double kRowFixM = 1.0;
constexpr double kFixMps = 0.1;

TrialStart independent_start() {
  TrialStart start;
  start.estimate.nav = truth_at(static_trajectory(), 0.0).nav;
  start.P = 1e-6 * ErrorMatrix::Identity();
  start.P.diagonal().segment<3>(kDv).setConstant(kPriorMps * kPriorMps);
  start.P.diagonal().segment<3>(kDr).setConstant(kRowPriorM * kRowPriorM);
  return start;
}

/// As far from the estimate as both sigmas let expect.
GnssFix whole_fix(const TrialStart& start, Time time) {
  GnssFix fix;
  fix.time = time;
  fix.position = {start.estimate.nav.r_e_m.array() + std::hypot(kRowPriorM, kRowFixM),
                  kRowFixM * kRowFixM * Eigen::Matrix3d::Identity()};
  fix.velocity = {start.estimate.nav.v_e_mps.array() + std::hypot(kPriorMps, kFixMps),
                  kFixMps * kFixMps * Eigen::Matrix3d::Identity()};
  return fix;
}

/// P R / (P + R): what a measurement leaves of a variance that it measures.
double fused_variance(double prior_sigma, double fix_sigma) {
  const double prior = prior_sigma * prior_sigma;
  const double fix = fix_sigma * fix_sigma;
  return prior * fix / (prior + fix);
}

/// The largest factor between a variance after the fix and what it should be, of the six that a fix
/// measures.
double worst_factor(const ErrorMatrix& P) {
  double worst = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    worst = std::max(
        {worst, factor_between(P(kDr + axis, kDr + axis), fused_variance(kRowPriorM, kRowFixM)),
         factor_between(P(kDv + axis, kDv + axis), fused_variance(kPriorMps, kFixMps))});
  }
  return worst;
}

/// The fix without one of its rows: (P^-1 + H^T R^-1 H)^-1 with what is left of H.
double factor_without_row(const TrialStart& start, int row) {
  Measurement m = gnss_measurement(whole_fix(start, {}), start.estimate, Eigen::Vector3d::Zero(),
                                   Eigen::Vector3d::Zero());
  m.H.row(row).setZero();
  const auto white_H = Cholesky<kMaxRows>(m.R).whitened(m.H);
  ErrorMatrix information = white_H.transpose().lazyProduct(white_H);
  information.diagonal() += start.P.diagonal().cwiseInverse();  // of a P that is diagonal
  const ErrorMatrix root =
      Cholesky<kErrorStates>(information).whitened(ErrorMatrix(ErrorMatrix::Identity()));
  return worst_factor(root.transpose().lazyProduct(root));
}

std::vector<AtlasCell> run_dead_row(const AtlasOptions& /*options*/) {
  const TrialStart start = independent_start();
  // Short: what it adds to the variances is below the limit.
  const ImuIncrement inc = true_increment(static_trajectory(), 0.0, 0.01);
  std::vector<AtlasCell> cells;
  for (const AtlasColumn& column : claiming(atlas_columns())) {
    const auto filter = column.make(EkfConfig{.imu = {}, .gnss_correlation_s = 0.0}, start);
    filter->predict(inc);
    filter->update(whole_fix(start, inc.time));
    cells.push_back({column.group,
                     column.name,
                     {},
                     worst_factor(*filter->covariance()),
                     joined(filter->reported())});
  }
  cells.push_back(
      {AtlasGroup::kNotOffered, "a position row unused", {}, factor_without_row(start, 0)});
  cells.push_back(
      {AtlasGroup::kNotOffered, "a velocity row unused", {}, factor_without_row(start, 5)});
  return cells;
}

}  // namespace

AtlasScene dead_row() {
  return {.place = 140,
          .key = "dead-row",
          .title = "A measurement row that does nothing",
          .figure = "worst factor between a variance after a fix and P R / (P + R)",
          .limits = {1.001, 2.0,
                     "the closed form holds to rounding, also in float; a variance twice too large "
                     "is a row of which half was lost"},
          .run = run_dead_row};
}

}  // namespace leeway::sim::scenes
