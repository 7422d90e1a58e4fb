#include "leeway/sim/trials/trial_journal.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/temp_dir.hpp"

namespace leeway::sim {
namespace {

using test::contains;
using test::message_of;
using test::read_file;
using test::TempDir;

constexpr std::uint64_t kScene = 0x0123456789abcdef;

TrialScore score(std::uint64_t seed) {
  TrialScore s;
  s.seed = seed;
  s.epochs = 49;
  s.error_sq_n_m2 = {0.1, 1e-300, 1e300};
  s.variance_n_m2 = {std::nextafter(1.0, 2.0), 3.0, std::numeric_limits<double>::denorm_min()};
  s.nees = 15.0 / 7.0;
  s.nis = 6.1;
  s.nis_dof = 294;
  s.beyond_r95 = 2;
  s.largest_horizontal_m = 12.5;
  s.diverged = seed % 2 == 0;
  s.fused = 1000;
  s.gated = 3;
  return s;
}

bool same(const TrialScore& a, const TrialScore& b) {
  return a.seed == b.seed && a.epochs == b.epochs && a.error_sq_n_m2 == b.error_sq_n_m2 &&
         a.variance_n_m2 == b.variance_n_m2 && a.nees == b.nees && a.nis == b.nis &&
         a.nis_dof == b.nis_dof && a.beyond_r95 == b.beyond_r95 &&
         a.largest_horizontal_m == b.largest_horizontal_m && a.diverged == b.diverged &&
         a.finite == b.finite && a.fused == b.fused && a.gated == b.gated;
}

std::vector<TrialScore> read(const std::filesystem::path& path) {
  std::vector<TrialScore> scores;
  read_journal(path, kScene, [&](const TrialScore& s) { scores.push_back(s); });
  return scores;
}

/// A journal of seeds 1 to 3.
std::filesystem::path three(const TempDir& dir) {
  TrialJournal journal(dir / "journal", kScene);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) journal.append(score(seed));
  return dir / "journal";
}

}  // namespace

TEST_CASE("every number comes back to the bit") {
  const TempDir dir;
  TrialScore lost = score(4);
  lost.finite = false;
  lost.nees = std::nan("");
  lost.nis = std::numeric_limits<double>::infinity();
  {
    const auto path = three(dir);
    TrialJournal(path, kScene).append(lost);
  }
  const auto scores = read(dir / "journal");
  REQUIRE(scores.size() == 4);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) CHECK(same(scores[seed - 1], score(seed)));
  CHECK(std::isnan(scores[3].nees));
  CHECK(std::isinf(scores[3].nis));
  CHECK(!scores[3].finite);
}

TEST_CASE("cut anywhere, a journal keeps its whole lines and goes on" *
          doctest::test_suite("heavy")) {
  const TempDir dir;
  const std::string whole = read_file(three(dir));
  const std::size_t header = whole.find('\n') + 1;
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    CAPTURE(length);
    const auto path = dir.file("cut", whole.substr(0, length));
    const std::size_t lines = static_cast<std::size_t>(
        length < header ? 0
                        : std::count(whole.begin() + static_cast<std::ptrdiff_t>(header),
                                     whole.begin() + static_cast<std::ptrdiff_t>(length), '\n'));
    REQUIRE(read(path).size() == lines);
    TrialJournal(path, kScene).append(score(9));
    const auto scores = read(path);
    REQUIRE(scores.size() == lines + 1);
    REQUIRE(same(scores.back(), score(9)));
    for (std::size_t i = 0; i < lines; ++i) REQUIRE(same(scores[i], score(i + 1)));
  }
}

TEST_CASE("a damaged line costs its trial alone, whichever byte is hit" *
          doctest::test_suite("heavy")) {
  const TempDir dir;
  const std::string whole = read_file(three(dir));
  const std::size_t second = whole.find("\n2 ") + 1;
  const std::size_t third = whole.find("\n3 ") + 1;
  for (std::size_t at = second; at + 1 < third; ++at) {
    CAPTURE(at);
    std::string damaged = whole;
    damaged[at] = damaged[at] == '7' ? '8' : '7';
    const auto scores = read(dir.file("damaged", damaged));
    REQUIRE(scores.size() == 2);
    REQUIRE(same(scores[0], score(1)));
    REQUIRE(same(scores[1], score(3)));
  }
}

TEST_CASE("what is not this scene's journal is refused and left as it is") {
  const TempDir dir;
  const auto path = three(dir);
  const std::string content = read_file(path);
  CHECK(contains(message_of<Error>([&] { TrialJournal(path, kScene + 1); }), "another scene"));
  CHECK(contains(message_of<Error>([&] { read_journal(path, kScene + 1, {}); }), "another scene"));
  CHECK(read_file(path) == content);
  const auto other = dir.file("other", "t_s,gx_radps\n");
  CHECK(contains(message_of<Error>([&] { TrialJournal(other, kScene); }), "no campaign journal"));
  CHECK(contains(message_of<Error>([&] { read(other); }), "no campaign journal"));
  CHECK(read_file(other) == "t_s,gx_radps\n");
}

TEST_CASE("a journal in use, a folder, and a folder that is not there") {
  const TempDir dir;
  const TrialJournal held(dir / "held", kScene);
  CHECK(contains(message_of<Error>([&] { TrialJournal(dir / "held", kScene); }), "in use"));
  CHECK_THROWS_AS(TrialJournal(dir / "", kScene), JournalFailure);
  CHECK_THROWS_AS(TrialJournal(dir / "missing" / "journal", kScene), JournalFailure);
}

TEST_CASE("the journals of a campaign: its own, and those of ranks by number") {
  const TempDir dir;
  CHECK(journal_of_rank("a/journal", 0, 1) == "a/journal");
  CHECK(journal_of_rank("a/journal", 3, 4) == "a/journal.rank3");
  for (const char* name : {"journal", "journal.rank0", "journal.rank17", "journal.rank", "other",
                           "journal.rank1x", "journal2.rank1"}) {
    dir.file(name, "");
  }
  auto found = existing_journals(dir / "journal");
  std::sort(found.begin(), found.end());
  CHECK(found == std::vector<std::filesystem::path>{dir / "journal", dir / "journal.rank0",
                                                    dir / "journal.rank17"});
  CHECK(existing_journals(dir / "missing" / "journal").empty());
}

}  // namespace leeway::sim
