#include "sim/atlas/faults/fault.hpp"

#include <cmath>
#include <utility>

#include "leeway/earth/earth.hpp"

namespace leeway::sim {

Damage on_fixes(std::function<void(GnssFix&, double since_s)> f) {
  return [f = std::move(f)](FaultInputs& inputs, const FaultWindow& window) {
    for_each_in(inputs.fixes, window, f);
  };
}

Damage on_imu(std::function<void(ImuIncrement&, double since_s)> f) {
  return [f = std::move(f)](FaultInputs& inputs, const FaultWindow& window) {
    for_each_in(inputs.imu, window, f);
  };
}

Eigen::Matrix3d ned_to_ecef_at(const GnssFix& fix) {
  return ned_to_ecef(geodetic_from_ecef(fix.position->r_e_m));
}

bool is_every(int n, double since_s) { return static_cast<int>(std::floor(since_s)) % n == 0; }

const std::vector<Fault>& faults() {
  static const std::vector<Fault> kFaults = [] {
    std::vector<Fault> all;
    for (const auto& group :
         {receiver_faults(), noise_faults(), imu_faults(), time_faults(), start_faults()}) {
      all.insert(all.end(), group.begin(), group.end());
    }
    return all;
  }();
  return kFaults;
}

}  // namespace leeway::sim
