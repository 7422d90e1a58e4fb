#include "leeway/sim/scene/error_limit.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <vector>

#include "leeway/earth/error.hpp"
#include "sim/tools/closest_name.hpp"

namespace leeway::sim {
namespace {

constexpr double kNauticalMileM = 1852.0;

constexpr std::string_view kRnp =
    "ICAO Doc 9613 (PBN manual): lateral total system error in NM within which a flight is for 95 "
    "% "
    "of its time; the navigation's part alone is counted here, steering adds to it";
constexpr std::string_view kImo =
    "IMO MSC.1/Circ.1575 (2017), appendix C: operational accuracy level of the horizontal "
    "position, "
    "95 %";
constexpr std::string_view kEtcs =
    "UNISIG SUBSET-041, 5.3.1.1: every distance s measured on board within 5 m + 5 % of s; it "
    "states "
    "no probability, 95 % is taken here";

const std::array kPresets{LimitPreset{"rnp-0.3", ErrorMetric::kCross95, 0.3 * kNauticalMileM, kRnp},
                          LimitPreset{"rnp-1", ErrorMetric::kCross95, 1.0 * kNauticalMileM, kRnp},
                          LimitPreset{"rnp-2", ErrorMetric::kCross95, 2.0 * kNauticalMileM, kRnp},
                          LimitPreset{"rnp-4", ErrorMetric::kCross95, 4.0 * kNauticalMileM, kRnp},
                          LimitPreset{"rnp-10", ErrorMetric::kCross95, 10.0 * kNauticalMileM, kRnp},
                          LimitPreset{"imo-a", ErrorMetric::kR95, 100.0, kImo},
                          LimitPreset{"imo-b", ErrorMetric::kR95, 10.0, kImo},
                          LimitPreset{"imo-c", ErrorMetric::kR95, 1.0, kImo},
                          LimitPreset{"imo-d", ErrorMetric::kR95, 0.1, kImo},
                          LimitPreset{"etcs-odometry", ErrorMetric::kAlong95, {5.0, 0.05}, kEtcs}};

/// Text that is read from its front.
class LimitText {
 public:
  explicit LimitText(std::string_view text) : rest_(text) {}

  std::optional<double> number() {
    skip_spaces();
    double value = 0.0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc{}) return {};
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }

  bool take(char wanted) {
    skip_spaces();
    if (!rest_.starts_with(wanted)) return false;
    rest_.remove_prefix(1);
    return true;
  }

  bool at_end() {
    skip_spaces();
    return rest_.empty();
  }

 private:
  void skip_spaces() {
    while (rest_.starts_with(' ')) rest_.remove_prefix(1);
  }

  std::string_view rest_;
};

/// Nothing unless the text has the form of a limit.
std::optional<AllowedError> parsed(LimitText text) {
  const std::optional<double> metres = text.number();
  if (!metres) return {};
  AllowedError allowed(*metres);
  const bool has_unit = text.take('m');
  if (has_unit && text.take('+')) {
    const std::optional<double> percent = text.number();
    if (!percent || !text.take('%')) return {};
    allowed.share = 0.01 * *percent;
  }
  if (!text.at_end()) return {};
  return allowed;
}

}  // namespace

std::string text_of(const AllowedError& allowed) {
  const std::string metres = fmt::format("{:.9g}m", allowed.limit_m);
  return allowed.share == 0.0 ? metres : fmt::format("{}+{:.9g}%", metres, 100.0 * allowed.share);
}

AllowedError allowed_error(std::string_view text) {
  const std::optional<AllowedError> allowed = parsed(LimitText(text));
  if (!allowed) {
    throw Error(
        fmt::format("'{}' is no limit: write metres, as in 5 or 5m, or metres and a share of the "
                    "distance since the last fix, as in 5m+5%",
                    text));
  }
  if (!kLimitM.contains(allowed->limit_m)) {
    throw Error(fmt::format("'{}': a limit of {:.9g} m must be {} m", text, allowed->limit_m,
                            kLimitM.text()));
  }
  if (!kLimitShare.contains(allowed->share)) {
    throw Error(fmt::format("'{}': a share of {:.9g} % must be 0 or 0.0001 to 100 %", text,
                            100.0 * allowed->share));
  }
  return *allowed;
}

std::span<const LimitPreset> limit_presets() { return kPresets; }

const LimitPreset& limit_preset(std::string_view name) {
  const auto found = std::find_if(kPresets.begin(), kPresets.end(), [name](const LimitPreset& p) {
    return is_same_name(p.name, name);
  });
  if (found != kPresets.end()) return *found;
  std::vector<std::string_view> names;
  for (const LimitPreset& preset : kPresets) names.push_back(preset.name);
  throw Error(fmt::format("'{}' is no preset of a limit: {}", name, did_you_mean(name, names)));
}

void apply_preset(ErrorLimit& limit, std::string_view name) {
  const LimitPreset& preset = limit_preset(name);
  limit.metric = preset.metric;
  limit.allow(preset.allowed);
  limit.preset = preset.name;
}

}  // namespace leeway::sim
