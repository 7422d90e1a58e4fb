#include "lib/logs/messages/ubx_time.hpp"

#include <chrono>

#include "lib/earth/calendar.hpp"
#include "lib/logs/messages/little_endian.hpp"

namespace leeway {
namespace {

constexpr Duration kUbxWeek = std::chrono::weeks{1};
constexpr std::size_t kPvtBytes = 84;  // of the oldest version
constexpr std::size_t kTimeGpsBytes = 16;

/// Since the epoch of GPS, UTC; nothing where the receiver does not know it.
std::optional<Duration> utc_of_pvt(std::string_view pvt) {
  constexpr int kDateAndTime = 3;
  if ((number_at<std::uint8_t>(pvt, 11) & kDateAndTime) != kDateAndTime) return std::nullopt;
  const auto day =
      day_since_gps_epoch(number_at<std::uint16_t>(pvt, 4), number_at<std::uint8_t>(pvt, 6),
                          number_at<std::uint8_t>(pvt, 7));
  if (!day) return std::nullopt;
  return *day + std::chrono::hours{number_at<std::uint8_t>(pvt, 8)} +
         std::chrono::minutes{number_at<std::uint8_t>(pvt, 9)} +
         std::chrono::seconds{number_at<std::uint8_t>(pvt, 10)} +
         Duration{number_at<std::int32_t>(pvt, 16)};
}

}  // namespace

bool has_ubx_kind(const LogOpening& log, UbxKind kind) {
  std::string_view bytes = log.head.bytes;
  while (!bytes.empty()) {
    const MessageFrame frame = ubx_frame(bytes, true);
    if (frame.kind == MessageFrame::Kind::kMessage && ubx_kind(bytes) == kind) return true;
    bytes.remove_prefix(frame.size);
  }
  return false;
}

UbxWeek::UbxWeek(LogOpening& log)
    : has_week_(has_ubx_kind(log, UbxKind::kNavPvt) || has_ubx_kind(log, UbxKind::kNavTimeGps)) {
  if (has_week_) return;
  log.notes.emplace_back("no NAV-PVT or NAV-TIMEGPS tells the week: times are those of the week");
}

void UbxWeek::learn(UbxKind kind, std::string_view payload) {
  if (kind == UbxKind::kNavPvt && payload.size() >= kPvtBytes) {
    const auto utc = utc_of_pvt(payload);
    if (!utc) return;
    newest_ms_ = number_at<std::uint32_t>(payload, 0);
    const Duration gps = *utc + gps_minus_utc(*utc);
    // The leap seconds are those of the time of week: only the week is taken from the date.
    week_start_ =
        (gps - std::chrono::milliseconds{newest_ms_} + kUbxWeek / 2) / kUbxWeek * kUbxWeek;
  } else if (kind == UbxKind::kNavTimeGps && payload.size() >= kTimeGpsBytes) {
    constexpr int kWeekIsValid = 2;
    const int week = number_at<std::int16_t>(payload, 8);
    const bool is_valid = (number_at<std::uint8_t>(payload, 11) & kWeekIsValid) != 0;
    if (!is_valid || week < 0 || week > kLastGpsWeek) return;
    newest_ms_ = number_at<std::uint32_t>(payload, 0);
    week_start_ = std::chrono::weeks{week};
  }
}

std::optional<Time> UbxWeek::time_of(std::uint32_t time_of_week_ms) {
  const Time in_week{std::chrono::milliseconds{time_of_week_ms}};
  if (in_week.time_since_epoch() > kUbxWeek) return std::nullopt;
  if (!has_week_) return unroller_.unroll(in_week);
  if (!week_start_) return std::nullopt;
  const Duration ahead = std::chrono::milliseconds{newest_ms_} - in_week.time_since_epoch();
  const Duration next = ahead > kUbxWeek / 2 ? kUbxWeek : Duration{0};
  const Duration last = ahead < -kUbxWeek / 2 ? kUbxWeek : Duration{0};
  return in_week + *week_start_ + next - last;
}

std::optional<Time> UbxWeek::time_of_pvt(std::string_view payload) {
  using std::chrono::round;
  const auto time = time_of(number_at<std::uint32_t>(payload, 0));
  const auto utc = utc_of_pvt(payload);
  if (!time || !utc) return time;
  // GPS time and UTC differ by whole seconds.
  const Duration fraction = *utc - time->time_since_epoch();
  return *time + (fraction - round<std::chrono::seconds>(fraction));
}

}  // namespace leeway
