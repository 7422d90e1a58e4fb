#include "leeway/navigator/ring_buffer.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <deque>

#include "leeway/sim/tools/random.hpp"

namespace leeway {

TEST_CASE("any sequence of operations leaves what it leaves in a std::deque") {
  for (const std::size_t capacity : {1u, 2u, 3u, 7u, 16u}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      CAPTURE(capacity);
      CAPTURE(seed);
      sim::Random random(seed);
      const auto below = [&](std::size_t n) {
        return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
      };
      RingBuffer<int> ring(capacity, -1);
      std::deque<int> deque;
      bool all_same = true;
      for (int step = 0; step < 5000; ++step) {
        const std::size_t what = below(20);
        if (what == 0) {
          ring.clear();
          deque.clear();
        } else if (what < 4 && !deque.empty()) {
          ring.pop_front();
          deque.pop_front();
        } else if (what < 6 && !deque.empty()) {
          ring.pop_back();
          deque.pop_back();
        } else if (what < 8 && !deque.empty()) {
          const std::size_t k = below(deque.size());
          ring[k] = step;
          deque[k] = step;
        } else if (what < 14 && deque.size() < capacity) {
          ring.push_back(step);
          deque.push_back(step);
        } else if (deque.size() < capacity) {
          const std::size_t k = below(deque.size() + 1);
          ring.insert(k, step);
          deque.insert(deque.begin() + static_cast<std::ptrdiff_t>(k), step);
        }
        const RingBuffer<int>& read = ring;
        bool same = read.size() == deque.size() && read.empty() == deque.empty() &&
                    read.full() == (deque.size() == capacity) && read.capacity() == capacity;
        for (std::size_t k = 0; same && k < deque.size(); ++k) same = read[k] == deque[k];
        if (same && !deque.empty()) {
          same = read.front() == deque.front() && read.back() == deque.back();
        }
        all_same = all_same && same;
      }
      CHECK(all_same);
    }
  }
}

TEST_CASE("a copy of a ring goes its own way") {
  RingBuffer<int> ring(3, 0);
  for (const int x : {1, 2, 3}) ring.push_back(x);
  ring.pop_front();
  ring.push_back(4);
  RingBuffer<int> copy = ring;
  copy[0] = 9;
  copy.pop_back();
  CHECK(ring.size() == 3);
  CHECK(ring.front() == 2);
  CHECK(ring.back() == 4);
}

}  // namespace leeway
