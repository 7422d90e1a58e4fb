#include <cmath>
#include <leeway/earth/earth.hpp>

int main() {
  const double x_m = leeway::ecef_from_geodetic({0.0, 0.0, 0.0}).x();
  return std::abs(x_m - leeway::wgs84::kSemiMajorAxisM) < 1e-6 ? 0 : 1;
}
