#include "leeway/sim/scene/scene_vehicle.hpp"

#include "sim/scene/scene_sections.hpp"
#include "sim/scene/scene_units.hpp"

namespace leeway::sim {
namespace {

constexpr Quantity kReadingInterval{"interval", kTimes, between(1e-3, 3600.0)};
constexpr Quantity kRearAxle{"rear_axle_x", kLengths, between(-100.0, 100.0)};
constexpr Quantity kRearAxleSigma{"rear_axle_sigma", kLengths, zero_or(1e-3, 100.0)};
constexpr Quantity kMountSigma{"mount_sigma", kAngles, zero_or(1e-5, 30.0 * kRadPerDeg)};
constexpr Quantity kScaleSigma{"scale_sigma", {}, zero_or(1e-6, 0.3)};
constexpr Quantity kOffsetSigma{"offset_sigma", kLengths, zero_or(1e-3, 1e4)};
constexpr Quantity kSpeedNoise{"sigma", kSpeeds, between(1e-3, 20.0)};
constexpr Quantity kHeightNoise{"sigma", kLengths, between(1e-3, 1e3)};
constexpr Quantity kHeadingNoise{"sigma", kAngles, between(1e-4, 90.0 * kRadPerDeg)};

/// @param more  reads what this sensor has beside interval and noise
std::optional<VehicleSensor> read_sensor(TomlSection& vehicle, std::string_view key,
                                         const Quantity& noise, const VehicleSensor& usual,
                                         const TomlSection::Reader& more) {
  std::optional<VehicleSensor> sensor;
  vehicle.table(key, [&](TomlSection& section) {
    sensor = usual;
    set(section, kReadingInterval, sensor->interval_s);
    set(section, noise, sensor->sigma);
    more(section);
  });
  return sensor;
}

void read_constraints(TomlSection& section, VehicleConfig& config) {
  const auto read = [&section](const char* key, bool& is_on) {
    is_on = section.boolean(key).value_or(is_on);
  };
  read("zero_velocity", config.zero_velocity);
  read("zero_angular_rate", config.zero_angular_rate);
  read("non_holonomic", config.non_holonomic);
  set(section, kRearAxle, config.rear_axle_x_m);
  set(section, kRearAxleSigma, config.rear_axle_sigma_m);
  set(section, kMountSigma, config.mount_sigma_rad);
}

}  // namespace

SceneVehicle scene_vehicle(VehicleKind kind) {
  SceneVehicle vehicle;
  vehicle.config = VehicleConfig::of(kind);
  vehicle.config.odometer = false;
  vehicle.config.barometer = false;
  vehicle.config.heading = false;
  vehicle.config.rear_axle_x_m = 0.0;
  return vehicle;
}

SceneVehicle read_vehicle(TomlSection& section) {
  SceneVehicle vehicle = scene_vehicle(section.required(section.choice<VehicleKind>("kind")));
  VehicleConfig& config = vehicle.config;
  read_constraints(section, config);
  vehicle.odometer = read_sensor(section, "odometer", kSpeedNoise, kUsualOdometer,
                                 [&config](TomlSection& odometer) {
                                   set(odometer, kScaleSigma, config.odometer_scale_sigma);
                                 });
  vehicle.barometer = read_sensor(section, "barometer", kHeightNoise, kUsualBarometer,
                                  [&config](TomlSection& barometer) {
                                    set(barometer, kOffsetSigma, config.height_offset_sigma_m);
                                  });
  vehicle.heading =
      read_sensor(section, "heading", kHeadingNoise, kUsualHeading, [](TomlSection&) {});
  config.odometer = vehicle.odometer.has_value();
  config.barometer = vehicle.barometer.has_value();
  config.heading = vehicle.heading.has_value();
  return vehicle;
}

}  // namespace leeway::sim
