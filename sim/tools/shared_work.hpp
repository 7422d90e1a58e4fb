/// @file
/// Independent jobs on all processors of all ranks, each of which gets what all of them found.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "leeway/sim/tools/ranks.hpp"

namespace leeway::sim {

/// The bytes that job(0) .. job(count - 1) give, in this order, on every rank. Rank r of n computes
/// r, r + n, r + 2n ... All ranks must call it with the same count.
/// @param progress  called from the calling thread with the fraction done of this rank's part
/// @param threads   of each rank; 0: all processors for a process alone, one per rank
/// @throws Error when a job throws one, the same on every rank: of the lowest rank with one.
/// RankFailure as Ranks.
std::vector<std::string> shared_work(std::size_t count,
                                     const std::function<std::string(std::size_t)>& job,
                                     const Ranks& ranks,
                                     const std::function<void(double)>& progress = {},
                                     int threads = 0);

/// The number of threads that a rank runs: as many as wanted; of 0, all processors for a process
/// alone and one for each of several ranks.
int threads_of_rank(int wanted, const Ranks& ranks);

}  // namespace leeway::sim
