#include <array>
#include <bitset>
#include <cmath>
#include <string>

#include "leeway/earth/units.hpp"
#include "lib/logs/layouts/imu_layouts.hpp"
#include "lib/logs/layouts/sample_joiner.hpp"
#include "lib/logs/messages/little_endian.hpp"
#include "lib/logs/messages/sensor_clock.hpp"
#include "lib/logs/messages/ubx.hpp"
#include "lib/logs/messages/ubx_time.hpp"

namespace leeway {
namespace {

constexpr std::size_t kEpochPvtBytes = 84;
constexpr double kEsfRadps = kRadPerDeg / 4096.0;
constexpr double kEsfMps2 = 1.0 / 1024.0;

/// Three numbers that come one by one under one time.
struct EsfVector {
  Eigen::Vector3d value{Eigen::Vector3d::Zero()};
  std::bitset<3> has{};

  void set(std::size_t axis, double number) {
    value[static_cast<Eigen::Index>(axis)] = number;
    has.set(axis);
  }
};

/// A measurement: its type above 24 bits, and in these a signed number.
struct EsfItem {
  std::uint32_t type{};
  std::int32_t value{};

  explicit EsfItem(std::uint32_t word)
      : type(word >> 24 & 0x3F), value(static_cast<std::int32_t>(word << 8) >> 8) {}
};

/// Calls visit(count, item) for each measurement of an ESF-RAW or ESF-MEAS.
template <class Visit>
void for_each_item(UbxKind kind, std::string_view payload, const Visit& visit) {
  const auto word = [&](std::size_t at) { return number_at<std::uint32_t>(payload, at); };
  if (kind == UbxKind::kEsfRaw) {
    for (std::size_t at = 4; at + 8 <= payload.size(); at += 8) {
      visit(word(at + 4), EsfItem(word(at)));
    }
  } else if (kind == UbxKind::kEsfMeas && payload.size() >= 8) {
    constexpr int kHasCalibratedTime = 8;
    const bool is_calibrated = (number_at<std::uint16_t>(payload, 4) & kHasCalibratedTime) != 0;
    const std::size_t end = is_calibrated ? payload.size() - 4 : payload.size();
    const std::uint32_t count = is_calibrated && end >= 8 ? word(end) : word(0);
    for (std::size_t at = 8; at + 4 <= end; at += 4) visit(count, EsfItem(word(at)));
  }
}

/// What tells one clock from another: how much of it passes in what the receiver calls a second.
struct EsfClock {
  UbxKind kind{UbxKind::kEsfMeas};
  double count_s{1e-3};
  bool has_epochs{false};
};

constexpr std::array kEsfCountsS{1.0, 1e-3, 1.0 / 25600.0, 1e-6};

/// The time that a count must be for as many of them to pass between two epochs.
double esf_count_s(double epochs_s, std::int64_t counts) {
  double best = kEsfCountsS[1];
  if (!(epochs_s > 0.0) || counts <= 0) return best;
  const auto off = [&](double count_s) {
    return std::abs(std::log(count_s * static_cast<double>(counts) / epochs_s));
  };
  for (const double count_s : kEsfCountsS) best = off(count_s) < off(best) ? count_s : best;
  return best;
}

/// What the head of a log shows.
EsfClock esf_clock_of(const LogOpening& log) {
  EsfClock clock;
  if (has_ubx_kind(log, UbxKind::kEsfRaw)) clock.kind = UbxKind::kEsfRaw;
  clock.has_epochs = has_ubx_kind(log, UbxKind::kNavPvt);
  CountUnroller unroller;
  std::optional<std::int64_t> newest, first_count;
  std::int64_t last_count = 0, first_ms = 0, last_ms = 0;
  std::string_view bytes = log.head.bytes;
  while (!bytes.empty()) {
    const MessageFrame frame = ubx_frame(bytes, true);
    if (frame.kind == MessageFrame::Kind::kMessage) {
      const UbxKind kind = ubx_kind(bytes);
      const std::string_view payload = ubx_payload(bytes.substr(0, frame.size));
      if (kind == clock.kind) {
        for_each_item(kind, payload,
                      [&](std::uint32_t count, EsfItem) { newest = unroller.unroll(count); });
      } else if (kind == UbxKind::kNavPvt && payload.size() >= kEpochPvtBytes && newest) {
        last_ms = number_at<std::uint32_t>(payload, 0);
        last_count = *newest;
        if (!first_count) first_ms = last_ms;
        if (!first_count) first_count = newest;
      }
    }
    bytes.remove_prefix(frame.size);
  }
  clock.count_s = clock.kind == UbxKind::kEsfRaw ? 1.0 / 25600.0 : 1e-3;
  const auto passed_ms = static_cast<double>(last_ms - first_ms);
  if (first_count && passed_ms > 0) {
    clock.count_s = esf_count_s(1e-3 * passed_ms, last_count - *first_count);
  }
  return clock;
}

/// Rates and specific forces, put on the receiver's time line by its epochs.
class UbxImuParser {
 public:
  UbxImuParser(UbxWeek week, const EsfClock& clock) : week_(std::move(week)), esf_(clock) {}

