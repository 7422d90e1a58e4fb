#include "leeway/model/vehicle_measurements.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <string>

#include "leeway/earth/earth.hpp"
#include "leeway/navigator/aidings.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "tests/filters/model/random_state.hpp"
#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::near;
using test::random_estimate;
using test::random_vector;

/// An estimate, the vehicle's parameters as estimated, and a measured rate.
struct VehicleSetup {
  Estimate estimate{};
  VehicleVector vehicle{};
  Eigen::Vector3d omega_b_radps{};
};

/// Mount angles to 0.07 rad, every second one 0, axles to 3 m off, scales to 10 %, rates to
/// 3 rad/s.
VehicleSetup random_vehicle_setup(std::uint64_t seed) {
  sim::Random random(seed, 3);
  VehicleSetup s{random_estimate(seed)};
  for (double& v : s.vehicle) v = 2.0 * random.uniform() - 1.0;
  const double mount_rad = seed % 2 == 0 ? 0.0 : 0.05;
  s.vehicle.array() *= (VehicleVector() << mount_rad, mount_rad, 3.0, 0.1, 50.0).finished().array();
  s.omega_b_radps = random_vector(random, 3.0);
  return s;
}

/// The truth that is x and y away from what is estimated.
VehicleSetup truth_of(const VehicleSetup& s, const ErrorVector& x, const VehicleVector& y) {
  VehicleSetup truth = s;
  inject(truth.estimate, x);
  truth.vehicle += y;
  return truth;
}

/// dz/dy at 0 by the central five-point stencil.
template <class F>
auto vehicle_jacobian(const F& f, const VehicleVector& steps) {
  using Value = decltype(f(VehicleVector()));
  Eigen::Matrix<double, Value::RowsAtCompileTime, kVehicleStates> J;
  for (int j = 0; j < kVehicleStates; ++j) {
    const auto at = [&](double multiple) -> Value {
      return f(VehicleVector::Unit(j) * multiple * steps(j));
    };
    J.col(j) = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * steps(j));
  }
  return J;
}

/// What an errorless sensor reads at the truth, less what the estimate expects, and H beside it.
/// The rows are filled up to three.
struct Model {
  std::string name;
  std::function<Eigen::Vector3d(const VehicleSetup& truth, const VehicleSetup& estimated)>
      innovation;
  std::function<Measurement(const VehicleSetup&)> linearized;
};

Eigen::Vector3d filled(const Measurement& m) {
  Eigen::Vector3d z = Eigen::Vector3d::Zero();
  z.head(m.rows()) = m.innovation;
  return z;
}

/// The constraint at the truth, which is 0 there, is the truth's own velocity elsewhere.
Measurement constraint(const VehicleSetup& s) {
  return non_holonomic(s.estimate, s.vehicle, s.omega_b_radps, 0.1, 0.2);
}

double odometer_reads(const VehicleSetup& truth) {
  return (1.0 + truth.vehicle(kOdometerScale)) *
         RearAxle(truth.estimate, truth.vehicle, truth.omega_b_radps).v_mps.x();
}

Measurement odometer(const VehicleSetup& s, double speed_mps) {
  return measurement(OdometerSpeed{{}, speed_mps, 0.1}, s.estimate, s.vehicle, s.omega_b_radps);
}

Measurement barometer(const VehicleSetup& s, double height_m) {
  return measurement(BarometricHeight{{}, height_m, 0.1}, s.estimate, s.vehicle, s.omega_b_radps);
}

/// A gyro with the truth's bias that turns with the Earth.
Eigen::Vector3d gyro_reads_at_rest(const VehicleSetup& truth) {
  return truth.estimate.bias.b_g_radps +
         truth.estimate.nav.q_eb.conjugate() * earth_rotation_e_radps();
}

double barometer_reads(const VehicleSetup& truth) {
  return geodetic_from_ecef(truth.estimate.nav.r_e_m).height_m + truth.vehicle(kHeightOffset);
}

