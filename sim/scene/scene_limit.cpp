#include "sim/scene/scene_sections.hpp"
#include "sim/scene/scene_units.hpp"

namespace leeway::sim {
namespace {

constexpr Quantity kLast{"last", kTimes, between(1.0, kLongestSceneS)};
constexpr Quantity kLimit{"limit", kLengths, kLimitM};

void read_allowed(TomlSection& section, ErrorLimit& limit) {
  const auto text = section.text("limit");
  const auto metres = section.value(kLimit);
  if (text && metres) {
    metres->fail_at_key("and limit are the same quantity: give one");
  }
  if (metres) limit.limit_m = metres->number();
  if (!text) return;
  usable(section, "limit", [&] { limit.allow(allowed_error(*text)); });
}

}  // namespace

ErrorLimit read_limit(TomlSection& section) {
  ErrorLimit limit;
  set(section, kLast, limit.last_s);
  const auto preset = section.text("preset");
  const auto metric = section.choice<ErrorMetric>("metric");
  limit.metric = metric.value_or(limit.metric);
  read_allowed(section, limit);
  if (!preset) return limit;
  if (metric || section.has("limit") || section.has("limit_m") || section.has("limit_cm") ||
      section.has("limit_km")) {
    section.fail_at("preset", "says metric and limit itself: give it alone, or these two");
  }
  usable(section, "preset", [&] { apply_preset(limit, *preset); });
  return limit;
}

}  // namespace leeway::sim
