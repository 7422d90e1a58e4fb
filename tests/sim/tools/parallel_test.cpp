#include "leeway/sim/tools/parallel.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace leeway::sim {

TEST_CASE("every job runs once, whatever their number") {
  for (const std::size_t count : {0u, 1u, 2u, 3u, 100u}) {
    CAPTURE(count);
    std::vector<std::atomic<int>> calls(count);
    std::size_t last_progress = 0;
    parallel_for(
        count, [&](std::size_t k) { ++calls[k]; },
        [&](std::size_t finished) { last_progress = finished; });
    for (const auto& n : calls) CHECK(n == 1);
    CHECK(last_progress <= count);
  }
}

TEST_CASE("an exception of a job reaches the caller after all threads have stopped") {
  std::atomic<int> running{0};
  CHECK_THROWS_WITH_AS(parallel_for(50,
                                    [&](std::size_t k) {
                                      ++running;
                                      if (k == 7) {
                                        --running;
                                        throw std::runtime_error("job 7");
                                      }
                                      --running;
                                    }),
                       "job 7", std::runtime_error);
  CHECK(running == 0);
}

TEST_CASE("an exception of progress stops the jobs and reaches the caller") {
  std::atomic<bool> thrown{false};
  std::atomic<int> calls{0};
  const auto job = [&](std::size_t k) {
    while (k == 1 && !thrown) std::this_thread::yield();
    // Jobs of no length would keep the lock from the thread that reports.
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ++calls;
  };
  const auto progress = [&](std::size_t) {
    thrown = true;
    throw std::runtime_error("progress");
  };
  CHECK_THROWS_WITH_AS(parallel_for(10'000, job, progress, 1), "progress", std::runtime_error);
  CHECK(calls < 10'000);
}

TEST_CASE("one thread runs the jobs in order") {
  std::vector<std::size_t> order;
  parallel_for(
      100, [&](std::size_t k) { order.push_back(k); }, {}, 1);
  REQUIRE(order.size() == 100);
  for (std::size_t k = 0; k < order.size(); ++k) CHECK(order[k] == k);
}

}  // namespace leeway::sim