const Model kModels[] = {
    {"non-holonomic",
     // z = 0 at the truth: the estimate's velocity minus the truth's says by how much it is off.
     [](const VehicleSetup& truth, const VehicleSetup& s) -> Eigen::Vector3d {
       return filled(constraint(s)) - filled(constraint(truth));
     },
     constraint},
    {"odometer",
     [](const VehicleSetup& truth, const VehicleSetup& s) {
       return filled(odometer(s, odometer_reads(truth)));
     },
     [](const VehicleSetup& s) { return odometer(s, odometer_reads(s)); }},
    {"zero velocity",
     [](const VehicleSetup& truth, const VehicleSetup& s) -> Eigen::Vector3d {
       return truth.estimate.nav.v_e_mps + filled(zero_velocity(s.estimate, 0.1));
     },
     [](const VehicleSetup& s) { return zero_velocity(s.estimate, 0.1); }},
    {"zero angular rate",
     [](const VehicleSetup& truth, const VehicleSetup& s) {
       return filled(zero_angular_rate(s.estimate, gyro_reads_at_rest(truth), 0.1));
     },
     [](const VehicleSetup& s) {
       return zero_angular_rate(s.estimate, gyro_reads_at_rest(s), 0.1);
     }},
    {"barometer",
     [](const VehicleSetup& truth, const VehicleSetup& s) {
       return filled(barometer(s, barometer_reads(truth)));
     },
     [](const VehicleSetup& s) { return barometer(s, barometer_reads(s)); }},
};

}  // namespace

TEST_CASE("H of every vehicle measurement is the derivative of its innovation") {
  const ErrorVector steps = test::jacobian_steps(0.01, 10.0, 1000.0, 1.0, 0.1);
  const VehicleVector vehicle_steps = (VehicleVector() << 0.01, 0.01, 1.0, 0.1, 10.0).finished();
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const VehicleSetup s = random_vehicle_setup(seed);
    for (const Model& model : kModels) {
      CAPTURE(seed);
      CAPTURE(model.name);
      const Measurement m = model.linearized(s);
      const double speed_mps = RearAxle(s.estimate, s.vehicle, s.omega_b_radps).v_mps.norm();
      CHECK(m.R.diagonal().minCoeff() > 0.0);
      const auto numeric = test::central_jacobian(
          [&](const ErrorVector& x) -> Eigen::Vector3d {
            return model.innovation(truth_of(s, x, VehicleVector::Zero()), s);
          },
          steps);
      const auto numeric_vehicle = vehicle_jacobian(
          [&](const VehicleVector& y) -> Eigen::Vector3d {
            return model.innovation(truth_of(s, ErrorVector::Zero(), y), s);
          },
          vehicle_steps);
      for (int row = 0; row < m.rows(); ++row) {
        CAPTURE(row);
        for (int col = 0; col < kErrorStates; col += 3) {
          CAPTURE(col);
          const Eigen::RowVector3d block = m.H.block<1, 3>(row, col);
          // Relative to the block. Rounding: of a height (1e-9 m over 1000 m), of 300 m/s, of
          // 0.02 rad/s; the attitude block of the rate at rest is the Earth's 7e-5 rad/s.
          CHECK(near(numeric.block<1, 3>(row, col), block, 1e-6 * block.norm() + 1e-11));
        }
        for (int col = 0; col < kVehicleStates; ++col) {
          CAPTURE(col);
          const double value = m.H_vehicle(row, col);
          // The mount's turn is taken as small: half of it in the velocity, exact where it is 0.
          const bool is_mount = col == kMountPitch || col == kMountYaw;
          const double small = is_mount ? 0.55 * s.vehicle.head<2>().norm() * speed_mps : 0.0;
          // Rounding: of 300 m/s over steps of 0.01 rad, of a height of 1e-9 m over 10 m.
          CHECK(near(numeric_vehicle(row, col), value, 1e-6 * std::abs(value) + 1e-8 + small));
        }
      }
    }
  }
}

