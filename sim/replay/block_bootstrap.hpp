/// @file
/// Bands of statistics of errors that depend on their neighbours in time: the block bootstrap.
/// Source: Kuensch, The jackknife and the bootstrap for general stationary observations (1989),
/// with blocks that do not overlap, as Carlstein (1986) has them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "leeway/sim/replay/study_answer.hpp"

namespace leeway::sim {

/// A value, the block of time that it is of, and nothing else.
struct BlockValue {
  double value{};
  std::uint32_t block{};
};

/// Blocks of some logs: numbered on from one log to the next.
class Blocks {
 public:
  explicit Blocks(double length_s) : length_s_(length_s) {}

  /// Begins a log. @param from_s, to_s  the times that its values are of
  void begin(double from_s, double to_s);

  /// Of the log begun last.
  std::uint32_t block_at(double t_s) const;
  std::size_t count() const { return first_ + in_log_; }

 private:
  double length_s_;
  double from_s_{};
  std::size_t first_{0};
  std::size_t in_log_{0};
};

/// How often each block was drawn.
using BlockCounts = std::vector<std::uint32_t>;

/// The smallest of the sorted values that so great a share of the weight does not exceed, as
/// quantile_of(); NaN without weight. @param counts  empty: every block once
double quantile_of(std::span<const BlockValue> sorted, const BlockCounts& counts,
                   double probability);

/// Their root mean square.
double rms_of(std::span<const BlockValue> values, const BlockCounts& counts);

/// A statistic with its band: the 5th and the 95th percentile over resamplings. NaN bounds where
/// fewer than kFewestBlocks blocks have values, and where a resampling in twenty or more has none.
/// The same seeds each time.
Banded banded(std::size_t blocks, const std::function<double(const BlockCounts&)>& statistic);

inline constexpr std::size_t kFewestBlocks = 5;

}  // namespace leeway::sim
