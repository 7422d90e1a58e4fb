#include "sim/tools/shared_work.hpp"

#include <cstdint>
#include <cstring>
#include <map>
#include <string_view>

#include "leeway/earth/error.hpp"
#include "leeway/sim/tools/parallel.hpp"

namespace leeway::sim {
namespace {

void put_number(std::string& bytes, std::uint64_t number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::uint64_t take_number(std::string_view& bytes) {
  std::uint64_t number = 0;
  std::memcpy(&number, bytes.data(), sizeof number);
  bytes.remove_prefix(sizeof number);
  return number;
}

void put_text(std::string& bytes, const std::string& text) {
  put_number(bytes, text.size());
  bytes += text;
}

std::string take_text(std::string_view& bytes) {
  const auto size = static_cast<std::size_t>(take_number(bytes));
  std::string text(bytes.substr(0, size));
  bytes.remove_prefix(size);
  return text;
}

/// What a rank found, or the message of its error: a text for each, behind their number.
struct Part {
  bool failed{false};
  std::vector<std::string> texts{};
};

std::string packed_part(const Part& part) {
  std::string bytes;
  put_number(bytes, part.failed ? 1 : 0);
  put_number(bytes, part.texts.size());
  for (const std::string& text : part.texts) put_text(bytes, text);
  return bytes;
}

Part part_of(std::string_view bytes) {
  Part part;
  part.failed = take_number(bytes) != 0;
  part.texts.resize(static_cast<std::size_t>(take_number(bytes)));
  for (std::string& text : part.texts) text = take_text(bytes);
  return part;
}

/// The jobs rank, rank + ranks, ..
Part own_part(std::size_t count, const std::function<std::string(std::size_t)>& job,
              const Ranks& ranks, const std::function<void(double)>& progress, int threads) {
  const auto rank = static_cast<std::size_t>(ranks.rank());
  const auto step = static_cast<std::size_t>(ranks.count());
  Part part;
  part.texts.resize((count + step - 1 - rank) / step);
  const auto report = [&](std::size_t done) {
    ranks.check_others();
    if (progress) progress(static_cast<double>(done) / static_cast<double>(part.texts.size()));
  };
  try {
    parallel_for(
        part.texts.size(), [&](std::size_t k) { part.texts[k] = job(rank + k * step); }, report,
        threads_of_rank(threads, ranks));
  } catch (const RankFailure&) {
    throw;
  } catch (const Error& error) {
    if (ranks.count() == 1) throw;
    part = {true, {error.what()}};
  }
  return part;
}

}  // namespace

int threads_of_rank(int wanted, const Ranks& ranks) {
  return wanted > 0 || ranks.count() == 1 ? wanted : 1;
}

std::vector<std::string> shared_work(std::size_t count,
                                     const std::function<std::string(std::size_t)>& job,
                                     const Ranks& ranks,
                                     const std::function<void(double)>& progress, int threads) {
  Part own = own_part(count, job, ranks, progress, threads);
  if (ranks.count() == 1) return std::move(own.texts);
  std::map<std::uint64_t, std::string> by_rank;
  by_rank[static_cast<std::uint64_t>(ranks.rank())] = packed_part(own);
  std::string message;
  put_number(message, static_cast<std::uint64_t>(ranks.rank()));
  ranks.to_first(message + packed_part(own), [&](const std::string& received) {
    std::string_view bytes = received;
    const std::uint64_t rank = take_number(bytes);
    by_rank[rank] = bytes;
  });
  std::string all;
  for (const auto& [rank, bytes] : by_rank) put_text(all, bytes);
  all = ranks.from_first(all);

  std::vector<std::string> found(count);
  std::string_view rest = all;
  for (std::size_t rank = 0; !rest.empty(); ++rank) {
    Part part = part_of(take_text(rest));
    if (part.failed) throw Error(part.texts[0]);
    for (std::size_t k = 0; k < part.texts.size(); ++k) {
      found[rank + k * static_cast<std::size_t>(ranks.count())] = std::move(part.texts[k]);
    }
  }
  return found;
}

}  // namespace leeway::sim
