// The cases named "ranks: .." also run on three of them, by mpirun.
#include "sim/tools/shared_work.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "leeway/earth/error.hpp"
#include "tests/sim/tools/all_ranks.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::sim {
namespace {

using test::all_ranks;
using test::message_of;

std::string text_of(std::size_t k) { return std::string(k % 5, '\0') + std::to_string(k); }

}  // namespace

TEST_CASE("ranks: all have what all found, in order, of any number of jobs") {
  for (const std::size_t count : {0u, 1u, 2u, 3u, 50u}) {
    CAPTURE(count);
    for (const int threads : {0, 2}) {
      const auto found = shared_work(count, text_of, all_ranks(), {}, threads);
      REQUIRE(found.size() == count);
      for (std::size_t k = 0; k < count; ++k) CHECK(found[k] == text_of(k));
    }
  }
}

TEST_CASE("ranks: the error of a job is that of every rank, and the next work is not disturbed") {
  for (const std::size_t bad : {0u, 1u, 5u}) {
    CAPTURE(bad);
    const auto job = [bad](std::size_t k) -> std::string {
      if (k == bad) throw Error("job " + std::to_string(k));
      return {};
    };
    const auto run = [&] { shared_work(20, job, all_ranks()); };
    CHECK(message_of<Error>(run) == "job " + std::to_string(bad));
    CHECK(shared_work(4, text_of, all_ranks()).back() == text_of(3));
  }
}

TEST_CASE("ranks: a value of the first is that of all") {
  const Ranks& ranks = all_ranks();
  CHECK(ranks.from_first(ranks.rank() == 0 ? 0.1 : 0.2) == 0.1);
  CHECK(ranks.from_first(ranks.is_first()));
  CHECK(threads_of_rank(3, ranks) == 3);
  CHECK(threads_of_rank(0, ranks) == (ranks.count() == 1 ? 0 : 1));
}

TEST_CASE("ranks: progress ends at 1 on each that has jobs") {
  // Jobs that are over before the caller looks are not told of.
  const auto job = [](std::size_t k) {
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
    return text_of(k);
  };
  double last = 0.0;
  shared_work(9, job, all_ranks(), [&last](double fraction) { last = fraction; });
  CHECK(last == 1.0);
}

}  // namespace leeway::sim
