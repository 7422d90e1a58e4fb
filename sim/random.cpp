#include "leeway/sim/random.hpp"

#include <Random123/philox.h>

#include <cmath>
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
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_normal_ = radius * std::sin(angle);
  has_spare_normal_ = true;
  return radius * std::cos(angle);
}

Eigen::Vector3d Random::normal3() {
  const double x = normal();
  const double y = normal();
  return {x, y, normal()};
}

}  // namespace leeway::sim
