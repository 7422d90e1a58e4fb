#include "leeway/sensors/imu_class.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "leeway/earth/units.hpp"

namespace leeway {
namespace {

struct TableRange {
  double low;
  double high;

  double at(RangeEnd end) const {
    switch (end) {
      case RangeEnd::kLow:
        return low;
      case RangeEnd::kHigh:
        return high;
      case RangeEnd::kMid:
        break;
    }
    return std::sqrt(low * high);
  }
};

struct Table1Row {
  TableRange accelerometer_drift_mps2;
  TableRange gyro_drift_radps;
  TableRange accelerometer_noise_ug_per_sqrt_hz;
  TableRange gyro_noise_deg_per_sqrt_h;
};

// [seed Table 1], in the order of ImuClass
constexpr std::array<Table1Row, 5> kTable1{{
    {{1e-4, 1e-4}, {5e-9, 5e-9}, {5.0, 20.0}, {0.0005, 0.002}},
    {{3e-4, 1e-3}, {5e-8, 5e-8}, {20.0, 20.0}, {0.002, 0.002}},
    {{1e-3, 1e-2}, {5e-7, 5e-7}, {20.0, 100.0}, {0.002, 0.03}},
    {{1e-2, 1e-1}, {5e-6, 5e-6}, {100.0, 1000.0}, {0.03, 1.0}},
    {{1e-1, 1e-1}, {5e-4, 5e-4}, {1000.0, 1000.0}, {1.0, 1.0}},
}};

const Table1Row& row(ImuClass c) { return kTable1[static_cast<std::size_t>(c)]; }

/// The class whose range is nearest on a logarithmic scale; of two as near, the better one.
ImuClass nearest(TableRange Table1Row::*range, double value) {
  const auto distance = [range, value](ImuClass c) {
    const TableRange& r = row(c).*range;
    // A unit conversion may leave the end of a range by an ulp.
    constexpr double kRounding = 1e-12;
    const double outside = std::max(std::log(r.low / value), std::log(value / r.high));
    return outside > kRounding ? outside : 0.0;
  };
  return *std::min_element(kAll<ImuClass>.begin(), kAll<ImuClass>.end(),
                           [&](ImuClass a, ImuClass b) { return distance(a) < distance(b); });
}

}  // namespace

ImuErrorModel imu_class_model(ImuClass c, RangeEnd end) {
  const Table1Row& table = row(c);
  ImuErrorModel model;
  model.accelerometer.bias_sigma = table.accelerometer_drift_mps2.at(end);
  model.accelerometer.noise_density =
      table.accelerometer_noise_ug_per_sqrt_hz.at(end) * units::kUgPerSqrtHz.si;
  model.gyro.bias_sigma = table.gyro_drift_radps.at(end);
  model.gyro.noise_density = table.gyro_noise_deg_per_sqrt_h.at(end) * units::kDegPerSqrtH.si;
  return model;
}

ImuClassification classify(const ImuErrorModel& model) {
  // The bias that a filter starts with, whether it stays or wanders: Table 1 has one drift only.
  const auto drift = [](const TriadErrorModel& triad) {
    return std::hypot(triad.bias_sigma, triad.in_run.sigma);
  };
  ImuClassification c;
  c.accelerometer_drift = nearest(&Table1Row::accelerometer_drift_mps2, drift(model.accelerometer));
  c.gyro_drift = nearest(&Table1Row::gyro_drift_radps, drift(model.gyro));
  c.accelerometer_noise = nearest(&Table1Row::accelerometer_noise_ug_per_sqrt_hz,
                                  model.accelerometer.noise_density / units::kUgPerSqrtHz.si);
  c.gyro_noise = nearest(&Table1Row::gyro_noise_deg_per_sqrt_h,
                         model.gyro.noise_density / units::kDegPerSqrtH.si);
  c.overall = std::max({c.accelerometer_drift, c.gyro_drift, c.accelerometer_noise, c.gyro_noise});
  return c;
}

ImuErrorModel automotive_mems_model() {
  ImuErrorModel model;
  model.accelerometer.bias_sigma = 0.3;
  model.accelerometer.noise_density = 0.1 * units::kMpsPerSqrtH.si;
  model.accelerometer.in_run = {0.005, 300.0};
  model.gyro.bias_sigma = 0.5 * units::kDegPerS.si;
  model.gyro.noise_density = 0.3 * units::kDegPerSqrtH.si;
  model.gyro.in_run = {0.01 * units::kDegPerS.si, 300.0};
  return model;
}

}  // namespace leeway
