#include <cmath>
#include <cstdint>
#include <utility>

#include "lib/logs/layouts/gnss_layouts.hpp"
#include "lib/logs/layouts/receiver_fix.hpp"
#include "lib/logs/messages/little_endian.hpp"
#include "lib/logs/messages/ubx.hpp"
#include "lib/logs/messages/ubx_time.hpp"

namespace leeway {
namespace {

constexpr std::size_t kFixPvtBytes = 84;  // of the oldest version
constexpr std::size_t kHpPosLlhBytes = 36;

/// Where the receiver is, in the numbers of a message.
struct UbxPlace {
  double lon_deg{}, lat_deg{}, height_m{};
  double horizontal_m{}, vertical_m{};  ///< accuracies: of two axes together, and of one
};

struct UbxVelocity {
  Eigen::Vector3d v_n_mps{};
  double accuracy_mps{};  ///< of three axes together
};

/// What the messages of one time of week say.
struct UbxEpoch {
  std::uint32_t time_of_week_ms{};
  std::optional<Time> time{};
  bool is_refused{false};  ///< by the receiver's own flags
  std::optional<UbxPlace> place{};
  std::optional<UbxPlace> precise_place{};
  std::optional<UbxVelocity> velocity{};
};

/// Three dimensions, with satellites: a height that is held, and dead reckoning, are no fix.
bool is_fix_of_ubx(std::string_view pvt) {
  const auto type = number_at<std::uint8_t>(pvt, 20);
  const bool is_ok = (number_at<std::uint8_t>(pvt, 21) & 1) != 0;
  const bool is_place_invalid = (number_at<std::uint8_t>(pvt, 78) & 1) != 0;
  return is_ok && !is_place_invalid && (type == 3 || type == 4);
}

UbxPlace place_of_pvt(std::string_view pvt) {
  return {number_at<std::int32_t>(pvt, 24) * 1e-7, number_at<std::int32_t>(pvt, 28) * 1e-7,
          number_at<std::int32_t>(pvt, 32) * 1e-3, number_at<std::uint32_t>(pvt, 40) * 1e-3,
          number_at<std::uint32_t>(pvt, 44) * 1e-3};
}

UbxVelocity velocity_of_pvt(std::string_view pvt) {
  const Eigen::Vector3d v_n_mmps(number_at<std::int32_t>(pvt, 48), number_at<std::int32_t>(pvt, 52),
                                 number_at<std::int32_t>(pvt, 56));
  return {1e-3 * v_n_mmps, number_at<std::uint32_t>(pvt, 68) * 1e-3};
}

UbxPlace place_of_hpposllh(std::string_view p) {
  return {number_at<std::int32_t>(p, 8) * 1e-7 + number_at<std::int8_t>(p, 24) * 1e-9,
          number_at<std::int32_t>(p, 12) * 1e-7 + number_at<std::int8_t>(p, 25) * 1e-9,
          number_at<std::int32_t>(p, 16) * 1e-3 + number_at<std::int8_t>(p, 26) * 1e-4,
          number_at<std::uint32_t>(p, 28) * 1e-4, number_at<std::uint32_t>(p, 32) * 1e-4};
}

/// Messages put together by their time of week.
class UbxFixParser {
 public:
  explicit UbxFixParser(UbxWeek week) : week_(std::move(week)) {}

  std::optional<Fault> operator()(std::string_view message, GnssFix& fix) {
    if (message.empty()) return has_places_ ? finish(fix) : kNoPlaces;
    const UbxKind kind = ubx_kind(message);
    const std::string_view payload = ubx_payload(message);
    week_.learn(kind, payload);
    const bool is_pvt = kind == UbxKind::kNavPvt && payload.size() >= kFixPvtBytes;
    const bool is_precise = kind == UbxKind::kNavHpPosLlh && payload.size() >= kHpPosLlhBytes;
    if (!is_pvt && !is_precise) return kNoRow;
    has_places_ = true;
    const auto time_of_week_ms = number_at<std::uint32_t>(payload, is_pvt ? 0 : 4);
    std::optional<Fault> outcome = kNoRow;
    if (time_of_week_ms != epoch_.time_of_week_ms) {
      outcome = finish(fix);
      epoch_.time_of_week_ms = time_of_week_ms;
    }
    if (is_pvt) take_pvt(payload);
    if (is_precise) take_precise(payload);
    return outcome;
  }

 private:
  void take_pvt(std::string_view pvt) {
    epoch_.time = week_.time_of_pvt(pvt);
    epoch_.is_refused = !is_fix_of_ubx(pvt);
    epoch_.place = place_of_pvt(pvt);
    epoch_.velocity = velocity_of_pvt(pvt);
  }

  void take_precise(std::string_view position) {
    if (!epoch_.time) epoch_.time = week_.time_of(epoch_.time_of_week_ms);
    const bool is_invalid = (number_at<std::uint8_t>(position, 3) & 1) != 0;
    if (!is_invalid) epoch_.precise_place = place_of_hpposllh(position);
  }

  /// The fix of the epoch, where it has one.
  std::optional<Fault> finish(GnssFix& fix) {
    const UbxEpoch epoch = std::exchange(epoch_, {});
    const auto told = epoch.precise_place ? epoch.precise_place : epoch.place;
    if (!told || !epoch.time || epoch.is_refused) return kNoRow;
    if (std::abs(told->lat_deg) > 90.0) return Fault{LineDamage::kOutOfRange, "latitude"};
    if (std::abs(told->lon_deg) > 360.0) return Fault{LineDamage::kOutOfRange, "longitude"};
    const Geodetic place{told->lat_deg * kRadPerDeg, told->lon_deg * kRadPerDeg, told->height_m};
    std::optional<Eigen::Vector3d> v_n_mps;
    if (epoch.velocity) v_n_mps = epoch.velocity->v_n_mps;
    fix = receiver_fix(*epoch.time, place, v_n_mps,
                       {told->horizontal_m, told->vertical_m,
                        epoch.velocity ? epoch.velocity->accuracy_mps : 0.0});
    return std::nullopt;
  }

  static constexpr Fault kNoPlaces{LineDamage::kMissingField,
                                   "NAV-PVT or NAV-HPPOSLLH, one of which must be recorded"};

  UbxWeek week_;
  UbxEpoch epoch_{};
  bool has_places_{false};
};

RowParser<GnssFix> ubx_fix_parser(LogOpening& log) {
  log.framing = ubx_frame;
  return UbxFixParser{UbxWeek(log)};
}

}  // namespace

GnssLayout gnss_ubx() {
  return {"u-blox UBX", "u-blox UBX with NAV-PVT or NAV-HPPOSLLH", is_ubx, ubx_fix_parser, true};
}

}  // namespace leeway
