#include <doctest/doctest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "tests/sim/cli/mpi.hpp"
#include "tests/sim/cli/program.hpp"

namespace leeway::test {
namespace {

/// The first minutes of the defined case; a trial takes milliseconds.
std::string campaign(int trials, int duration_s = 240) {
  return "campaign --scene " +
         quoted(std::filesystem::path(LEEWAY_SCENES_DIR) / "square-loop.toml") + " --at " +
         std::to_string(duration_s) + " --interval-s 10 --trials " + std::to_string(trials) + " ";
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

std::size_t lines_in(const std::filesystem::path& path) { return count(read_file(path), "\n"); }

/// The program as a child of this process, its output thrown away.
class Child {
 public:
  explicit Child(const std::string& arguments) : pid_(fork()) {
    if (pid_ != 0) return;
    const std::string command =
        "exec " + quoted(LEEWAY_PROGRAM) + " " + arguments + " >/dev/null 2>&1";
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }

  void kill_at_once() const { kill(pid_, SIGKILL); }

  bool is_running() {
    if (!ended_) ended_ = wait4(pid_, &status_, WNOHANG, &usage_) == pid_;
    return !ended_;
  }

  /// Of a process that ran to its end with success.
  long peak_memory_kib() {
    if (!ended_) wait4(pid_, &status_, 0, &usage_);
    ended_ = true;
    REQUIRE(WIFEXITED(status_));
    REQUIRE(WEXITSTATUS(status_) == 0);
    return usage_.ru_maxrss;
  }

 private:
  pid_t pid_;
  bool ended_{false};
  int status_{0};
  rusage usage_{};
};

}  // namespace

TEST_CASE("campaign --json: the contract") {
  const auto object = leeway(campaign(20) + "--first-seed 5 --score-last-s 100 --json").json();
  CHECK(object.at("command") == "campaign");
  CHECK(object.at("input").at("trials") == 20);
  CHECK(object.at("input").at("first_seed") == 5);
  CHECK(object.at("input").at("score_last_s") == 100.0);
  CHECK(object.at("input").at("gnss").at("interval_s") == 10.0);
  const auto& results = object.at("results");
  CHECK(results.at("trials") == 20);
  CHECK(results.at("epochs") == 20 * 11);
  CHECK(results.at("fixes_fused") == 20 * 24);
  CHECK(results.at("trials_diverged") == 0);
  CHECK(results.at("rms_ned_m").size() == 3);
  CHECK(results.at("sigma_ned_m").size() == 3);
  CHECK(results.at("nees_band").size() == 2);
  // 20 trials: a ratio of RMS to sigma of 1 within four of its deviations, 1 / (2 sqrt(20)).
  CHECK(results.at("rms_over_sigma") > 1.0 - 4.0 * 0.112);
  CHECK(results.at("rms_over_sigma") < 1.0 + 4.0 * 0.112);
  CHECK(results.at("worst_seed") >= 5);
  CHECK(results.at("worst_seed") < 25);
}

TEST_CASE("campaign prints what was found beside what an honest filter gives") {
  const Outcome outcome = leeway(campaign(5));
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
  for (const char* text : {"square loop", "5 trials, seeds 1 to 5", "RMS / sigma", "NEES", "NIS",
                           "R95", "Diverged: 0 trials", "million filter steps per second"}) {
    CAPTURE(text);
    CHECK(contains(outcome.out, text));
  }
}

TEST_CASE("the same bytes on any number of threads and ranks" * doctest::test_suite("heavy")) {
  const std::string one = leeway(campaign(30) + "--threads 1 --json").out;
  CHECK(contains(one, "rms_over_sigma"));
  CHECK(leeway(campaign(30) + "--threads 2 --json").out == one);
  if (!has_mpi()) {
    MESSAGE("skipped: no mpirun, or built without MPI");
    return;
  }
  for (const int ranks : {1, 2, 4}) {
    CAPTURE(ranks);
    const Outcome outcome = leeway(campaign(30) + "--json", mpirun(ranks));
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.out == one);
  }
  CHECK(leeway(campaign(30) + "--threads 2 --json", mpirun(2)).out == one);
}

TEST_CASE("killed half-way, a campaign goes on from its finished trials, losing none" *
          doctest::test_suite("heavy")) {
  const TempDir dir;
  const std::string arguments = campaign(300) + "--threads 2 --journal " + quoted(dir / "journal");
  Child child(arguments);
  while (lines_in(dir / "journal") < 31 && child.is_running()) {
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  child.kill_at_once();
  while (child.is_running()) std::this_thread::yield();
  const std::size_t finished = lines_in(dir / "journal") - 1;  // without the header
  CHECK(finished >= 30);
  REQUIRE(finished < 300);
  // What a kill in the middle of a write leaves.
  std::ofstream(dir / "journal", std::ios::app) << "17 2400 1.8p";

  const Outcome resumed = leeway(arguments);
  CHECK(contains(resumed.out, "Computed: " + std::to_string(300 - finished) + " trials"));
  CHECK(contains(resumed.out, std::to_string(finished) + " from the journal"));
  CHECK(lines_in(dir / "journal") == 301);
  const std::string uninterrupted = leeway(campaign(300) + "--threads 1 --json").out;
  CHECK(leeway(arguments + " --json").out == uninterrupted);
}

TEST_CASE("ranks keep a journal each, and any number of them resumes from all" *
          doctest::test_suite("heavy")) {
  if (!has_mpi()) {
    MESSAGE("skipped: no mpirun, or built without MPI");
    return;
  }
  const TempDir dir;
  const std::string journal = " --journal " + quoted(dir / "journal");
  const std::string uninterrupted = leeway(campaign(24) + "--json").out;
  CHECK(leeway(campaign(7) + journal, mpirun(2)).exit_code == 0);
  CHECK(lines_in(dir / "journal.rank0") + lines_in(dir / "journal.rank1") == 7 + 2);
  CHECK(contains(leeway(campaign(16) + journal, mpirun(4)).out, "7 from the journal"));
  CHECK(leeway(campaign(24) + journal + " --json").out == uninterrupted);
  CHECK(lines_in(dir / "journal") == 8 + 1);
  CHECK(contains(leeway(campaign(24) + journal, mpirun(2)).out, "Computed: 0 trials"));
}

TEST_CASE("array jobs with a journal each, merged, are one campaign to the byte" *
          doctest::test_suite("heavy")) {
  const TempDir dir;
  const auto job = [&](int first_seed, int trials, const std::string& name) {
    return leeway(campaign(trials) + "--first-seed " + std::to_string(first_seed) + " --journal " +
                  quoted(dir / name));
  };
  for (const int id : {0, 1, 2}) {
    CHECK(job(1 + 8 * id, 8, "job-" + std::to_string(id)).exit_code == 0);
  }
  const std::string single = leeway(campaign(24) + "--json").out;
  const std::string commas = "--journal " + quoted(dir / "job-0") + "," + quoted(dir / "job-1") +
                             "," + quoted(dir / "job-2");
  CHECK(leeway(campaign(24) + commas + " --json").out == single);
  CHECK(leeway(campaign(24) + commas + " --merge-only --json").out == single);
  const std::string spaces = "--journal " + (dir / "job-").string() + "[0-2]";
  const Outcome merged = leeway(campaign(24) + spaces);
  CHECK(merged.exit_code == 0);
  CHECK(merged.err.empty());
  CHECK(contains(merged.out, "Computed: 0 trials"));
  CHECK(contains(merged.out, "24 from the journal"));
  if (!has_mpi()) return;
  CHECK(leeway(campaign(24) + commas + " --merge-only --json", mpirun(2)).out == single);
}

TEST_CASE("with --merge-only, seeds that no journal has are named, nothing is run or written") {
  const TempDir dir;
  const auto job = [&](int first_seed, const std::string& name) {
    leeway(campaign(4) + "--first-seed " + std::to_string(first_seed) + " --journal " +
           quoted(dir / name));
  };
  job(1, "a");
  job(4, "b");
  const std::string before = read_file(dir / "a");
  const std::string both = "--journal " + quoted(dir / "a") + "," + quoted(dir / "b") + " ";
  const Outcome part = leeway(campaign(9) + both + "--merge-only");
  CHECK(part.exit_code == 2);
  CHECK(contains(part.err, "2 of 9 trials are missing, seeds 8 to 9: run their jobs again"));
  CHECK(contains(part.out, "7 trials, seeds 1 to 9 without 8 to 9"));
  CHECK(contains(part.out, "Lines of journals that repeat a trial: 1"));
  const auto results = leeway(campaign(9) + both + "--merge-only --json").json().at("results");
  CHECK(results.at("trials") == 7);
  CHECK(results.at("seeds_missing") == nlohmann::json::parse("[[8, 9]]"));
  CHECK(read_file(dir / "a") == before);
  // Run now, they go to the first.
  const Outcome whole = leeway(campaign(9) + both + "--json");
  CHECK(whole.exit_code == 0);
  CHECK(whole.json().at("results").at("seeds_missing").empty());
  CHECK(lines_in(dir / "a") == 1 + 4 + 2);
  CHECK(lines_in(dir / "b") == 1 + 4);
}

TEST_CASE("journals that do not go together say what to do") {
  const TempDir dir;
  const auto merge = [&](const std::string& names) {
    return leeway(campaign(4) + "--merge-only --journal " + names);
  };
  const std::string a = quoted(dir / "a");
  leeway(campaign(4) + "--journal " + a);
  leeway(campaign(4) + "--imu marine --journal " + quoted(dir / "marine"));
  const Outcome other = merge(a + "," + quoted(dir / "marine"));
  CHECK(other.exit_code == 1);
  CHECK(contains(other.err, "marine: is the journal of another scene"));
  CHECK(contains(other.err, "leave it out"));
  const Outcome gone = merge(a + "," + quoted(dir / "gone"));
  CHECK(gone.exit_code == 1);
  CHECK(contains(gone.err, "gone: is not there"));

  std::string text = read_file(dir / "a");
  text[text.find("\n2 ") + 3] = 'x';
  dir.file("hit", text);
  const Outcome hit = merge(quoted(dir / "hit"));
  CHECK(hit.exit_code == 2);
  CAPTURE(hit.err);
  CHECK(contains(hit.err, ": damaged; its trial is missing"));
  CHECK(contains(hit.err, "1 of 4 trials are missing, seeds 2:"));
  CHECK(contains(leeway(campaign(4) + "--journal " + quoted(dir / "hit")).err, "was run again"));

  const Outcome alone = leeway(campaign(4) + "--merge-only");
  CHECK(alone.exit_code == 1);
  CHECK(contains(alone.err, "--journal"));
}

TEST_CASE("ranks with other scenes end, and say so" * doctest::test_suite("heavy")) {
  if (!has_mpi()) {
    MESSAGE("skipped: no mpirun, or built without MPI");
    return;
  }
  const Outcome outcome =
      leeway(campaign(20) + "--json : -n 1 " + quoted(LEEWAY_PROGRAM) + " " + campaign(20, 200),
             mpirun(1));
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.out.empty());
  CHECK(contains(outcome.err, "rank 1 has another scene than the first"));
}

TEST_CASE("a rank that fails ends all, with one message and its exit code" *
          doctest::test_suite("heavy")) {
  if (!has_mpi()) {
    MESSAGE("skipped: no mpirun, or built without MPI");
    return;
  }
  const TempDir dir;
  const auto check = [](const Outcome& outcome, int exit_code, const std::string& message) {
    CAPTURE(outcome.err);
    CHECK(outcome.exit_code == exit_code);
    CHECK(count(outcome.err, "leeway: ") == 1);
    CHECK(contains(outcome.err, message));
    CHECK(outcome.out.empty());
  };
  // All alike, before and after MPI is started; then one alone.
  check(leeway("campaign --scenes x", mpirun(4)), 1, "--scene");
  check(leeway("campaign --scene missing.toml", mpirun(4)), 1, "missing.toml");
  std::filesystem::create_directory(dir / "journal.rank3");
  check(leeway(campaign(200) + "--journal " + quoted(dir / "journal"), mpirun(4)), 3,
        "journal.rank3");
}

TEST_CASE("a journal that is none, of another scene, or on a full disk") {
  const TempDir dir;
  const auto csv = dir.file("imu.csv", "t_s,gx_radps\n");
  const Outcome none = leeway(campaign(1) + "--journal " + quoted(csv));
  CHECK(none.exit_code == 1);
  CHECK(contains(none.err, "imu.csv: is no campaign journal"));
  CHECK(read_file(csv) == "t_s,gx_radps\n");

  const std::string journal = "--journal " + quoted(dir / "journal");
  CHECK(leeway(campaign(1) + journal).exit_code == 0);
  const Outcome other = leeway(campaign(1) + "--imu marine " + journal);
  CHECK(other.exit_code == 1);
  CHECK(contains(other.err, "another scene"));

  // Half a block of 512 bytes is a header and a trial.
  const Outcome full =
      leeway(campaign(50) + "--journal " + quoted(dir / "full"), "trap '' XFSZ; ulimit -f 1; ");
  CHECK(full.exit_code == 3);
  CHECK(contains(full.err, "the journal cannot be written"));
}

TEST_CASE("options out of range, and a scene with nothing to score") {
  for (const char* options :
       {"--trials 0", "--trials 1.5", "--threads -1", "--score-last-s 0", "--first-seed -3"}) {
    CAPTURE(options);
    const Outcome outcome = leeway(campaign(1) + options);
    CHECK(outcome.exit_code == 1);
    CHECK(contains(outcome.err, "leeway: "));
  }
  const Outcome too_short = leeway(campaign(1, 15));
  CHECK(too_short.exit_code == 1);
  CHECK(contains(too_short.err, "two GNSS intervals"));
}

TEST_CASE("ten times the trials take the same memory" * doctest::test_suite("heavy")) {
  // Pages come and go with the machine: the least of three. The 1800 scores of 160 bytes alone
  // would be more.
  const auto peak_kib = [](int trials) {
    const auto once = [trials] {
      return Child(campaign(trials, 20) + "--threads 2").peak_memory_kib();
    };
    return std::min({once(), once(), once()});
  };
  CHECK(peak_kib(2000) - peak_kib(200) < 256);
}

}  // namespace leeway::test
