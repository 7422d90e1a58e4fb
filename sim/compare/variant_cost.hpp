/// @file
/// What a filter costs: processor time of whole runs.
#pragma once

#include <functional>
#include <vector>

#include "leeway/sim/compare/compare.hpp"
#include "sim/compare/filter_case.hpp"

namespace leeway::sim {

/// Of one run of the case over its trial, per second of IMU data.
double timed_ns_per_s(const FilterCase& one, GivenTrials& given);

/// Median, least and most. @pre not empty
Cost cost_of(std::vector<double> ns_per_s);

/// A timed run: nanoseconds per second of IMU data.
using TimedRun = std::function<double()>;

/// The costs of all, in their order, each round all of them in turn: what slows the machine for a
/// while slows all alike. @pre rounds >= 1
std::vector<Cost> interleaved_costs(const std::vector<TimedRun>& runs, int rounds,
                                    const std::function<void(double)>& progress = {});

}  // namespace leeway::sim
