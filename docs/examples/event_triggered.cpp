// Uses a GNSS fix only when the filter needs it: asks once a second how long it can go without, and
// takes the next fix when that is less than the interval of fixes and a second. LIMIT_M:
// horizontal, 95 %. ROLL PITCH YAW: the mount, deg (docs/conventions.md).
#include <algorithm>
#include <cstdio>
#include <leeway/earth/error.hpp>
#include <leeway/logs/gnss_log.hpp>
#include <leeway/logs/imu_log.hpp>
#include <leeway/logs/truth_log.hpp>
#include <leeway/navigator/navigator.hpp>
#include <string>
#include <vector>

namespace {
void print(const leeway::Solution& end, std::vector<double>& errors_m, double limit_m) {
  const auto place = leeway::ned_from_nav_state(end.nav).position;
  std::printf("end: %.7f %.7f deg, sigma north %.2f m, east %.2f m\n",
              place.lat_rad / leeway::kRadPerDeg, place.lon_rad / leeway::kRadPerDeg,
              end.sigma_position_n_m.x(), end.sigma_position_n_m.y());
  if (errors_m.empty()) return;
  std::sort(errors_m.begin(), errors_m.end());
  const auto n = errors_m.size();
  const auto beyond = errors_m.end() - std::upper_bound(errors_m.begin(), errors_m.end(), limit_m);
  std::printf("error: median %.2f m, 95 %% %.2f m, largest %.2f m, %td of %zu s beyond %.1f m\n",
              errors_m[n / 2], errors_m[n * 95 / 100], errors_m[n - 1], beyond, n, limit_m);
}

void run(int argc, char** argv) {
  const double limit_m = std::stod(argv[3]);
  leeway::ImuLogOptions mount;
  if (argc == 8) {
    const auto angle = [argv](int i) { return std::stod(argv[i]) * leeway::kRadPerDeg; };
    mount.C_bs = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal() *
                 leeway::rotation_from_euler({angle(5), angle(6), angle(7)});
  }
  leeway::ImuLogReader imu(argv[1], mount);
  leeway::GnssLogReader gnss(argv[2]);
  std::optional<leeway::TruthTrack> truth;
  if (argc > 4) truth.emplace(leeway::TruthLogReader(argv[4]));
  leeway::Navigator navigator{leeway::NavigatorConfig{}};  // the defaults suit a car
  leeway::Time ask{}, last_fix{};
  bool wanted = true;
  int available = 0, used = 0;
  std::vector<double> errors_m;
  for (auto fix = gnss.next(); const auto increment = imu.next();) {
    for (; fix && fix->time <= increment->time; fix = gnss.next()) {
      if (!navigator.aligned() || wanted) navigator.push(*fix);
      available += navigator.aligned();
      used += navigator.aligned() && wanted;
      wanted = !navigator.aligned();
      last_fix = fix->time;
    }
    navigator.push(*increment);
    if (!navigator.aligned() || increment->time < ask) continue;
    ask = increment->time + std::chrono::seconds(1);
    const double interval_s = fix ? leeway::to_seconds(fix->time - last_fix) : 0.0;
    wanted = navigator.leeway(limit_m, 0.95).time_s < interval_s + 1.0;
    const auto row = truth ? truth->interpolate(increment->time) : std::nullopt;
    if (!row) continue;
    const auto place = row->nav.position;
    const auto error_e_m = leeway::ecef_from_geodetic(place) - navigator.solution().nav.r_e_m;
    errors_m.push_back((leeway::ned_to_ecef(place).transpose() * error_e_m).head<2>().norm());
  }
  if (!navigator.aligned()) throw leeway::Error("the log never shows where the vehicle is heading");
  std::printf("used %d of %d fixes\n", used, available);
  print(navigator.solution(), errors_m, limit_m);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4 && argc != 5 && argc != 8) {
    throw leeway::Error("usage: event_triggered IMU GNSS LIMIT_M [TRUTH [ROLL PITCH YAW]]");
  }
  run(argc, argv);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
