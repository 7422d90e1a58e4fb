#include "leeway/sim/tools/parallel.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace leeway::sim {
namespace {

/// What the threads share, all under one lock: jobs are long, the lock is not.
struct Jobs {
  std::mutex mutex;
  std::condition_variable changed;
  std::size_t next{0};
  std::size_t finished{0};
  std::size_t running{0};
  std::exception_ptr error{};
};

/// Calls f(argument) without the lock; what it throws becomes the error, if it is the first.
void call_unlocked(Jobs& jobs, std::unique_lock<std::mutex>& lock,
                   const std::function<void(std::size_t)>& f, std::size_t argument) {
  lock.unlock();
  std::exception_ptr error;
  try {
    f(argument);
  } catch (...) {
    error = std::current_exception();
  }
  lock.lock();
  if (error && !jobs.error) jobs.error = error;
}

void work(Jobs& jobs, std::size_t count, const std::function<void(std::size_t)>& job) {
  std::unique_lock lock(jobs.mutex);
  while (jobs.next < count && !jobs.error) {
    call_unlocked(jobs, lock, job, jobs.next++);
    ++jobs.finished;
    jobs.changed.notify_one();
  }
  --jobs.running;
  jobs.changed.notify_one();
}

}  // namespace

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& job,
                  const std::function<void(std::size_t)>& progress, int threads) {
  const std::size_t wanted = threads > 0 ? static_cast<std::size_t>(threads)
                                         : std::max(1u, std::thread::hardware_concurrency());
  Jobs jobs;
  jobs.running = std::min(count, wanted);
  std::vector<std::jthread> workers;
  for (std::size_t i = jobs.running; i-- > 0;) {
    workers.emplace_back([&] { work(jobs, count, job); });
  }
  {
    std::unique_lock lock(jobs.mutex);
    std::size_t reported = 0;
    while (jobs.running > 0) {
      jobs.changed.wait(lock);
      if (!progress || jobs.finished == reported) continue;
      reported = jobs.finished;
      call_unlocked(jobs, lock, progress, reported);
    }
  }
  workers.clear();
  if (jobs.error) std::rethrow_exception(jobs.error);
}

}  // namespace leeway::sim
