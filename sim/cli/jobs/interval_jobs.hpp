/// @file
/// What `leeway interval` computes, in the order in which its numbers gain weight: the linear
/// answers, what aiding gives, and the trials that check them.
#pragma once

#include <vector>

#include "leeway/sim/tools/ranks.hpp"
#include "sim/cli/json.hpp"
#include "sim/cli/scene_options.hpp"
#include "sim/cli/tables/interval_tables.hpp"

namespace leeway::cli {

struct IntervalChoice {
  SceneChoice scene{};
  int confirm_trials{0};
  std::vector<std::string> confirm_limits{};  ///< as sim::allowed_error()
  bool no_check{false};
  bool with_sensitivity{false};
};

/// The answers of every IMU that was asked for. An answer that cannot be checked says why; the
/// others stand.
/// @param ranks   share the trials; every rank must call it
/// @param series  gets tables curve/IMU (interval_s, true_m, claimed_m) of the errors that were met
///                on the way, free_inertial/IMU (t_s, true_m) and roofline/IMU, a roofline_series()
/// @throws Error when the scene is invalid, or an answer is to be confirmed that was not asked for.
std::vector<SolvedImu> solve_imus(const IntervalChoice& choice, const sim::Ranks& ranks,
                                  Json& series);

}  // namespace leeway::cli
