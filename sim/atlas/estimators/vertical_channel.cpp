#include <cmath>
#include <string>

#include "leeway/earth/earth.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/linear_response.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kHeightErrorM = 0.1;
constexpr double kVerticalRateHz = 10.0;

ErrorVector height_error(const Trajectory& trajectory) {
  ErrorVector x = ErrorVector::Zero();
  x.segment<3>(kDr) = kHeightErrorM * down_e_at(truth_at(trajectory, 0.0).nav.r_e_m);
  return x;
}

double height_sigma_m(const ErrorMatrix& moment, const Eigen::Vector3d& down_e) {
  return std::sqrt(down_e.dot(moment.block<3, 3>(kDr, kDr) * down_e));
}

/// The error model of a flat Earth: no gravity gradient, so that an error of height stays as it is.
ErrorMatrix phi_without_gradient(double duration_s) {
  ErrorMatrix Phi = ErrorMatrix::Identity();
  Phi.block<3, 3>(kDr, kDv) = duration_s * Eigen::Matrix3d::Identity();
  return Phi;
}

std::vector<AtlasCell> run_vertical_channel(const AtlasOptions& /*options*/) {
  return cells_over(std::vector{5.0, 30.0}, [](double minutes) {
    const double duration_s = 60.0 * minutes;
    const Trajectory rest = static_trajectory({.duration_s = duration_s});
    const LinearResponse response(rest, kVerticalRateHz, duration_s, {height_error(rest)});
    const Eigen::Vector3d axis_e = down_e_at(response.start().nav.r_e_m);
    return response.compared(
        atlas_columns(), std::to_string(std::lround(minutes)) + " min",
        [&axis_e](const ErrorMatrix& moment) { return height_sigma_m(moment, axis_e); },
        "F without gravity gradient", phi_without_gradient(duration_s));
  });
}

}  // namespace

AtlasScene vertical_channel() {
  return {
      .place = 120,
      .key = "vertical-channel",
      .title = "Height without fixes for half an hour",
      .figure = "claimed over true height error, as a factor",
      .limits =
          {1.1, 2.0,
           "a claim within 10 % is as good as a sigma is known; one of half the error is no claim"},
      .run = run_vertical_channel};
}

}  // namespace leeway::sim::scenes
