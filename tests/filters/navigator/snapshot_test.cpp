#include "leeway/navigator/snapshot.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "leeway/navigator/navigator.hpp"
#include "tests/filters/navigator/car.hpp"
#include "tests/filters/navigator/same_bits.hpp"
#include "tests/support/changed.hpp"

namespace leeway {
namespace {

using test::bytes_of;
using test::same_bits;

NavigatorConfig seeking_mount() {
  NavigatorConfig config;
  config.C_bs.reset();
  config.vehicle = VehicleConfig::car();
  config.vehicle.rear_axle_x_m = 0.0;
  return config;
}

const test::CarLog& log() {
  static const test::CarLog log = test::drive({}, 1);
  return log;
}

/// From one time to another: fixes 0.7 s late, odometer and height on time.
void drive_on(Navigator& navigator, double from_s, double to_s) {
  const Time from = time_from_seconds(from_s);
  const auto first_after = [&](const auto& messages, double late_s) {
    std::size_t k = 0;
    while (k < messages.size() && to_seconds(messages[k].time) + late_s <= from_s) ++k;
    return k;
  };
  constexpr double kLatencyS = 0.7;
  std::size_t fix = first_after(log().fixes, kLatencyS);
  std::size_t speed = first_after(log().odometer, 0.0);
  std::size_t height = first_after(log().height, 0.0);
  for (const ImuIncrement& inc : log().imu) {
    if (inc.time <= from) continue;
    if (inc.time > time_from_seconds(to_s)) break;
    const auto push = [&](const auto& messages, std::size_t& next, double late_s) {
      const Time due = inc.time - duration_from_seconds(late_s);
      for (; next < messages.size() && messages[next].time <= due; ++next) {
        navigator.push(messages[next]);
      }
    };
    push(log().fixes, fix, kLatencyS);
    push(log().odometer, speed, 0.0);
    push(log().height, height, 0.0);
    navigator.push(inc);
  }
}

bool same_everything(const Navigator& a, const Navigator& b) { return bytes_of(a) == bytes_of(b); }

Restore restore(Navigator& navigator, std::span<const std::byte> bytes) {
  return navigator.restore(bytes);
}

}  // namespace

TEST_CASE("a restored navigator goes on bit by bit as the one it was taken from" *
          doctest::test_suite("heavy")) {
  // While it aligns, while headings are open, before and after the mount is known, in motion. The
  // times are amid an epoch, with fixes on their way.
  Navigator original(seeking_mount());
  double now_s = 0.0;
  for (const double at_s : {0.0, 0.31, 1.11, 16.3, 20.3, 40.3, 100.3}) {
    CAPTURE(at_s);
    drive_on(original, now_s, at_s);
    now_s = at_s;
    const std::vector<std::byte> bytes = bytes_of(original);
    CHECK(bytes.size() == Navigator(seeking_mount()).snapshot_size());
    Navigator restored(seeking_mount());
    CHECK(restore(restored, bytes) == Restore::kRestored);
    CHECK(restored.aligned() == original.aligned());
    CHECK(same_bits(restored, original));
    CHECK(same_everything(restored, original));
    Navigator other = original;
    const double span_s = at_s == 100.3 ? 60.0 : 10.0;
    drive_on(restored, at_s, at_s + span_s);
    drive_on(other, at_s, at_s + span_s);
    CHECK(same_bits(restored, other));
    CHECK(same_everything(restored, other));
    for (std::size_t v = 0; v < kVerdicts; ++v) {
      CHECK(restored.count(static_cast<Verdict>(v)) == other.count(static_cast<Verdict>(v)));
    }
    CHECK(restored.health().state == other.health().state);
  }
  CHECK(original.C_bs().has_value());
  CHECK(original.count(Verdict::kFused) > 100);
}

TEST_CASE("a navigator that is restored forgets what it was" * doctest::test_suite("heavy")) {
  Navigator original(seeking_mount());
  drive_on(original, 0.0, 20.3);
  Navigator used(seeking_mount());
  drive_on(used, 0.0, 60.0);
  CHECK(restore(used, bytes_of(original)) == Restore::kRestored);
  CHECK(same_everything(used, original));
  drive_on(used, 20.3, 30.0);
  drive_on(original, 20.3, 30.0);
  CHECK(same_everything(used, original));
}

TEST_CASE("a flipped bit anywhere is refused, and nothing has changed") {
  Navigator original(seeking_mount());
  drive_on(original, 0.0, 25.3);
  const std::vector<std::byte> good = bytes_of(original);
  Navigator navigator(seeking_mount());
  drive_on(navigator, 0.0, 5.0);
  const std::vector<std::byte> before = bytes_of(navigator);
  std::vector<std::byte> bytes = good;
  int refused = 0;
  int tried = 0;
  const auto flip = [&](std::size_t bit) {
    const std::byte mask{static_cast<unsigned char>(1u << (bit % 8))};
    bytes[bit / 8] ^= mask;
    const Restore outcome = restore(navigator, bytes);
    bytes[bit / 8] ^= mask;
    ++tried;
    refused += outcome != Restore::kRestored;
    return outcome;
  };
  constexpr std::size_t kHeaderBits = 28 * 8;
  for (std::size_t bit = 0; bit < kHeaderBits; ++bit) {
    CAPTURE(bit);
    const Restore expected = bit < 64    ? Restore::kNotASnapshot
                             : bit < 96  ? Restore::kOtherVersion
                             : bit < 128 ? Restore::kDamaged  // the configuration's fingerprint
                             : bit < 192 ? Restore::kWrongSize
                                         : Restore::kDamaged;
    CHECK(flip(bit) == expected);
  }
  sim::Random random(1);
  const std::size_t body_bits = 8 * good.size() - kHeaderBits;
  for (int k = 0; k < 2000; ++k) {
    const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(body_bits));
    const Restore outcome = flip(kHeaderBits + at);
    if (outcome != Restore::kDamaged) CHECK(outcome == Restore::kDamaged);
  }
  CHECK(refused == tried);
  CHECK(bytes_of(navigator) == before);
  CHECK(bytes == good);
  CHECK(restore(navigator, bytes) == Restore::kRestored);
}

