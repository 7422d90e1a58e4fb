#include "filters/ekf/joint_update.hpp"

#include "filters/covariance/cholesky.hpp"
#include "filters/covariance/measurement_update.hpp"
#include "leeway/covariance/covariance.hpp"
#include "leeway/ekf/held_update.hpp"

namespace leeway {
namespace {

/// Takes rows into P. @returns the correction of the N states
template <int N>
Eigen::Matrix<double, N, 1> correction_by(Eigen::Matrix<double, N, N>& P, const WhiteMeasurement& m,
                                          const HeldDirections& U) {
  const int rows = static_cast<int>(m.z.size());
  RowColumns<double, N> H = RowColumns<double, N>::Zero();
  RowValues<double> z = RowValues<double>::Zero();
  H.topLeftCorner(kErrorStates, rows) = m.H.transpose();
  if constexpr (N > kErrorStates)
    H.bottomLeftCorner(kVehicleStates, rows) = m.H_vehicle.transpose();
  z.head(rows) = m.z;
  Eigen::Matrix<double, N, 1> x = Eigen::Matrix<double, N, 1>::Zero();
  const bool nothing_held = U.isZero(0.0);
  if (nothing_held && update_at_once<double, N>(P, x, rows, H, z, kJosephShrinkage)) return x;
  for (int i = 0; i < rows; ++i) {
    const Eigen::Matrix<double, N, 1> h = H.col(i);
    if (nothing_held) {
      scalar_update(P, x, h, z(i));
    } else {
      held_scalar_update(P, x, h, z(i), U);
    }
  }
  return x;
}

}  // namespace

WhiteMeasurement whitened(const Measurement& m, int weighted_rows, double weight,
                          bool with_vehicle) {
  const Cholesky<6> R_factor(m.R);
  WhiteMeasurement white{m.H, {}, m.innovation};
  R_factor.whiten(white.H);
  R_factor.whiten(white.z);
  if (with_vehicle) white.H_vehicle = R_factor.whitened(m.H_vehicle);
  white.H.topRows(weighted_rows) *= weight;
  white.z.head(weighted_rows) *= weight;
  if (with_vehicle) white.H_vehicle.topRows(weighted_rows) *= weight;
  return white;
}

MeasurementMatrix innovation_covariance(const Measurement& m, const ErrorMatrix& P,
                                        const VehicleState* vehicle) {
  MeasurementMatrix S = m.R;
  for (int i = 0; i < m.rows(); ++i) {
    const ErrorVector h = m.H.row(i);
    ErrorVector Ph = P * h;
    VehicleVector Ph_vehicle = VehicleVector::Zero();
    if (vehicle != nullptr) {
      const VehicleVector h_vehicle = m.H_vehicle.row(i);
      Ph += vehicle->cross * h_vehicle;
      Ph_vehicle = vehicle->cross.transpose() * h + vehicle->P * h_vehicle;
    }
    for (int j = i; j < m.rows(); ++j) {
      S(j, i) += m.H.row(j).dot(Ph) + m.H_vehicle.row(j).dot(Ph_vehicle);
      S(i, j) = S(j, i);
    }
  }
  return S;
}

ErrorVector update_jointly(Belief& belief, const WhiteMeasurement& m, Held held) {
  const HeldDirections U = directions_of(held, belief.estimate);
  if (!belief.vehicle) return correction_by(belief.P, m, U);
  VehicleState& vehicle = *belief.vehicle;
  JointMatrix P;
  P << belief.P, vehicle.cross, vehicle.cross.transpose(), vehicle.P;
  const JointVector x = correction_by(P, m, U);
  belief.P = P.topLeftCorner<kErrorStates, kErrorStates>();
  vehicle.cross = P.topRightCorner<kErrorStates, kVehicleStates>();
  vehicle.P = P.bottomRightCorner<kVehicleStates, kVehicleStates>();
  vehicle.value += x.tail<kVehicleStates>();
  return x.head<kErrorStates>();
}

}  // namespace leeway
