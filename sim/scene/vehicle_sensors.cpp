#include "leeway/sim/scene/vehicle_sensors.hpp"

#include <cmath>

#include "leeway/earth/earth.hpp"

namespace leeway::sim {
namespace {

bool is_due(const std::optional<VehicleSensor>& sensor, double from_s, double to_s) {
  if (!sensor) return false;
  constexpr double kRounding = 1e-9;
  const auto readings_until = [&](double t_s) {
    return std::floor(t_s / sensor->interval_s + kRounding);
  };
  return readings_until(to_s) > readings_until(from_s);
}

}  // namespace

double VehicleSensors::Walk::moved_to(double t_s, Random& random) {
  value += per_sqrt_s * std::sqrt(t_s - at_s) * random.normal();
  at_s = t_s;
  return value;
}

VehicleSensors::VehicleSensors(const SceneVehicle& vehicle, std::uint64_t seed)
    : vehicle_(vehicle), random_(seed, 0, kFirstFreeStream) {
  const VehicleConfig& c = vehicle.config;
  scale_ = {c.odometer_scale_sigma * random_.normal(), c.odometer_walk_per_sqrt_s};
  offset_m_ = {c.height_offset_sigma_m * random_.normal(), c.height_walk_m_per_sqrt_s};
}

void VehicleSensors::read(const Trajectory& trajectory, Time now, double from_s, double to_s,
                          const std::function<void(const Reading&)>& f) {
  const bool odometer = is_due(vehicle_.odometer, from_s, to_s);
  const bool barometer = is_due(vehicle_.barometer, from_s, to_s);
  const bool heading = is_due(vehicle_.heading, from_s, to_s);
  if (!odometer && !barometer && !heading) return;
  const TruthPoint truth = truth_at(trajectory, to_s);
  if (odometer) f(odometer_reading(now, truth));
  if (barometer) f(barometer_reading(now, truth));
  if (heading) f(heading_reading(now, truth));
}

Reading VehicleSensors::odometer_reading(Time now, const TruthPoint& truth) {
  const double sigma_mps = vehicle_.odometer->sigma;
  const double forward_mps = (truth.nav.q_eb.conjugate() * truth.nav.v_e_mps).x();
  const double scale = 1.0 + scale_.moved_to(to_seconds(now), random_);
  return OdometerSpeed{now, scale * forward_mps + sigma_mps * random_.normal(), sigma_mps};
}

Reading VehicleSensors::barometer_reading(Time now, const TruthPoint& truth) {
  const double sigma_m = vehicle_.barometer->sigma;
  const double offset_m = offset_m_.moved_to(to_seconds(now), random_);
  const double height_m = geodetic_from_ecef(truth.nav.r_e_m).height_m;
  return BarometricHeight{now, height_m + offset_m + sigma_m * random_.normal(), sigma_m};
}

Reading VehicleSensors::heading_reading(Time now, const TruthPoint& truth) {
  const double sigma_rad = vehicle_.heading->sigma;
  const Azimuth azimuth(truth.nav.q_eb.toRotationMatrix().col(0), truth.nav.r_e_m);
  return MeasuredHeading{now, wrap_pi(azimuth.angle_rad + sigma_rad * random_.normal()), sigma_rad};
}

}  // namespace leeway::sim
