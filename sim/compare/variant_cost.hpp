/// @file
/// What a filter costs: processor time of whole replays.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "leeway/sim/compare/compare.hpp"
#include "sim/compare/variant_run.hpp"

namespace leeway::sim {

/// Of one whole replay by the variant's filter, per second of IMU data. Where in a page of memory
/// the filter lies, beside where its stack lies, can double it: processors take two addresses that
/// agree in their last 12 bits for one.
/// @param place  how far the stack is beyond the filter in their pages, in cache lines: alike for
///               what is compared, and others in other rounds
double timed_ns_per_s(const Variant& variant, const EkfConfig& believed, const TrialStart& start,
                      const RecordedTrial& trial, std::size_t place);

/// Median, least and most. @pre not empty
Cost cost_of(std::vector<double> ns_per_s);

/// A timed run at a place: nanoseconds per second of IMU data.
using TimedRun = std::function<double(std::size_t place)>;

/// The costs of all, in their order, each round all of them in turn: what slows the machine for a
/// while slows all alike. @pre rounds >= 1
std::vector<Cost> interleaved_costs(const std::vector<TimedRun>& runs, int rounds,
                                    const std::function<void(double)>& progress = {});

}  // namespace leeway::sim