TEST_CASE("signs: a car drives forward, slips right, climbs; its wheels read too much") {
  Estimate car;
  const Geodetic place{45.0 * kRadPerDeg, 37.0 * kRadPerDeg, 100.0};
  const Eigen::Matrix3d C_en = ned_to_ecef(place);
  car.nav.r_e_m = ecef_from_geodetic(place);
  car.nav.q_eb = Eigen::Quaterniond(C_en);  // faces north, level
  car.nav.v_e_mps = C_en * Eigen::Vector3d(10.0, 0.4, -0.3);
  VehicleVector vehicle = VehicleVector::Zero();
  vehicle(kRearAxleX) = -2.0;
  vehicle(kOdometerScale) = 0.05;
  vehicle(kHeightOffset) = 7.0;
  const Eigen::Vector3d still_b = C_en.transpose() * earth_rotation_e_radps();
  // Turns right at 0.1 rad/s: the axle, 2 m behind, swings out to the left by 0.2 m/s.
  const Eigen::Vector3d turning_b = still_b + Eigen::Vector3d(0.0, 0.0, 0.1);
  // Of 10 m/s in ECEF 1e-14 are lost, of 6.4e6 m 1e-9.
  CHECK(near(RearAxle(car, vehicle, still_b).v_mps, Eigen::Vector3d(10.0, 0.4, -0.3), 1e-13));
  CHECK(near(RearAxle(car, vehicle, turning_b).v_mps, Eigen::Vector3d(10.0, 0.2, -0.3), 1e-13));
  CHECK(near(measurement(OdometerSpeed{{}, 10.0, 0.1}, car, vehicle, still_b).innovation(0), -0.5,
             1e-13));
  const Measurement constrained = non_holonomic(car, vehicle, turning_b, 0.1, 0.2);
  CHECK(near(constrained.innovation, Eigen::Vector2d(-0.2, 0.3), 1e-13));
  CHECK(near(constrained.R.diagonal(), Eigen::Vector2d(0.01, 0.04), 1e-15));
  CHECK(near(measurement(BarometricHeight{{}, 107.5, 0.1}, car, vehicle, still_b).innovation(0),
             0.5, 3e-9));
  // A body that looks 0.04 rad right of the way it goes carries a mount yaw of -0.04 rad.
  vehicle(kMountYaw) = -0.04;
  car.nav.q_eb = Eigen::Quaterniond(C_en * exp_rotation({0.0, 0.0, 0.04}));
  car.nav.v_e_mps = C_en * Eigen::Vector3d(10.0, 0.0, 0.0);
  // The rate is still that of the body before it was turned: 7e-5 rad/s, 2 m, 0.04 rad.
  CHECK(near(RearAxle(car, vehicle, still_b).v_mps.tail<2>(), Eigen::Vector2d::Zero(), 1e-5));
}

TEST_CASE("the axle of a simulated car goes straight where the body turns about it") {
  // On a circle of 100 m at 20 m/s the point without side slip is the one ahead or behind at which
  // the velocity is along the body: the body axis is the tangent at the IMU, so it is the IMU.
  const sim::Trajectory circle = sim::circle();
  const sim::TruthPoint truth = sim::truth_at(circle, 10.0);
  Estimate estimate;
  estimate.nav = truth.nav;
  const VehicleVector at_imu = VehicleVector::Zero();
  // The tangent plane's curvature: 5 m off the ground over 100 m is 2e-5 rad of pitch, level body.
  CHECK(near(RearAxle(estimate, at_imu, truth.omega_ib_b_radps).v_mps,
             Eigen::Vector3d(20.0, 0.0, 0.0), 1e-9));
  VehicleVector behind = at_imu;
  behind(kRearAxleX) = -1.5;
  // 0.2 rad/s times 1.5 m to the left.
  CHECK(near(RearAxle(estimate, behind, truth.omega_ib_b_radps).v_mps,
             Eigen::Vector3d(20.0, -0.3, 0.0), 1e-9));
}

}  // namespace leeway
