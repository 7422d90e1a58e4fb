/// @file
/// Independent jobs on all processors of one machine.
#pragma once

#include <cstddef>
#include <functional>

namespace leeway::sim {

/// Calls of job(0) .. job(count - 1), each once, started in ascending order on several threads.
/// The first exception of a job or of progress is thrown again here, after all threads have ended.
/// @param progress  called from the calling thread with the number of finished jobs
/// @param threads   number of threads; 0: as many as there are processors
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& job,
                  const std::function<void(std::size_t)>& progress = {}, int threads = 0);

}  // namespace leeway::sim