  std::optional<Fault> operator()(std::string_view message, ImuRow& row) {
    if (message.empty()) return has_items_ ? kNoRow : kNoItems;
    if (!std::exchange(has_more_, false)) take(ubx_kind(message), ubx_payload(message));
    while (samples_.has_next()) {
      row = samples_.next();
      const auto time = esf_.has_epochs ? clock_.gps_time_of(row.time) : row.time;
      if (!time) continue;
      row.time = *time;
      has_more_ = samples_.has_next();
      return has_more_ ? std::optional(kRowAndMore) : std::nullopt;
    }
    return kNoRow;
  }

 private:
  static constexpr Fault kNoItems{LineDamage::kMissingField,
                                  "ESF-RAW or ESF-MEAS of the IMU, one of which must be recorded"};

  void take(UbxKind kind, std::string_view payload) {
    week_.learn(kind, payload);
    if (kind == UbxKind::kNavPvt && payload.size() >= kEpochPvtBytes) {
      const auto epoch = week_.time_of_pvt(payload);
      if (epoch && has_items_) clock_.learn(*epoch, newest_);
    }
    if (kind != esf_.kind) return;
    for_each_item(kind, payload, [&](std::uint32_t count, EsfItem item) { add(count, item); });
    if (kind == UbxKind::kEsfMeas) rate_ = force_ = EsfVector{};
  }

  void add(std::uint32_t count, EsfItem item) {
    if (count != count_) {
      rate_ = force_ = EsfVector{};
      count_ = count;
      const auto counts = static_cast<double>(counts_.unroll(count));
      newest_ = Time{Duration{std::llround(counts * (esf_.count_s * 1e9))}};
    }
    switch (item.type) {
      case 5:
        return add_rate(2, item.value);
      case 13:
        return add_rate(1, item.value);
      case 14:
        return add_rate(0, item.value);
      case 16:
      case 17:
      case 18:
        return add_force(item.type - 16, item.value);
      default:
        return;
    }
  }

  void add_rate(std::size_t axis, std::int32_t value) {
    has_items_ = true;
    rate_.set(axis, kEsfRadps * value);
    if (rate_.has.all()) samples_.add_rate(newest_, rate_.value);
  }

  void add_force(std::size_t axis, std::int32_t value) {
    has_items_ = true;
    force_.set(axis, kEsfMps2 * value);
    if (force_.has.all()) samples_.add_force(newest_, force_.value);
  }

  UbxWeek week_;
  EsfClock esf_;
  CountUnroller counts_{};
  SensorClock clock_{};
  SampleJoiner samples_{};
  EsfVector rate_{}, force_{};
  std::optional<std::uint32_t> count_{};
  Time newest_{};  // by the sensor's clock
  bool has_items_{false};
  bool has_more_{false};
};

RowParser<ImuRow> ubx_imu_parser(LogOpening& log) {
  log.framing = ubx_frame;
  const EsfClock clock = esf_clock_of(log);
  if (!clock.has_epochs) {
    log.notes.push_back(
        "no NAV-PVT tells the time: times are those of the sensor's clock, from its start");
    return UbxImuParser{UbxWeek{}, clock};
  }
  log.notes.push_back(
      "times of the IMU are told by the order in which messages came, and are early by some 0.05 s:"
      " say --estimate-clock, or --position-lag-s and --velocity-lag-s");
  return UbxImuParser{UbxWeek(log), clock};
}

}  // namespace

ImuLayout imu_ubx() {
  return {"u-blox UBX", "u-blox UBX with ESF-RAW or ESF-MEAS", is_ubx, ubx_imu_parser, true};
}

}  // namespace leeway
