#include <doctest/doctest.h>

#include <cmath>

#include "leeway/earth/earth.hpp"
#include "tests/support/near.hpp"
#include "tests/support/reference_vectors.hpp"

namespace leeway {

TEST_CASE("normal gravity is the exact normal gravity of gravity.csv, both components") {
  const auto table = test::read_reference_gravity();
  if (table.empty()) {
    MESSAGE("skipped: no gravity.csv under " LEEWAY_SHARED_DIR);
    return;
  }
  for (const test::ReferenceGravity& row : table) {
    CAPTURE(row.position.lat_rad / kRadPerDeg);
    CAPTURE(row.position.height_m);
    const Eigen::Vector3d g_n = ned_to_ecef(row.position).transpose() *
                                gravity_e<GravityModel::kNormal>(ecef_from_geodetic(row.position));
    // m/s^2: 1.5e-14 is 8 ulp of 9.8; the table's north has 7 digits, 5e-7 of itself.
    CHECK(test::near(g_n.x(), row.north_mps2, 1.5e-14 + 5e-7 * std::abs(row.north_mps2)));
    CHECK(test::near(g_n.y(), 0.0, 1.5e-14));
    CHECK(test::near(g_n.z(), row.down_mps2, 1.5e-14));
  }
}

}  // namespace leeway
