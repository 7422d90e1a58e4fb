/// @file
/// The reference vectors of ../shared/reference: strapdown test vectors with the errors that simple
/// consumers reach, and exact normal gravity. What is absent comes back empty.
#pragma once

#include <string>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/sensors/imu.hpp"
#include "leeway/strapdown/nav_state.hpp"

namespace leeway::test {

/// Largest norms over a run.
struct StrapdownError {
  double position_m{};
  double velocity_mps{};
  double attitude_rad{};
};

/// A row of the table in a vector's README.
struct ReachableError {
  int rate_hz{};
  std::string scheme;
  StrapdownError error{};
};

struct ReferenceVector {
  std::string name;
  std::vector<ImuIncrement> imu_400hz;
  std::vector<ImuIncrement> imu_100hz;
  std::vector<NavState> truth;     ///< at 400 Hz, from t = 0
  std::vector<ImuSample> samples;  ///< point samples at the times of the truth
  std::vector<ReachableError> reachable;
};

/// Names of the vector folders present, sorted.
std::vector<std::string> reference_vector_names();

ReferenceVector read_reference_vector(const std::string& name);

/// A row of gravity.csv: exact normal gravity in the geodetic north and down directions.
struct ReferenceGravity {
  Geodetic position{};
  double north_mps2{};
  double down_mps2{};
};

std::vector<ReferenceGravity> read_reference_gravity();

}  // namespace leeway::test
