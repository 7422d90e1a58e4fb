#include "sim/trials/journals/journal_merge.hpp"

#include <map>
#include <set>
#include <string>
#include <utility>

#include "leeway/earth/error.hpp"
#include "sim/trials/fingerprint.hpp"
#include "sim/trials/journals/journal_line.hpp"
#include "sim/trials/journals/seed_set.hpp"

namespace leeway::sim {
namespace {

using std::filesystem::path;

/// The files to read, each once however it is named.
std::vector<path> files_of(const std::vector<path>& journals, bool first_may_be_new) {
  std::vector<path> files;
  std::set<path> known;
  for (const path& journal : journals) {
    if (is_directory(journal)) {
      throw Error(journal.string() + ": is a folder; name the journals in it");
    }
    const std::vector<path> there = existing_journals(journal);
    if (there.empty() && !(first_may_be_new && &journal == &journals.front())) {
      throw Error(journal.string() + ": is not there; " +
                  (first_may_be_new ? "of several journals only the first may be new"
                                    : "to merge only, every journal must be"));
    }
    for (const path& file : there) {
      if (known.insert(weakly_canonical(file)).second) files.push_back(file);
    }
  }
  return files;
}

/// Trials that stand in several lines: what the second of them says, and where.
class RepeatedTrials {
 public:
  /// A line for a seed that an earlier line had.
  void add(const TrialScore& score, const path& file) {
    const auto [known, is_new] = lines_.try_emplace(score.seed, hash_of(line_of(score)), file);
    if (!is_new) compare(known, score, file);
  }

  /// Any line, once all are added.
  void compare(const TrialScore& score, const path& file) const {
    const auto known = lines_.find(score.seed);
    if (known != lines_.end()) compare(known, score, file);
  }

  bool empty() const { return lines_.empty(); }

 private:
  using Lines = std::map<std::uint64_t, std::pair<std::uint64_t, path>>;

  static void compare(Lines::const_iterator known, const TrialScore& score, const path& file) {
    const auto& [hash, other] = known->second;
    if (hash == hash_of(line_of(score))) return;
    throw Error(file.string() + " and " + other.string() + ": differ in the trial of seed " +
                std::to_string(score.seed) +
                ", so they come from programs or machines that compute differently; leave one of "
                "them out, and its seeds are run again");
  }

  Lines lines_{};
};

}  // namespace

MergedJournals merge_journals(const std::vector<path>& journals, bool first_may_be_new,
                              std::uint64_t fingerprint, const SeedRange& wanted) {
  MergedJournals merged;
  SeedSet finished;
  RepeatedTrials repeated;
  const auto is_wanted = [&wanted](const TrialScore& score) {
    return score.seed - wanted.first < wanted.count;
  };
  const std::vector<path> files = files_of(journals, first_may_be_new);
  for (const path& file : files) {
    const JournalDamage damage = read_journal(file, fingerprint, [&](const TrialScore& score) {
      if (!is_wanted(score)) return;
      if (finished.insert(score.seed)) return merged.sums.add(score);
      ++merged.repeated;
      repeated.add(score, file);
    });
    if (damage.lines > 0) merged.damaged.push_back(damage);
  }
  merged.missing = finished.missing(wanted);
  if (repeated.empty()) return merged;
  for (const path& file : files) {
    read_journal(file, fingerprint, [&](const TrialScore& score) {
      if (is_wanted(score)) repeated.compare(score, file);
    });
  }
  return merged;
}

}  // namespace leeway::sim
