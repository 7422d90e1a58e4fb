#include "leeway/monitors/receiver_noise.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "leeway/sim/tools/random.hpp"
#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::near;

/// A covariance with correlations: 2.5, 2.5 and 3.5 m in turned axes.
Eigen::Matrix3d claimed() {
  Eigen::Matrix3d A;
  A << 2.0, 1.0, 0.5, -1.0, 2.0, 1.0, 0.5, 0.7, 3.0;
  return A * A.transpose();
}

/// Innovations of a filter that knows better than its receiver: noise of `truth` times the claim
/// and an offset. The NIS is by the claim as scaled at the time.
struct Receiver {
  double truth{1.0};
  Eigen::Vector3d offset{Eigen::Vector3d::Zero()};
  double interval_s{0.5};

  template <class F>
  ReceiverNoise run(double smallest, std::uint64_t seed, int fixes, F&& each) const {
    sim::Random random(seed);
    const Eigen::Matrix3d R = claimed();
    const Eigen::LLT<Eigen::Matrix3d> llt(R);
    ReceiverNoise scale(smallest, false);
    for (int k = 0; k < fixes; ++k) {
      const Eigen::Vector3d z =
          Eigen::Matrix3d(llt.matrixL()) * (truth * random.normal3()) + offset;
      const double nis = z.dot(llt.solve(z)) / (scale.sigma_scale() * scale.sigma_scale());
      scale.note(time_from_seconds(interval_s * k), z, R, nis, true);
      each(scale);
    }
    return scale;
  }
  ReceiverNoise run(double smallest, std::uint64_t seed, int fixes) const {
    return run(smallest, seed, fixes, [](const ReceiverNoise&) {});
  }
};

}  // namespace

TEST_CASE("before any fix the claim stands") {
  const ReceiverNoise scale(0.5, false);
  CHECK(scale.sigma_scale() == 1.0);
  CHECK(scale.nis_ratio() == 1.0);
}

TEST_CASE("an honest receiver is left alone over 10000 fixes") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    double least = 1.0;
    double most = 1.0;
    double ratio_sum = 0.0;
    Receiver{}.run(0.5, seed, 10'000, [&](const ReceiverNoise& scale) {
      least = std::min(least, scale.sigma_scale());
      most = std::max(most, scale.sigma_scale());
      ratio_sum += scale.nis_ratio();
    });
    // The mean over 30 fixes leaves the band now and then, for a few fixes: steps of 1 %.
    CHECK(least > 0.9);
    CHECK(most < 1.1);
    // 30000 chi-squared numbers of variance 2: 0.8 %, and as much again for the windows.
    CHECK(near(ratio_sum / 10'000.0, 1.0, 0.05));
  }
}

TEST_CASE("a sigma claimed three times too small is found, as far as the band around 1 allows") {
  double mean = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    double sum = 0.0;
    int count = 0;
    Receiver{.truth = 3.0}.run(1.0, seed, 2000, [&](const ReceiverNoise& scale) {
      if (++count > 1000) sum += scale.sigma_scale();
    });
    CAPTURE(sum / 1000.0);
    // Where it stops is somewhere in the band: the mean of squares 1.6 times too large or 0.5.
    CHECK(sum / 1000.0 > 3.0 / std::sqrt(1.6));
    CHECK(sum / 1000.0 < 3.0 / std::sqrt(0.5));
    mean += 0.1 * sum / 1000.0;
  }
  MESSAGE("mean over ten receivers: " << mean);
  CHECK(near(mean, 3.0, 0.5));
}

TEST_CASE("a modest claim is scaled down as far as allowed, no further") {
  CHECK(near(Receiver{.truth = 0.2}.run(0.5, 1, 3000).sigma_scale(), 0.5, 1e-12));
  CHECK(Receiver{.truth = 0.2}.run(1.0, 1, 3000).sigma_scale() == 1.0);
}

TEST_CASE("the first fixes of an honest receiver are not called inconsistent, those far off are") {
  // 2026-11-28: one fix in nine has a NIS above twice its expectation, and the health said so.
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    CAPTURE(seed);
    Receiver{}.run(1.0, seed, 40,
                   [](const ReceiverNoise& scale) { CHECK_FALSE(scale.is_inconsistent()); });
    const Receiver far_off{.offset = Eigen::Vector3d::Constant(30.0)};
    const ReceiverNoise after = far_off.run(1.0, seed, 5, [](const ReceiverNoise&) {});
    CHECK(after.is_inconsistent());
  }
}

TEST_CASE("what lasts is not noise: an offset of ten sigma changes no scale, but shows") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    const Receiver receiver{.offset = {25.0, -25.0, 35.0}};
    double most = 1.0;
    const ReceiverNoise scale = receiver.run(
        0.5, seed, 3000, [&](const ReceiverNoise& s) { most = std::max(most, s.sigma_scale()); });
    CHECK(most < 1.1);
    CHECK(scale.nis_ratio() > 10.0);
  }
}

TEST_CASE("no more than a thousandfold, whatever comes; a single outlier moves nothing") {
  CHECK(Receiver{.truth = 1e4}.run(0.5, 1, 5000).sigma_scale() <= 1000.0);
  CHECK(Receiver{.truth = 1e4}.run(0.5, 1, 5000).sigma_scale() > 9.9);
  ReceiverNoise scale = Receiver{}.run(0.5, 1, 100);
  const double before = scale.sigma_scale();
  scale.note(time_from_seconds(50.0), {1e6, 0.0, 0.0}, claimed(), 1e12, true);
  CHECK(near(scale.sigma_scale(), before, 0.02));  // one step at most
}

TEST_CASE("fixes further apart than 2 s say nothing: the filter's own error changes too") {
  const ReceiverNoise scale = Receiver{.truth = 5.0, .interval_s = 3.0}.run(0.5, 1, 3000);
  CHECK(scale.sigma_scale() == 1.0);
  CHECK(scale.nis_ratio() > 10.0);
}

}  // namespace leeway
