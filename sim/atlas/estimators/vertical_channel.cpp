#include <cmath>
#include <string>

#include "leeway/earth/earth.hpp"
#include "leeway/sim/atlas/atlas.hpp"
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
  std::vector<AtlasCell> cells;
  for (const double minutes : {5.0, 30.0}) {
    const double duration_s = 60.0 * minutes;
    const Trajectory rest = static_trajectory({.duration_s = duration_s});
    const LinearResponse response(rest, kVerticalRateHz, duration_s, {height_error(rest)});
    const Eigen::Vector3d axis_e = down_e_at(response.start().nav.r_e_m);
    const std::string condition = std::to_string(std::lround(minutes)) + " min";
    const double truth_m = height_sigma_m(response.truth(), axis_e);
    const auto add = [&](AtlasGroup group, const std::string& variant, const ErrorMatrix& claim) {
      const double factor = factor_between(height_sigma_m(claim, axis_e), truth_m);
      cells.push_back({group, variant, condition, factor, {}});
    };
    for (const AtlasColumn& column : atlas_columns()) {
      if (column.group != AtlasGroup::kReset)
        add(column.group, column.name, response.claim(column));
    }
    add(AtlasGroup::kNotOffered, "F without gravity gradient",
        response.carried(phi_without_gradient(duration_s)));
  }
  return cells;
}

}  // namespace

AtlasScene vertical_channel() {
  return {
      .place = 120,
      .key = "vertical-channel",
      .title = "Height without fixes for half an hour",
      .figure = "claimed over true height error, as a factor",
      .unit = "",
      .limits =
          {1.1, 2.0,
           "a claim within 10 % is as good as a sigma is known; one of half the error is no claim"},
      .run = run_vertical_channel};
}

}  // namespace leeway::sim::scenes
