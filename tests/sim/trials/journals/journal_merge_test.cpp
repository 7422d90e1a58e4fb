#include "sim/trials/journals/journal_merge.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "leeway/earth/error.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::sim {
namespace {

using test::contains;
using test::message_of;
using test::read_file;
using test::TempDir;

constexpr std::uint64_t kMergedScene = 0xfedcba9876543210;
using Path = std::filesystem::path;

TrialScore trial(std::uint64_t seed) {
  TrialScore score;
  score.seed = seed;
  score.epochs = 1;
  score.nees = 15.0 + static_cast<double>(seed);
  score.largest_horizontal_m = static_cast<double>(seed);
  return score;
}

Path journal_of(const Path& path, const std::vector<std::uint64_t>& seeds) {
  TrialJournal journal(path, kMergedScene);
  for (const std::uint64_t seed : seeds) journal.append(trial(seed));
  return path;
}

MergedJournals merge(const std::vector<Path>& journals, bool first_may_be_new = false) {
  return merge_journals(journals, first_may_be_new, kMergedScene, {1, 10});
}

}  // namespace

TEST_CASE("each trial counts once, whichever journals have it; others are not asked for") {
  const TempDir dir;
  const Path a = journal_of(dir / "a", {1, 2, 3});
  const Path b = journal_of(dir / "b", {3, 4, 99, 0});
  const Path c = journal_of(dir / "c", {8, 3});
  const MergedJournals merged = merge({a, b, c});
  CHECK(merged.sums.trials == 5);
  CHECK(merged.repeated == 2);
  CHECK(merged.damaged.empty());
  REQUIRE(merged.missing.size() == 2);
  CHECK(merged.missing[0].first == 5);
  CHECK(merged.missing[0].count == 3);
  CHECK(merged.missing[1].first == 9);
  CHECK(merged.missing[1].count == 2);
  // In any order.
  const MergedJournals turned = merge({c, b, a});
  CHECK(turned.sums.nees.value() == merged.sums.nees.value());
  CHECK(turned.sums.worst_seed == 8);
}

TEST_CASE("journals that differ in a trial are refused, with both names and the seed") {
  const TempDir dir;
  const Path a = journal_of(dir / "a", {1, 2, 3});
  const Path b = dir / "b";
  TrialScore other = trial(2);
  other.nees = std::nextafter(other.nees, 100.0);
  TrialJournal(b, kMergedScene).append(other);
  for (const auto& journals : {std::vector{a, b}, std::vector{b, a}}) {
    const std::string message = message_of<Error>([&] { merge(journals); });
    CAPTURE(message);
    CHECK(contains(message, a.string()));
    CHECK(contains(message, b.string()));
    CHECK(contains(message, "trial of seed 2,"));
  }
  // The third and the second agree, but the first is another.
  const Path c = dir / "c";
  TrialJournal(c, kMergedScene).append(other);
  CHECK(contains(message_of<Error>([&] { merge({a, b, c}); }), "seed 2,"));
  CHECK(merge({b, c}).repeated == 1);
}

TEST_CASE("a trial that is no number agrees with itself") {
  const TempDir dir;
  TrialScore lost = trial(1);
  lost.nees = std::nan("");
  lost.finite = false;
  for (const char* name : {"a", "b"}) TrialJournal(dir / name, kMergedScene).append(lost);
  const MergedJournals merged = merge({dir / "a", dir / "b"});
  CHECK(merged.repeated == 1);
  CHECK(merged.sums.not_finite == 1);
}

TEST_CASE("damaged lines are counted by file; journals behind each other are no damage") {
  const TempDir dir;
  const Path a = journal_of(dir / "a", {1, 2});
  std::string damaged = read_file(journal_of(dir / "b", {5, 6, 7}));
  damaged[damaged.find("\n6 ") + 3] = 'x';
  const Path b = dir.file("b", damaged + "what is this\n");
  const MergedJournals merged = merge({a, b});
  CHECK(merged.sums.trials == 4);
  REQUIRE(merged.damaged.size() == 1);
  CHECK(merged.damaged[0].path == b);
  CHECK(merged.damaged[0].lines == 2);
  CHECK(merged.damaged[0].first_line == 3);

  const Path both = dir.file("both", read_file(a) + read_file(journal_of(dir / "c", {3})));
  CHECK(merge({both}).sums.trials == 3);
  CHECK(merge({both}).damaged.empty());
}

TEST_CASE("a journal that is not there, a folder, another scene's") {
  const TempDir dir;
  const Path a = journal_of(dir / "a", {1});
  CHECK(merge({dir / "new", a}, true).sums.trials == 1);
  CHECK(contains(message_of<Error>([&] {
                   merge({a, dir / "gone"}, true);
                 }),
                 "gone: is not there; of several journals only the first may be new"));
  CHECK(contains(message_of<Error>([&] { merge({dir / "gone", a}); }), "gone: is not there"));
  CHECK(contains(message_of<Error>([&] { merge({dir / ""}); }), "is a folder"));
  TrialJournal(dir / "other", kMergedScene + 1).append(trial(2));
  const std::string message = message_of<Error>([&] { merge({a, dir / "other"}); });
  CHECK(contains(message, "other: is the journal of another scene"));
  CHECK(contains(message, "leave it out"));
}

TEST_CASE("a journal named twice is read once, and so are those of ranks") {
  const TempDir dir;
  const Path a = journal_of(dir / "a", {1, 2});
  const Path rank = journal_of(dir / "a.rank0", {3});
  const MergedJournals merged = merge({a, rank, dir / "." / "a"});
  CHECK(merged.sums.trials == 3);
  CHECK(merged.repeated == 0);
  // Without the journal that they are named after, too.
  journal_of(dir / "b.rank0", {4});
  journal_of(dir / "b.rank1", {5});
  CHECK(merge({dir / "b"}).sums.trials == 2);
}

}  // namespace leeway::sim
