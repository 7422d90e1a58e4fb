#include "tests/support/reference_vectors.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

namespace leeway::test {
namespace {

const std::filesystem::path kFolder =
    std::filesystem::path(LEEWAY_SHARED_DIR) / "reference" / "vectors";

/// Rows of numbers after the header; plain or gzip.
std::vector<std::vector<double>> read_numbers(const std::filesystem::path& path) {
  std::vector<std::vector<double>> rows;
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) return rows;
  std::array<char, 1024> line{};
  gzgets(file.get(), line.data(), static_cast<int>(line.size()));
  while (gzgets(file.get(), line.data(), static_cast<int>(line.size())) != nullptr) {
    std::vector<double>& row = rows.emplace_back();
    char* at = line.data();
    do {
      row.push_back(std::strtod(at, &at));
    } while (*at++ == ',');
  }
  return rows;
}

std::vector<ImuIncrement> read_increments(const std::filesystem::path& path) {
  std::vector<ImuIncrement> increments;
  Time last{};
  for (const std::vector<double>& row : read_numbers(path)) {
    const Time time = time_from_seconds(row.at(0));
    increments.push_back({time,
                          to_seconds(time - last),
                          {row.at(1), row.at(2), row.at(3)},
                          {row.at(4), row.at(5), row.at(6)}});
    last = time;
  }
  return increments;
}

std::vector<ReachableError> read_reachable(const std::filesystem::path& path) {
  std::vector<ReachableError> table;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.size() < 2 || line[0] != '|' || std::isdigit(line[1]) == 0) continue;
    std::replace(line.begin(), line.end(), '|', ' ');
    std::istringstream cells(line);
    ReachableError row;
    cells >> row.rate_hz >> row.scheme >> row.error.position_m >> row.error.velocity_mps >>
        row.error.attitude_rad;
    if (cells) table.push_back(row);
  }
  return table;
}

}  // namespace

std::vector<std::string> reference_vector_names() {
  std::vector<std::string> names;
  if (!std::filesystem::is_directory(kFolder)) return names;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    if (entry.is_directory()) names.push_back(entry.path().filename());
  }
  std::sort(names.begin(), names.end());
  return names;
}

ReferenceVector read_reference_vector(const std::string& name) {
  ReferenceVector vector;
  vector.name = name;
  vector.imu_400hz = read_increments(kFolder / name / "imu.csv.gz");
  vector.imu_100hz = read_increments(kFolder / name / "imu_100.csv.gz");
  vector.reachable = read_reachable(kFolder / name / "README.md");
  for (const std::vector<double>& row : read_numbers(kFolder / name / "truth.csv.gz")) {
    const Time time = time_from_seconds(row.at(0));
    vector.truth.push_back({time,
                            Eigen::Quaterniond(row.at(7), row.at(8), row.at(9), row.at(10)),
                            {row.at(4), row.at(5), row.at(6)},
                            {row.at(1), row.at(2), row.at(3)}});
    vector.samples.push_back(
        {time, {row.at(14), row.at(15), row.at(16)}, {row.at(11), row.at(12), row.at(13)}});
  }
  return vector;
}

std::vector<ReferenceGravity> read_reference_gravity() {
  std::vector<ReferenceGravity> table;
  for (const std::vector<double>& row : read_numbers(kFolder / "gravity.csv")) {
    table.push_back({{row.at(0) * kRadPerDeg, 0.0, row.at(1)}, row.at(3), row.at(4)});
  }
  return table;
}

}  // namespace leeway::test
