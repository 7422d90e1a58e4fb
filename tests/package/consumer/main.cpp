// Uses each component through its installed header and checks one value of each.
#include <cmath>
#include <cstdio>
#include <leeway/earth/earth.hpp>
#include <leeway/navigator/navigator.hpp>

int main() {
  const leeway::Geodetic position{0.0, 0.0, 0.0};
  const double x_m = leeway::ecef_from_geodetic(position).x();
  std::printf("equator at %.3f m\n", x_m);
  if (!(std::abs(x_m - leeway::wgs84::kSemiMajorAxisM) < 1e-6)) return 1;

  leeway::Navigator navigator{leeway::NavigatorConfig{}};
  leeway::ImuIncrement increment;
  increment.dt_s = 0.01;
  increment.dv_b_mps.z() = -0.098;
  const leeway::Verdict verdict = navigator.push(increment);
  std::printf("navigator says %s\n", name(verdict).data());
  return verdict == leeway::Verdict::kAligning ? 0 : 1;
}
