#include "leeway/sim/tools/random.hpp"

#include <Random123/philox.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace leeway::sim {
namespace {

constexpr std::uint32_t low_word(std::uint64_t x) { return static_cast<std::uint32_t>(x); }
constexpr std::uint32_t high_word(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); }

// The upper 52 bits and a half step: every value and 1 - value is a double, none is 0 or 1.
double unit_interval(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (std::uint64_t{high} << 32 | low) >> 12;
  return (static_cast<double>(bits) + 0.5) * 0x1p-52;
}

struct CosSin {
  double cos;
  double sin;
};

/// Of a whole turn times u, 0 <= u <= 1: error below 3e-16. Quarter turns are taken off exactly,
/// the Taylor series of what is left, at most pi / 4, end below 1e-17; no branch depends on u.
CosSin cos_sin_of_turn(double u) {
  const auto quarters = static_cast<std::size_t>(4.0 * u + 0.5);
  const double x = 2.0 * std::numbers::pi * (u - 0.25 * static_cast<double>(quarters));
  const double x_sq = x * x;
  double c = 1.0;
  double s = 1.0;
  for (const double n : {16.0, 14.0, 12.0, 10.0, 8.0, 6.0, 4.0, 2.0}) {
    c = 1.0 - 1.0 / (n * (n - 1.0)) * x_sq * c;
    s = 1.0 - 1.0 / (n * (n + 1.0)) * x_sq * s;
  }
  s *= x;
  const std::array<double, 4> turned{c, -s, -c, s};
  return {turned[quarters % 4], turned[(quarters + 3) % 4]};
}

}  // namespace

std::array<std::uint32_t, 4> philox4x32_10(const std::array<std::uint32_t, 4>& counter,
                                           const std::array<std::uint32_t, 2>& key) {
  const r123::Philox4x32::ctr_type c{{counter[0], counter[1], counter[2], counter[3]}};
  const r123::Philox4x32::key_type k{{key[0], key[1]}};
  const r123::Philox4x32::ctr_type words = r123::Philox4x32{}(c, k);
  return {words[0], words[1], words[2], words[3]};
}

double Random::uniform() {
  if (spare_uniform_ != 0.0) return std::exchange(spare_uniform_, 0.0);
  const auto words = philox4x32_10({low_word(block_), high_word(block_), trial_, stream_},
                                   {low_word(seed_), high_word(seed_)});
  ++block_;
  spare_uniform_ = unit_interval(words[2], words[3]);
  return unit_interval(words[0], words[1]);
}

double Random::normal() {
  if (std::exchange(has_spare_normal_, false)) return spare_normal_;
  const double radius = std::sqrt(-2.0 * std::log(uniform()));
  const CosSin direction = cos_sin_of_turn(uniform());
  spare_normal_ = radius * direction.sin;
  has_spare_normal_ = true;
  return radius * direction.cos;
}

Eigen::Vector3d Random::normal3() {
  const double x = normal();
  const double y = normal();
  return {x, y, normal()};
}

}  // namespace leeway::sim
