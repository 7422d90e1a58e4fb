#include "sim/replay/block_bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "leeway/sim/tools/quantile.hpp"
#include "leeway/sim/tools/random.hpp"

namespace leeway::sim {
namespace {

constexpr double kNoQuantile = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t kResamplings = 200;
constexpr double kTail = 0.05;

double weight_of(const BlockValue& value, const BlockCounts& counts) {
  return counts.empty() ? 1.0 : counts[value.block];
}

}  // namespace

void Blocks::begin(double from_s, double to_s) {
  first_ += in_log_;
  from_s_ = from_s;
  in_log_ = static_cast<std::size_t>(std::max(std::round((to_s - from_s) / length_s_), 1.0));
}

std::uint32_t Blocks::block_at(double t_s) const {
  const double at = std::max((t_s - from_s_) / length_s_, 0.0);
  return static_cast<std::uint32_t>(first_ + std::min(static_cast<std::size_t>(at), in_log_ - 1));
}

double quantile_of(std::span<const BlockValue> sorted, const BlockCounts& counts,
                   double probability) {
  double all = 0.0;
  for (const BlockValue& v : sorted) all += weight_of(v, counts);
  const double rank = std::max(std::ceil(probability * all), 1.0);
  double sum = 0.0;
  for (const BlockValue& v : sorted) {
    sum += weight_of(v, counts);
    if (sum >= rank) return v.value;
  }
  return kNoQuantile;
}

double rms_of(std::span<const BlockValue> values, const BlockCounts& counts) {
  double all = 0.0;
  double sum = 0.0;
  for (const BlockValue& v : values) {
    all += weight_of(v, counts);
    sum += weight_of(v, counts) * v.value * v.value;
  }
  return std::sqrt(sum / all);
}

Banded banded(std::size_t blocks, const std::function<double(const BlockCounts&)>& statistic) {
  Banded answer{.value = statistic({})};
  if (blocks < kFewestBlocks) return answer;
  std::vector<double> all;
  for (std::uint32_t k = 0; k < kResamplings; ++k) {
    Random random(1, k);
    BlockCounts counts(blocks, 0);
    for (std::size_t draw = 0; draw < blocks; ++draw) {
      ++counts[static_cast<std::size_t>(random.uniform() * static_cast<double>(blocks))];
    }
    const double value = statistic(counts);
    if (!std::isnan(value)) all.push_back(value);
  }
  if (static_cast<double>(all.size()) <= (1.0 - kTail) * kResamplings) return answer;
  answer.low = quantile_of(all, kTail);
  answer.high = quantile_of(all, 1.0 - kTail);
  return answer;
}

}  // namespace leeway::sim
