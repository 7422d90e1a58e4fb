#include "sim/trials/shared_trials.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#include "sim/tools/shared_work.hpp"
#include "sim/trials/fingerprint.hpp"
#include "sim/trials/journals/journal_line.hpp"

namespace leeway::sim {
namespace {

std::string packed_trial(const SharedTrial& trial) {
  std::string bytes = line_of(trial.score) + '\n';
  const std::size_t text = bytes.size();
  bytes.resize(text + trial.of_fixes.size() * sizeof(double));
  // Not memcpy: it takes no null pointer, which the data of no numbers is.
  const char* const first = reinterpret_cast<const char*>(trial.of_fixes.data());
  std::copy(first, first + (bytes.size() - text), bytes.data() + text);
  return bytes;
}

SharedTrial shared_trial_of(const std::string& bytes) {
  SharedTrial trial;
  const std::size_t text = bytes.find('\n') + 1;
  parse_line(bytes.substr(0, text - 1), trial.score);
  trial.of_fixes.resize((bytes.size() - text) / sizeof(double));
  std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(text), bytes.end(),
            reinterpret_cast<char*>(trial.of_fixes.data()));
  return trial;
}

}  // namespace

void require_same_scene(std::uint64_t fingerprint, const Ranks& ranks) {
  if (ranks.from_first(fingerprint) == fingerprint) return;
  throw RankFailure("rank " + std::to_string(ranks.rank()) +
                        " has another scene than the first: start all ranks with the same options "
                        "and files, on machines with the same mathematical library",
                    1);
}

std::vector<SharedTrial> shared_trials(const TrialPlan& plan, const SeedRange& seeds,
                                       const OfFix& of_fix, const Ranks& ranks,
                                       const std::function<void(double)>& progress, int threads) {
  require_same_scene(fingerprint(plan), ranks);
  const auto run = [&](std::size_t k) {
    SharedTrial trial;
    std::size_t fix = 0;
    trial.score = run_trial(plan, seeds.first + k, [&](const TrialEpoch& epoch) {
      if (const std::optional<double> value = of_fix(fix++, epoch)) {
        trial.of_fixes.push_back(*value);
      }
    });
    return packed_trial(trial);
  };
  std::vector<SharedTrial> trials;
  for (const std::string& bytes :
       shared_work(static_cast<std::size_t>(seeds.count), run, ranks, progress, threads)) {
    trials.push_back(shared_trial_of(bytes));
  }
  return trials;
}

}  // namespace leeway::sim
