/// @file
/// Strapdowns without a filter, from the truth over given increments: what the scenes of
/// mechanizations share.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "leeway/sim/motion/trajectory.hpp"
#include "leeway/strapdown/integration_monitor.hpp"
#include "leeway/strapdown/strapdown.hpp"
#include "sim/atlas/cells.hpp"

namespace leeway::sim {

/// Follows an integration monitor through a run and tells what it found left out, where that was
/// ever more than a tactical IMU's own bias: 1 deg/h, 0.1 mg.
class WatchedIncrements {
 public:
  explicit WatchedIncrements(Scheme scheme) : scheme_(scheme) {}

  void push(const ImuIncrement& inc);

  /// "motion not resolved; rate left out; force left out", or some of it, or nothing.
  std::string reported() const;

 private:
  Scheme scheme_;
  IntegrationMonitor monitor_{};
  double rate_radps_{0.0};
  double force_mps2_{0.0};
  bool resolved_{true};
};

/// The cell of a scheme that runs freely.
/// @param increments  anything with size() and []
/// @param figure      called with the state after every increment: what it says last counts
template <class Increments, class Figure>
AtlasCell free_run(Scheme scheme, const std::string& condition, const NavState& start,
                   const Increments& increments, Figure&& figure) {
  AtlasCell cell{AtlasGroup::kStrapdown, std::string(name(scheme)), condition};
  NavState nav = start;
  WatchedIncrements watched(scheme);
  ImuHistory history;
  const StrapdownFunction step = strapdown_function({scheme});
  for (std::size_t k = 0; k < increments.size(); ++k) {
    const ImuIncrement& inc = increments[k];
    step(nav, inc, history);
    nav.time = inc.time;
    watched.push(inc);
    cell.figure = figure(nav);
  }
  cell.reported = watched.reported();
  return cell;
}

/// Cells of schemes, each with a figure of its own.
template <class Increments, class Figure>
std::vector<AtlasCell> free_runs(std::initializer_list<Scheme> schemes,
                                 const std::string& condition, const NavState& start,
                                 const Increments& increments, const Figure& figure) {
  std::vector<AtlasCell> cells;
  for (const Scheme scheme : schemes) {
    cells.push_back(free_run(scheme, condition, start, increments, Figure(figure)));
  }
  return cells;
}

/// Of the attitude, about the axes of ECEF; |error| <= pi.
Eigen::Vector3d attitude_error_e_rad(const NavState& truth, const NavState& nav);

/// Of the position, on the ground.
double horizontal_error_m(const NavState& truth, const NavState& nav);

/// Cells of a body that vibrates: one for every scheme, frequency and IMU rate.
/// @param motion  repeats every second
/// @param figure  of the truth and the estimate after so many seconds
std::vector<AtlasCell> vibration_cells(
    const std::function<LocalMotion(double frequency_hz, double t_s)>& motion,
    const std::function<double(const NavState& truth, const NavState& nav, double t_s)>& figure,
    const AtlasOptions& options);

}  // namespace leeway::sim
