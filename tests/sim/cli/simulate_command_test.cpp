#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "tests/sim/cli/simulated.hpp"
#include "tests/support/near.hpp"

namespace leeway::test {
namespace {

TEST_CASE("simulate writes every trajectory as three logs and a description") {
  for (const char* trajectory : {"static", "straight", "circle", "square-loop", "car"}) {
    CAPTURE(trajectory);
    const TempDir dir;
    const Outcome outcome =
        leeway(std::string("simulate --trajectory ") + trajectory +
               " --duration-s 20 --imu-rate-hz 50 --gnss-interval-s 2 --truth-rate-hz 10 --out " +
               quoted(dir / "made"));
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.err.empty());
    CHECK(lines_of(dir / "made/imu.csv").size() == 1 + 1000);
    CHECK(lines_of(dir / "made/gnss.csv").size() == 1 + 10);
    CHECK(lines_of(dir / "made/truth.csv").size() == 1 + 201);
    CHECK(nlohmann::json::parse(read_file(dir / "made/scene.json")).at("trajectory") == trajectory);
    CHECK(std::distance(std::filesystem::directory_iterator(dir / "made"), {}) == 4);
  }
}

TEST_CASE("simulate at rest: the increments are gravity and the Earth's turning") {
  const TempDir dir;
  // Range and noise of a marine IMU are far below the tolerances.
  leeway("simulate --trajectory static --duration-s 10 --imu-class marine --out " +
         quoted(dir / ""));
  const std::vector<std::string> lines = lines_of(dir / "imu.csv");
  double dv_down_mps = 0.0;
  double turn_sq = 0.0;
  std::array<double, 3> turn_rad{};
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const std::vector<double> row = numbers_of(lines[k]);
    dv_down_mps += row[7];
    for (std::size_t i = 0; i < 3; ++i) turn_rad[i] += row[2 + i];
  }
  for (const double angle : turn_rad) turn_sq += angle * angle;
  // Normal gravity at 45 deg is 9.8062 at height 0, 3e-4 less at 100 m; a bias of 1e-4 m/s^2 at 4
  // sigma and noise of 10 ug/sqrt(Hz) over 10 s add 7e-3 m/s in 10 s.
  CHECK(near(dv_down_mps, -98.059, 7e-3));
  // 10 s of 7.292115e-5 rad/s; angle random walk 0.001 deg/sqrt(h) over 10 s: 9e-7 rad, 4 sigma.
  CHECK(near(std::sqrt(turn_sq), 7.292115e-4, 4e-6));
}

TEST_CASE("simulate: a seed is a log, byte by byte, and another seed is another") {
  const TempDir dir;
  const auto make = [&dir](const char* seed, const char* folder) {
    leeway(std::string("simulate --trajectory circle --duration-s 5 --seed ") + seed + " --out " +
           quoted(dir / folder));
  };
  make("1", "a");
  make("1", "b");
  make("2", "c");
  for (const char* log : {"imu.csv", "gnss.csv", "truth.csv"}) {
    CAPTURE(log);
    CHECK(read_file(dir / "a" / log) == read_file(dir / "b" / log));
  }
  CHECK(read_file(dir / "a/imu.csv") != read_file(dir / "c/imu.csv"));
  CHECK(read_file(dir / "a/gnss.csv") != read_file(dir / "c/gnss.csv"));
  CHECK(read_file(dir / "a/truth.csv") == read_file(dir / "c/truth.csv"));
}

TEST_CASE("simulate --json names what it made") {
  const TempDir dir;
  const auto object = leeway("simulate --trajectory straight --duration-s 4 --gzip --json --out " +
                             quoted(dir / ""))
                          .json();
  CHECK(object.at("command") == "simulate");
  CHECK(object.at("input").at("duration_s") == 4.0);
  CHECK(object.at("results").at("imu_increments") == 800);
  CHECK(object.at("results").at("gnss_fixes") == 4);
  for (const char* log : {"imu", "gnss", "truth"}) {
    const std::string path = object.at("results").at(log);
    CAPTURE(path);
    CHECK(path.ends_with(".csv.gz"));
    CHECK(std::filesystem::file_size(path) > 0);
  }
}

TEST_CASE("simulate: GNSS errors are of the size asked for") {
  const TempDir dir;
  leeway(
      "simulate --trajectory static --duration-s 400 --imu-rate-hz 1 --gnss-sigma-h-m 2 "
      "--gnss-correlated-sigma-m 0 --lever 3,0,0 --out " +
      quoted(dir / ""));
  const std::vector<std::string> lines = lines_of(dir / "gnss.csv");
  const std::vector<double> truth = numbers_of(lines_of(dir / "truth.csv")[1]);
  constexpr double kMetresPerDegree = 111132.0;  // of latitude at 45 deg, to 1e-4
  double mean_m = 0.0;
  double square_m2 = 0.0;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const double north_m = (numbers_of(lines[k])[1] - truth[1]) * kMetresPerDegree;
    mean_m += north_m / 400.0;
    square_m2 += north_m * north_m / 400.0;
  }
  // The antenna is 3 m ahead, to the north. 400 fixes: mean to 0.1 m, sigma to 3.5 %; 4 sigma.
  CHECK(near(mean_m, 3.0, 0.4));
  CHECK(near(std::sqrt(square_m2 - mean_m * mean_m), 2.0, 0.28));
}

}  // namespace
}  // namespace leeway::test
