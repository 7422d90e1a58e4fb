#include "leeway/sim/trials/campaign.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/sim/tools/parallel.hpp"
#include "leeway/sim/trials/trial.hpp"
#include "leeway/sim/trials/trial_journal.hpp"
#include "lib/earth/field_walk.hpp"
#include "sim/trials/campaign_sums.hpp"
#include "sim/trials/fingerprint.hpp"
#include "sim/trials/seed_set.hpp"

namespace leeway::sim {
namespace {

constexpr int kMostThreads = 1024;
constexpr int kMostTrials = 10'000'000;

void validate(const Scene& scene, const CampaignOptions& options) {
  require("campaign", "trials", scene.trials, between(1.0, kMostTrials));
  require("campaign", "threads", options.threads, between(0.0, kMostThreads));
  require("campaign", "score_last_s", options.score_last_s.value_or(1.0), kPositiveOrInfinite);
  if (scene.first_seed > std::numeric_limits<std::uint64_t>::max() - kMostTrials) {
    throw Error("campaign: first_seed is " + std::to_string(scene.first_seed) +
                ", must leave room for the seeds of all trials below 2^64");
  }
}

/// The trials still to run, the same list on every rank.
class Todo {
 public:
  explicit Todo(const std::string& bytes) : gaps_(bytes.size() / sizeof(SeedRange)) {
    // Not memcpy: it takes no null pointer, which the data of no gaps is.
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(gaps_.data()));
    for (const SeedRange& gap : gaps_) count_ += gap.count;
  }

  std::uint64_t count() const { return count_; }

  /// @pre index < count().
  std::uint64_t seed(std::uint64_t index) const {
    auto gap = gaps_.begin();
    while (index >= gap->count) index -= (gap++)->count;
    return gap->first + index;
  }

 private:
  std::vector<SeedRange> gaps_;
  std::uint64_t count_{0};
};

std::string bytes_of(const std::vector<SeedRange>& gaps) {
  return {reinterpret_cast<const char*>(gaps.data()), gaps.size() * sizeof(SeedRange)};
}

/// Adds the trials of the scene that the journals hold, each once. @returns those they do not.
std::vector<SeedRange> resume(const Scene& scene, const CampaignOptions& options,
                              std::uint64_t scene_fingerprint, CampaignSums& sums) {
  const SeedRange all{scene.first_seed, static_cast<std::uint64_t>(scene.trials)};
  SeedSet finished;
  if (options.journal.empty()) return finished.missing(all);
  for (const auto& path : existing_journals(options.journal)) {
    read_journal(path, scene_fingerprint, [&](const TrialScore& score) {
      const bool wanted = score.seed - all.first < all.count;
      if (wanted && finished.insert(score.seed)) sums.add(score);
    });
  }
  return finished.missing(all);
}

/// The sums of all ranks together, at the first.
CampaignSums of_all_ranks(CampaignSums sums, const Ranks& ranks) {
  std::string bytes(sizeof sums, '\0');
  std::memcpy(bytes.data(), &sums, sizeof sums);
  ranks.to_first(bytes, [&sums](const std::string& others_bytes) {
    CampaignSums others;
    std::memcpy(&others, others_bytes.data(), sizeof others);
    sums.add(others);
  });
  return sums;
}

/// Calls progress with what is finished, and how long the rest takes at the pace so far.
std::function<void(std::size_t)> reporter(const CampaignOptions& options, const Ranks& ranks,
                                          double before, double mine) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  return [&options, &ranks, before, mine, start](std::size_t finished) {
    ranks.check_others();
    if (!options.progress) return;
    const auto done = static_cast<double>(finished);
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - start).count();
    options.progress({(before + done) / (before + mine), elapsed_s * (mine - done) / done});
  };
}

}  // namespace

CampaignResult campaign(const Scene& scene, const CampaignOptions& options, const Ranks& ranks) {
  validate(scene, options);
  const int threads = options.threads > 0 || ranks.count() == 1 ? options.threads : 1;
  const TrialPlan plan(scene, options.score_last_s, threads);
  const std::uint64_t scene_fingerprint = fingerprint(plan);

  // The first reads all journals before any rank adds to its own.
  CampaignSums sums;
  std::string gaps;
  if (ranks.is_first()) gaps = bytes_of(resume(scene, options, scene_fingerprint, sums));
  const Todo todo(ranks.from_first(gaps));
  const std::int64_t resumed = sums.trials;

  std::optional<TrialJournal> journal;
  if (!options.journal.empty()) {
    journal.emplace(journal_of_rank(options.journal, ranks.rank(), ranks.count()),
                    scene_fingerprint);
  }
  const auto rank = static_cast<std::uint64_t>(ranks.rank());
  const auto count = static_cast<std::uint64_t>(ranks.count());
  const std::uint64_t mine = (todo.count() + count - 1 - rank) / count;
  std::mutex mutex;
  parallel_for(
      mine,
      [&](std::size_t k) {
        const TrialScore score = run_trial(plan, todo.seed(k * count + rank));
        const std::lock_guard lock(mutex);
        if (journal) journal->append(score);
        sums.add(score);
      },
      reporter(options, ranks, static_cast<double>(resumed) / static_cast<double>(count),
               static_cast<double>(mine)),
      threads);

  CampaignResult result = result_of(of_all_ranks(sums, ranks));
  result.resumed = resumed;
  return result;
}

CampaignResult campaign(const Scene& scene, const CampaignOptions& options) {
  return campaign(scene, options, Ranks::alone());
}

}  // namespace leeway::sim
