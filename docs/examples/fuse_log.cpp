// Fuses a recorded IMU and GNSS log into a navigation solution, through the library alone.
// usage: fuse_log IMU GNSS SOLUTION.csv
#include <cstdio>
#include <leeway/earth/error.hpp>
#include <leeway/logs/gnss_log.hpp>
#include <leeway/logs/imu_log.hpp>
#include <leeway/logs/solution_writer.hpp>
#include <leeway/navigator/navigator.hpp>

namespace {

void fuse(const char* imu_path, const char* gnss_path, const char* solution_path) {
  // The axes of these sensors are forward-left-up; the library's body axes are forward-right-down.
  leeway::ImuLogOptions mount;
  mount.C_bs = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  leeway::ImuLogReader imu(imu_path, mount);
  leeway::GnssLogReader gnss(gnss_path);
  leeway::SolutionWriter writer(solution_path);

  leeway::Navigator navigator{leeway::NavigatorConfig{}};  // the defaults suit a car
  auto fix = gnss.next();
  int samples = 0;
  while (const auto increment = imu.next()) {
    // A fix goes in before the IMU data that reaches past it, and acts at its own time.
    for (; fix && fix->time <= increment->time; fix = gnss.next()) navigator.push(*fix);
    navigator.push(*increment);
    if (navigator.aligned() && ++samples % 10 == 0) writer.write(navigator.solution());
  }
  writer.close();

  for (const auto verdict : {leeway::Verdict::kFused, leeway::Verdict::kGated}) {
    std::printf("%s: %llu fixes\n", leeway::name(verdict).data(),
                static_cast<unsigned long long>(navigator.count(verdict)));
  }
  for (const auto* report : {&imu.summary(), &gnss.summary()}) {
    for (const auto& message : report->messages) std::fprintf(stderr, "%s\n", message.c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: %s IMU GNSS SOLUTION.csv\n", argv[0]);
    return 1;
  }
  try {
    fuse(argv[1], argv[2], argv[3]);
  } catch (const leeway::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
