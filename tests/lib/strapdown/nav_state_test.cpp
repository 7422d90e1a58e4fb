#include "leeway/strapdown/nav_state.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/near.hpp"

namespace leeway {

using test::near;

TEST_CASE("level, heading north, moving east at the equator and the zero meridian") {
  NavStateNed ned;
  ned.time = time_from_seconds(12.5);
  ned.v_n_mps = {0.0, 20.0, 0.0};
  const NavState state = nav_state_from_ned(ned);
  CHECK(state.time == ned.time);
  CHECK(near(state.r_e_m, Eigen::Vector3d(6378137.0, 0.0, 0.0), 2e-9));
  CHECK(near(state.v_e_mps, Eigen::Vector3d(0.0, 20.0, 0.0), 4e-15));
  // Forward is north, which is e_z; right is east, e_y; down is -e_x.
  Eigen::Matrix3d C_eb;
  C_eb << 0.0, 0.0, -1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0;
  CHECK(near(state.q_eb.toRotationMatrix(), C_eb, 4e-16));
}

TEST_CASE("north-east-down and Earth-fixed states convert into each other") {
  for (const double lat_deg : {-89.0, -33.3, 0.0, 56.0, 89.9}) {
    for (const double lon_deg : {-179.9999999, -37.6, 0.0, 92.8, 180.0}) {
      CAPTURE(lat_deg);
      CAPTURE(lon_deg);
      NavStateNed in;
      in.time = time_from_seconds(1e5);
      in.position = {lat_deg * kRadPerDeg, lon_deg * kRadPerDeg, 150.0};
      in.v_n_mps = {-3.0, 20.0, 0.5};
      in.attitude = {0.1, -0.2, 4.0};
      const NavState state = nav_state_from_ned(in);
      CHECK(near(state.q_eb.norm(), 1.0, 2.3e-16));
      const NavStateNed out = ned_from_nav_state(state);
      // m: the position's rounding in ECEF, there and back; longitude weighs by cos(lat).
      const double radius_m = 6.4e6;
      const double cos_lat = std::cos(in.position.lat_rad);
      const double lon_error_rad = wrap_pi(out.position.lon_rad - in.position.lon_rad);
      CHECK(out.time == in.time);
      CHECK(near(out.position.lat_rad * radius_m, in.position.lat_rad * radius_m, 5e-9));
      CHECK(near(lon_error_rad * radius_m * cos_lat, 0.0, 5e-9));
      CHECK(near(out.position.height_m, in.position.height_m, 5e-9));
      // The frame is known to the position's rounding over the distance to the axis.
      const double frame_rad = 5e-9 / (radius_m * cos_lat) + 2e-15;
      CHECK(near(out.v_n_mps, in.v_n_mps, 21.0 * frame_rad));
      CHECK(near(out.attitude.roll_rad, in.attitude.roll_rad, frame_rad));
      CHECK(near(out.attitude.pitch_rad, in.attitude.pitch_rad, frame_rad));
      CHECK(near(out.attitude.yaw_rad, in.attitude.yaw_rad, frame_rad));
    }
  }
}

}  // namespace leeway
