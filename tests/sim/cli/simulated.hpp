/// @file
/// Simulated logs, made once for all test cases by the program itself.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "tests/sim/cli/program.hpp"

namespace leeway::test {

/// Lines of a log, to damage one of them.
inline std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

inline std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

inline std::vector<double> numbers_of(const std::string& line) {
  std::istringstream fields(line);
  std::vector<double> numbers;
  for (std::string field; std::getline(fields, field, ',');) numbers.push_back(std::stod(field));
  return numbers;
}

/// A car for 150 s, at rest for the first 30; GNSS white, 0.1 m and 0.02 m/s, so that the errors
/// of a fused solution are of that size.
struct Simulated {
  TempDir dir{};
  std::filesystem::path imu{dir / "imu.csv"};
  std::filesystem::path gnss{dir / "gnss.csv"};
  std::filesystem::path truth{dir / "truth.csv"};

  Simulated() {
    leeway("simulate --trajectory car --duration-s 150 --imu-rate-hz 100 " + imu_model() +
           " --gnss-sigma-h-m 0.1 --gnss-sigma-v-m 0.1 --gnss-sigma-velocity-mps 0.02" +
           " --gnss-correlated-sigma-m 0 --seed 1 --out " + quoted(dir / ""));
  }

  static std::string imu_model() { return "--imu-class tactical --range low"; }

  /// What fuses an IMU and a GNSS log with the model that made them.
  static std::string fuse(const std::filesystem::path& imu_log,
                          const std::filesystem::path& gnss_log) {
    return "fuse " + imu_model() + " --gnss-correlation-s 0 --imu " + quoted(imu_log) + " --gnss " +
           quoted(gnss_log);
  }
  std::string fuse() const { return fuse(imu, gnss); }
  std::string fuse_with_truth() const { return fuse() + " --truth " + quoted(truth); }
};

inline const Simulated& simulated() {
  static const Simulated logs;
  return logs;
}

/// Fixes of 0.1 m per axis (0.14 m horizontally), and an IMU that averages them: never worse.
inline constexpr double kFusedRmsM = 0.15;

}  // namespace leeway::test
