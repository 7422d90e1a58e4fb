#include "lib/logs/column_names.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/earth/units.hpp"
#include "lib/logs/text_fields.hpp"

namespace leeway {
namespace {

enum class Dimension { kTime, kAngularRate, kAcceleration, kAngle, kLength, kSpeed };

/// A column of ours, and what loggers call it; "?" stands for one of the axes.
struct Quantity {
  std::string_view column;
  std::string_view axes;
  Dimension dimension;
  std::string_view aliases;
  bool is_common{false};  ///< a common name: with another unit it is another thing
};
constexpr std::array kQuantities{
    Quantity{"t_s", "", Dimension::kTime,
             "t time timestamp time_stamp stamp gps_time gpstime tow sow seconds_of_week "
             "seconds_elapsed timestamp_sample"},
    Quantity{"g?_radps", "xyz", Dimension::kAngularRate,
             "g? w? gyro_? gyro? gyr_? gyr? gyroscope_? omega_? angular_velocity_? angular_rate_? "
             "rotation_rate_?"},
    Quantity{"a?_mps2", "xyz", Dimension::kAcceleration,
             "a? f? acc_? acc? accel_? accel? accelerometer_? acceleration_? specific_force_? "
             "total_acceleration_?"},
    Quantity{"lat_deg", "", Dimension::kAngle, "lat latitude"},
    Quantity{"lon_deg", "", Dimension::kAngle, "lon lng long longitude"},
    Quantity{"height_m", "", Dimension::kLength, "height hgt ellipsoidal_height"},
    Quantity{"pos_std_?_m", "ned", Dimension::kLength, "pos_std_? pos_sigma_? position_std_?"},
    Quantity{"v?_mps", "ned", Dimension::kSpeed, "v? v_? vel_? velocity_?"},
    Quantity{"vel_std_?_mps", "ned", Dimension::kSpeed, "vel_std_? vel_sigma_? velocity_std_?"},
    Quantity{"speed_mps", "", Dimension::kSpeed,
             "speed ground_speed wheel_speed vehicle_speed odometer_speed velocity", true},
    Quantity{"heading_deg", "", Dimension::kAngle, "heading"},
    Quantity{"heading_sigma_deg", "", Dimension::kAngle, "heading_sigma heading_std"},
    Quantity{"horizontal_accuracy_m", "", Dimension::kLength,
             "horizontal_accuracy horizontalaccuracy", true},
    Quantity{"vertical_accuracy_m", "", Dimension::kLength, "vertical_accuracy verticalaccuracy",
             true},
    Quantity{"course_deg", "", Dimension::kAngle, "course bearing direction", true},
    Quantity{"speed_accuracy_mps", "", Dimension::kSpeed, "speed_accuracy speedaccuracy", true},
    Quantity{"course_accuracy_deg", "", Dimension::kAngle,
             "course_accuracy bearing_accuracy bearingaccuracy", true}};

struct Unit {
  Dimension dimension;
  double scale;
  std::string_view names;
};
constexpr std::array kUnits{
    Unit{Dimension::kTime, 1.0, "s sec secs seconds"},
    Unit{Dimension::kTime, 1e-3, "ms msec milliseconds"},
    Unit{Dimension::kTime, 1e-6, "us usec \xC2\xB5s \xCE\xBCs microseconds"},
    Unit{Dimension::kTime, 1e-9, "ns nsec nanoseconds"},
    Unit{Dimension::kAngularRate, 1.0, "rad/s radps rad_s rads"},
    Unit{Dimension::kAngularRate, kRadPerDeg, "deg/s dps degps deg_s \xC2\xB0/s"},
    Unit{Dimension::kAngularRate, 1e-3 * kRadPerDeg, "mdps mdeg/s"},
    Unit{Dimension::kAcceleration, 1.0, "m/s^2 m/s2 m/s\xC2\xB2 mps2 m_s2 m/s/s"},
    Unit{Dimension::kAcceleration, kStandardGravityMps2, "g g0"},
    Unit{Dimension::kAcceleration, 1e-3 * kStandardGravityMps2, "mg"},
    Unit{Dimension::kAngle, 1.0, "deg degrees \xC2\xB0"},
    Unit{Dimension::kAngle, 1.0 / kRadPerDeg, "rad"},
    Unit{Dimension::kAngle, 1e-7, "1e-7deg deg_e7 dege7 e7"},
    Unit{Dimension::kLength, 1.0, "m \xC2\xB0"},  // phyphox heads its vertical accuracy so
    Unit{Dimension::kLength, 1e-3, "mm"},
    Unit{Dimension::kLength, 1e-2, "cm"},
    Unit{Dimension::kLength, 0.3048, "ft"},
    Unit{Dimension::kSpeed, 1.0, "m/s mps m_s"},
    Unit{Dimension::kSpeed, 1e-2, "cm/s cmps"},
    Unit{Dimension::kSpeed, 1e-3, "mm/s mmps"},
    Unit{Dimension::kSpeed, 1.0 / 3.6, "km/h kmh kmph kph"},
    Unit{Dimension::kSpeed, 0.44704, "mph"},
    Unit{Dimension::kSpeed, 0.3048, "ft/s fps"},
    Unit{Dimension::kSpeed, 1852.0 / 3600.0, "kn kt knots"}};

template <class Visit>
void for_each_word(std::string_view words, const Visit& visit) {
  for (const std::string_view word : split_fields(words, Separator::kRuns)) visit(word);
}

const Unit* unit_named(std::string_view text, Dimension dimension) {
  const Unit* found = nullptr;
  for (const Unit& unit : kUnits) {
    if (unit.dimension != dimension) continue;
    for_each_word(unit.names, [&](std::string_view name) {
      if (name == text) found = &unit;
    });
  }
  return found;
}

std::string units_of(Dimension dimension) {
  std::string list;
  for (const Unit& unit : kUnits) {
    if (unit.dimension != dimension) continue;
    list += (list.empty() ? "" : ", ") + std::string(unit.names.substr(0, unit.names.find(' ')));
  }
  return list;
}

double scale_of(const std::string& unit, Dimension dimension, const std::string& of_what) {
  if (const Unit* found = unit_named(unit, dimension)) return found->scale;
  throw Error(of_what + ": unit '" + unit + "' is not one of " + units_of(dimension));
}

/// The axis that "?" stands for; ' ' where the pattern has none; nothing where it does not fit.
std::optional<char> axis_of(std::string_view name, std::string_view pattern,
                            std::string_view axes) {
  if (name.size() != pattern.size()) return std::nullopt;
  char axis = ' ';
  for (std::size_t k = 0; k < name.size(); ++k) {
    if (pattern[k] == '?' && axes.find(name[k]) != std::string_view::npos) {
      axis = name[k];
    } else if (pattern[k] != name[k]) {
      return std::nullopt;
    }
  }
  return axis;
}

struct Match {
  const Quantity* quantity{};
  std::string column{};
};

Match match(std::string_view stem) {
  Match found;
  for (const Quantity& quantity : kQuantities) {
    for_each_word(quantity.aliases, [&](std::string_view alias) {
      const auto axis = axis_of(stem, alias, quantity.axes);
      if (!axis || found.quantity) return;
      found = {&quantity, std::string(quantity.column)};
      std::replace(found.column.begin(), found.column.end(), '?', *axis);
    });
  }
  return found;
}

const Quantity* quantity_of_column(std::string_view column) {
  const auto found = std::find_if(kQuantities.begin(), kQuantities.end(), [&](const Quantity& q) {
    return axis_of(column, q.column, q.axes).has_value();
  });
  return found == kQuantities.end() ? nullptr : &*found;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

/// Letters and digits, with one "_" for whatever stands between them.
std::string plain_name(std::string_view text) {
  std::string name;
  for (const char c : text) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c < 0;
    if (is_letter) name += c;
    if (!is_letter && !name.empty() && name.back() != '_') name += '_';
  }
  if (name.ends_with('_')) name.pop_back();
  return name;
}

/// "gyro x [deg/s]" as "gyro_x" and "deg/s".
std::pair<std::string, std::string> stem_and_unit(const std::string& title) {
  const std::size_t open = title.find_last_of("[(");
  const bool has_unit = open != std::string::npos && open > 0 && title.find_last_of("])") > open;
  if (!has_unit) return {plain_name(title), {}};
  const std::size_t close = std::min(title.find_last_of("])"), title.size());
  return {plain_name(title.substr(0, open)), title.substr(open + 1, close - open - 1)};
}

const std::string& owners_unit(Dimension dimension, const LogFormat& format) {
  static const std::string kNone;
  if (dimension == Dimension::kTime) return format.time_unit;
  if (dimension == Dimension::kAngularRate) return format.gyro_unit;
  return dimension == Dimension::kAcceleration ? format.accel_unit : kNone;
}

ColumnMeaning with_unit(const Match& found, const std::string& unit, const std::string& title,
                        const LogFormat& format) {
  const Dimension dimension = found.quantity->dimension;
  const std::string& by_owner = owners_unit(dimension, format);
  ColumnMeaning meaning{.column = found.column, .names_unit = true, .is_alias = true};
  if (!by_owner.empty()) {
    meaning.scale = scale_of(lower(by_owner), dimension, "the unit given for column " + title);
  } else if (!unit.empty()) {
    meaning.scale = scale_of(unit, dimension, "column " + title);
  } else {
    meaning.names_unit = false;
  }
  return meaning;
}

/// A name without brackets may end in its unit, which may have a "_" itself: "acc_x_m_s2".
std::optional<ColumnMeaning> with_suffix(const std::string& name, const std::string& title,
                                         const LogFormat& format) {
  for (std::size_t at = name.find('_'); at != std::string::npos; at = name.find('_', at + 1)) {
    const Match found = match(std::string_view(name).substr(0, at));
    const std::string unit = name.substr(at + 1);
    if (found.quantity && unit_named(unit, found.quantity->dimension)) {
      return with_unit(found, unit, title, format);
    }
  }
  return std::nullopt;
}

ColumnMeaning meaning_of_owned(std::string_view title, const std::string& ours,
                               const LogFormat& format) {
  if (quantity_of_column(ours)) return ColumnMeaning{.column = ours, .is_alias = true};
  const Match found = match(ours);
  if (!found.quantity) throw Error("column '" + ours + "' is none that Leeway reads");
  if (lower(title) == found.column) return ColumnMeaning{.column = found.column, .is_alias = true};
  return with_unit(found, stem_and_unit(lower(title)).second, std::string(title), format);
}

std::optional<ColumnMeaning> meaning_by_owner(std::string_view title, const LogFormat& format) {
  for (const auto& [ours, theirs] : format.columns) {
    if (theirs == title) return meaning_of_owned(title, ours, format);
    if (!theirs.starts_with('-') || theirs.substr(1) != title) continue;
    ColumnMeaning meaning = meaning_of_owned(title, ours, format);
    meaning.scale = -meaning.scale;
    return meaning;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> log_column_names() {
  std::vector<std::string> names;
  for (const Quantity& quantity : kQuantities) {
    const std::string_view alias = quantity.aliases.substr(0, quantity.aliases.find(' '));
    for (const char axis : quantity.axes.empty() ? std::string_view(" ") : quantity.axes) {
      for (std::string name : {std::string(alias), std::string(quantity.column)}) {
        std::replace(name.begin(), name.end(), '?', axis);
        names.push_back(std::move(name));
      }
    }
  }
  return names;
}

ColumnMeaning meaning_of(std::string_view title, const LogFormat& format) {
  if (const auto owned = meaning_by_owner(title, format)) return *owned;
  const std::string name = lower(title);
  if (const Quantity* quantity = quantity_of_column(name)) {
    ColumnMeaning meaning = with_unit({quantity, name}, {}, name, format);
    meaning.names_unit = true;
    meaning.is_alias = false;
    return meaning;
  }
  const auto [stem, unit] = stem_and_unit(name);
  if (const Match found = match(stem); found.quantity) {
    const bool is_other =
        found.quantity->is_common && !unit.empty() && !unit_named(unit, found.quantity->dimension);
    if (!is_other) return with_unit(found, unit, std::string(title), format);
  }
  if (unit.empty()) {
    if (const auto meaning = with_suffix(stem, std::string(title), format)) return *meaning;
  }
  return {.column = name};
}

}  // namespace leeway
