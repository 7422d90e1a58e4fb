#include "leeway/alternatives/reset_filter.hpp"

#include <doctest/doctest.h>

#include "leeway/model/gnss_measurement.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "tests/filters/navigator/recording.hpp"
#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::near;

struct Driven {
  ResetFilter filter;
  GnssFix fix;
  ImuIncrement last;
};

/// Ten seconds of a drive with a lever arm, and the fix at their end, not yet used.
Driven driven() {
  const sim::Trajectory trajectory = sim::car_drive({.duration_s = 20.0});
  EkfConfig config;
  config.lever_arm_b_m = {1.0, -0.5, -1.5};
  sim::GnssErrorModel gnss;
  gnss.lever_arm_b_m = config.lever_arm_b_m;
  const auto truth = sim::true_increments(trajectory, 50.0, 10.0);
  const auto log = test::record(trajectory, truth, config.imu, gnss, 1.0, 10.0, 1);
  Driven d{ResetFilter(config, test::truth_estimate(trajectory, 0.0)), log.fixes.front(),
           log.imu.back()};
  for (const ImuIncrement& inc : log.imu) d.filter.predict(inc);
  return d;
}

}  // namespace

TEST_CASE("after a fix the antenna is where the fix says, and as fast") {
  Driven d = driven();
  const Estimate before = d.filter.estimate();
  d.filter.update(d.fix);
  const Estimate& after = d.filter.estimate();
  const Eigen::Vector3d lever_arm_b_m(1.0, -0.5, -1.5);
  // Rounding of coordinates of 6e6 m.
  CHECK(near(antenna_position_e(after, lever_arm_b_m), d.fix.position->r_e_m, 5e-9));
  CHECK(near(antenna_velocity_e(after, lever_arm_b_m, d.last.dtheta_b_rad / d.last.dt_s),
             d.fix.velocity->v_e_mps, 1e-13));
  CHECK(after.nav.q_eb.coeffs() == before.nav.q_eb.coeffs());
  CHECK(after.bias.b_a_mps2 == before.bias.b_a_mps2);
  CHECK(after.bias.b_g_radps == before.bias.b_g_radps);
  CHECK((after.nav.r_e_m - before.nav.r_e_m).norm() > 0.1);  // it had drifted by then
}

TEST_CASE("what a fix does not have stays as it is") {
  Driven d = driven();
  const Estimate before = d.filter.estimate();
  d.fix.velocity.reset();
  d.filter.update(d.fix);
  CHECK(d.filter.estimate().nav.v_e_mps == before.nav.v_e_mps);
  CHECK(d.filter.estimate().nav.r_e_m != before.nav.r_e_m);
  const Estimate reset = d.filter.estimate();
  d.filter.update(GnssFix{});
  CHECK(d.filter.estimate().nav.r_e_m == reset.nav.r_e_m);
}

}  // namespace leeway
