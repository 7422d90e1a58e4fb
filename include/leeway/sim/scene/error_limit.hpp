/// @file
/// The error that a scene allows: by which metric, how much, and by whose standard.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "leeway/earth/fields.hpp"
#include "leeway/model/error_metric.hpp"

namespace leeway::sim {

/// A length that an error may have, and a share of the distance gone since the last fix on top of
/// it.
struct AllowedError {
  double limit_m{10.0};
  double share{0.0};  ///< of the length of the path since the last fix

  AllowedError() = default;
  /// From a number of metres too: most limits do not grow.
  AllowedError(double metres,  // NOLINT(google-explicit-constructor)
               double share_of_distance = 0.0)
      : limit_m(metres), share(share_of_distance) {}

  double after_m(double distance_m) const { return limit_m + share * distance_m; }
  bool operator==(const AllowedError&) const = default;
};

/// Ranges of what a limit may be.
inline constexpr Range kLimitM = between(1e-2, 1e5);
inline constexpr Range kLimitShare = zero_or(1e-6, 1.0);

/// "5m", "5m+5%".
std::string text_of(const AllowedError& allowed);

/// An allowed error from text: "5", "5m", "5 m", "5m+5%", "5 m + 5 %".
/// @throws Error unless it is one, and within kLimitM and kLimitShare.
AllowedError allowed_error(std::string_view text);

/// The largest error allowed just before a fix is used.
struct ErrorLimit {
  ErrorMetric metric{ErrorMetric::kDrms};
  double limit_m{10.0};
  double share{0.0};     ///< of the distance since the last fix, added
  std::string preset{};  ///< whose metric and limit these are; empty: nobody's
  /// Fixes this close to the end of the scene count, as scored_part_s(); where the scene has a time
  /// to settle all after it do.
  double last_s{480.0};

  AllowedError allowed() const { return {limit_m, share}; }
  void allow(const AllowedError& error) { limit_m = error.limit_m, share = error.share; }

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"metric", c.metric}, Field{"limit_m", c.limit_m, positive_to(1e6)},
                   Field{"share", c.share, between(0.0, 1.0)}, Field{"preset", c.preset},
                   Field{"last_s", c.last_s, positive_to(1e6)});
  }
};

/// A limit that a published document states.
struct LimitPreset {
  std::string_view name{};
  ErrorMetric metric{};
  AllowedError allowed{};
  std::string_view source{};  ///< document, place in it, and what is read into it
};

/// All presets. docs/guide/scenes.md lists them.
std::span<const LimitPreset> limit_presets();

/// A preset by its name. @throws Error that lists the names when there is none.
const LimitPreset& limit_preset(std::string_view name);

/// Sets metric and limit to a preset's. @throws Error as limit_preset().
void apply_preset(ErrorLimit& limit, std::string_view name);

}  // namespace leeway::sim