TEST_CASE("cut off, too long, empty, and other bytes are refused") {
  Navigator original(seeking_mount());
  drive_on(original, 0.0, 2.3);
  const std::vector<std::byte> good = bytes_of(original);
  Navigator navigator(seeking_mount());
  const std::vector<std::byte> before = bytes_of(navigator);
  CHECK(restore(navigator, {}) == Restore::kNotASnapshot);
  CHECK(restore(navigator, std::span(good).first(27)) == Restore::kNotASnapshot);
  for (const std::size_t size : {std::size_t{28}, good.size() / 2, good.size() - 1}) {
    CHECK(restore(navigator, std::span(good).first(size)) == Restore::kWrongSize);
  }
  std::vector<std::byte> longer = good;
  longer.push_back(std::byte{0});
  CHECK(restore(navigator, longer) == Restore::kWrongSize);
  const std::vector<std::byte> zeros(good.size());
  CHECK(restore(navigator, zeros) == Restore::kNotASnapshot);
  CHECK(bytes_of(navigator) == before);
}

TEST_CASE("of another configuration: refused whatever the field that differs") {
  const auto refuses = [](const NavigatorConfig& config, std::span<const std::byte> bytes) {
    Navigator navigator(config);
    const std::vector<std::byte> before = bytes_of(navigator);
    CHECK(restore(navigator, bytes) == Restore::kOtherConfiguration);
    CHECK(bytes_of(navigator) == before);
  };
  const NavigatorConfig config;
  const std::vector<std::byte> bytes = bytes_of(Navigator(config));
  int fields = 0;
  test::for_each_changed(config, test::ToAnother{},
                         [&](const std::string& field, const auto& other) {
                           CAPTURE(field);
                           refuses(other, bytes);
                           ++fields;
                         });
  CHECK(fields > 70);
  NavigatorConfig without_mount;
  without_mount.C_bs.reset();
  refuses(without_mount, bytes);
}

}  // namespace leeway
