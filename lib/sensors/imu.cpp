#include "leeway/sensors/imu.hpp"

namespace leeway {

ImuIncrement increment_between(const ImuSample& from, const ImuSample& to, RateMeaning meaning) {
  ImuIncrement inc;
  inc.time = to.time;
  inc.dt_s = to_seconds(to.time - from.time);
  switch (meaning) {
    case RateMeaning::kMean:
      inc.dtheta_b_rad = inc.dt_s * to.omega_ib_b_radps;
      inc.dv_b_mps = inc.dt_s * to.f_ib_b_mps2;
      break;
    case RateMeaning::kPoint:
      inc.dtheta_b_rad = 0.5 * inc.dt_s * (from.omega_ib_b_radps + to.omega_ib_b_radps);
      inc.dv_b_mps = 0.5 * inc.dt_s * (from.f_ib_b_mps2 + to.f_ib_b_mps2);
      break;
    case RateMeaning::kPointHeld:
      inc.dtheta_b_rad = inc.dt_s * from.omega_ib_b_radps;
      inc.dv_b_mps = inc.dt_s * from.f_ib_b_mps2;
      break;
  }
  return inc;
}

void append(ImuIncrement& sum, const ImuIncrement& later) {
  sum.time = later.time;
  sum.dt_s += later.dt_s;
  sum.dtheta_b_rad += later.dtheta_b_rad;
  sum.dv_b_mps += later.dv_b_mps;
}

std::pair<ImuIncrement, ImuIncrement> split(const ImuIncrement& inc, Time t) {
  const double after_s = to_seconds(inc.time - t);
  const double before_fraction = (inc.dt_s - after_s) / inc.dt_s;
  ImuIncrement before = inc;
  before.time = t;
  before.dt_s = inc.dt_s - after_s;
  before.dtheta_b_rad = before_fraction * inc.dtheta_b_rad;
  before.dv_b_mps = before_fraction * inc.dv_b_mps;
  ImuIncrement after = inc;
  after.dt_s = after_s;
  after.dtheta_b_rad = inc.dtheta_b_rad - before.dtheta_b_rad;
  after.dv_b_mps = inc.dv_b_mps - before.dv_b_mps;
  return {before, after};
}

}  // namespace leeway
