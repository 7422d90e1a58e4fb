#include "leeway/sim/trials/campaign.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/sim/tools/parallel.hpp"
#include "leeway/sim/trials/trial.hpp"
#include "leeway/sim/trials/trial_journal.hpp"
#include "lib/earth/field_walk.hpp"
#include "sim/tools/shared_work.hpp"
#include "sim/trials/campaign_sums.hpp"
#include "sim/trials/fingerprint.hpp"
#include "sim/trials/journals/journal_merge.hpp"
#include "sim/trials/shared_trials.hpp"

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
  if (std::ranges::count(options.journals, std::filesystem::path()) > 0) {
    throw Error("campaign: one of the journals has no name; leave it out");
  }
  if (options.merge_only && options.journals.empty()) {
    throw Error("campaign: merge_only needs journals; name at least one");
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
  const std::vector<SeedRange>& gaps() const { return gaps_; }

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

/// What the journals hold of the scene's trials.
MergedJournals finished_trials(const Scene& scene, const CampaignOptions& options,
                               std::uint64_t scene_fingerprint) {
  return merge_journals(options.journals, !options.merge_only, scene_fingerprint,
                        {scene.first_seed, static_cast<std::uint64_t>(scene.trials)});
}

/// The sums of all ranks together, on each.
CampaignSums of_all_ranks(CampaignSums sums, const Ranks& ranks) {
  std::string bytes(sizeof sums, '\0');
  std::memcpy(bytes.data(), &sums, sizeof sums);
  ranks.to_first(bytes, [&sums](const std::string& others_bytes) {
    CampaignSums others;
    std::memcpy(&others, others_bytes.data(), sizeof others);
    sums.add(others);
  });
  return ranks.from_first(sums);
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

/// Runs this rank's part of the missing trials, keeps them and adds them to the sums.
void run_missing(const TrialPlan& plan, const CampaignOptions& options, const Todo& todo,
                 const Ranks& ranks, CampaignSums& sums) {
  const int threads = threads_of_rank(options.threads, ranks);
  std::optional<TrialJournal> journal;
  if (!options.journals.empty()) {
    journal.emplace(journal_of_rank(options.journals[0], ranks.rank(), ranks.count()),
                    fingerprint(plan));
  }
  const auto rank = static_cast<std::uint64_t>(ranks.rank());
  const auto count = static_cast<std::uint64_t>(ranks.count());
  const std::uint64_t mine = (todo.count() + count - 1 - rank) / count;
  const double before = static_cast<double>(sums.trials) / static_cast<double>(count);
  std::mutex mutex;
  parallel_for(
      mine,
      [&](std::size_t k) {
        const TrialScore score = run_trial(plan, todo.seed(k * count + rank));
        const std::lock_guard lock(mutex);
        if (journal) journal->append(score);
        sums.add(score);
      },
      reporter(options, ranks, before, static_cast<double>(mine)), threads);
}

}  // namespace

CampaignResult campaign(const Scene& scene, const CampaignOptions& options, const Ranks& ranks) {
  validate(scene, options);
  const TrialPlan plan(scene, options.score_last_s, threads_of_rank(options.threads, ranks));
  require_same_scene(fingerprint(plan), ranks);

  // The first reads all journals before any rank adds to its own.
  MergedJournals merged;
  if (ranks.is_first()) merged = finished_trials(scene, options, fingerprint(plan));
  const std::int64_t resumed = ranks.from_first(merged.sums.trials);
  const Todo todo(ranks.from_first(bytes_of(merged.missing)));
  if (!options.merge_only) run_missing(plan, options, todo, ranks, merged.sums);

  CampaignResult result = result_of(of_all_ranks(merged.sums, ranks));
  result.resumed = resumed;
  if (options.merge_only) result.missing = todo.gaps();
  result.repeated = merged.repeated;
  result.damaged = std::move(merged.damaged);
  return result;
}

CampaignResult campaign(const Scene& scene, const CampaignOptions& options) {
  return campaign(scene, options, Ranks::alone());
}

}  // namespace leeway::sim
