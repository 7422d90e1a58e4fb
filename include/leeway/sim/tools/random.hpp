/// @file
/// Counter-based random numbers. A number is a function of (seed, trial, stream, index) alone, so a
/// trial is the same on one thread or on many machines, in any order.
/// Source: Salmon et al., Parallel Random Numbers: As Easy as 1, 2, 3 (SC 2011); Philox4x32-10.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace leeway::sim {

/// The bijection Philox4x32-10 of the counter under the key.
std::array<std::uint32_t, 4> philox4x32_10(const std::array<std::uint32_t, 4>& counter,
                                           const std::array<std::uint32_t, 2>& key);

/// Uses of the streams of one trial. Further uses are numbered from kFirstFreeStream.
enum RandomStream : std::uint32_t {
  kImuStream,
  kGnssStream,
  kInitialStateStream,
  kOutlierStream,
  kFirstFreeStream
};

/// One stream of random numbers, without repetition within 2^64 draws. Uniform numbers are the same
/// on every machine; normal ones are the same up to the rounding of the C library's log.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint32_t trial = 0, std::uint32_t stream = 0)
      : seed_(seed), trial_(trial), stream_(stream) {}

  /// A uniform number in the open interval (0, 1), on a grid of 2^-52 offset by half a step.
  double uniform();

  /// A normal number of mean 0 and variance 1, with tails to 8.5 sigma. Source: Box and Muller;
  /// both numbers of a pair are used.
  double normal();

  /// Three independent normal numbers.
  Eigen::Vector3d normal3();

 private:
  std::uint64_t seed_;
  std::uint32_t trial_;
  std::uint32_t stream_;
  std::uint64_t block_{0};
  double spare_uniform_{0.0};  // 0: none, as no uniform number is 0
  double spare_normal_{0.0};
  bool has_spare_normal_{false};
};

}  // namespace leeway::sim
