/// @file
/// The finished trials of a campaign on disk, so that a killed one loses none of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/sim/trials/trial.hpp"

namespace leeway::sim {

/// A journal that cannot be written. The trials in it are good.
struct JournalFailure : Error {
  using Error::Error;
};

/// A text file: a line with the fingerprint of the scene, then one line for each finished trial,
/// its numbers exact, a checksum at its end. Only ever appended to; a last line cut short by a kill
/// is cut off, and a damaged one costs its trial.
class TrialJournal {
 public:
  /// Opens or creates the file and keeps others from appending to it.
  /// @throws Error when it is a journal of another scene, no journal, or open elsewhere;
  /// JournalFailure when it cannot be opened or written.
  TrialJournal(const std::filesystem::path& path, std::uint64_t fingerprint);
  ~TrialJournal();
  TrialJournal(const TrialJournal&) = delete;
  TrialJournal& operator=(const TrialJournal&) = delete;

  /// One write: after it returns, a kill of the process does not lose the trial.
  /// @throws JournalFailure
  void append(const TrialScore& score);

 private:
  std::filesystem::path path_;
  int file_;
};

/// Whole lines of a journal that are no trials, whatever has hit them.
struct JournalDamage {
  std::filesystem::path path{};
  std::int64_t lines{0};
  std::int64_t first_line{0};  ///< the number of the first of them, from 1
};

/// Reader of a journal: calls f with every undamaged trial, in the order of the file.
/// @throws Error as the constructor above, or when the file cannot be read.
JournalDamage read_journal(const std::filesystem::path& path, std::uint64_t fingerprint,
                           const std::function<void(const TrialScore&)>& f);

/// The journal of a rank: the path itself for a process alone, path.rankN under MPI.
std::filesystem::path journal_of_rank(const std::filesystem::path& path, int rank, int ranks);

/// The journals there are for this path: its own and those of any number of ranks.
std::vector<std::filesystem::path> existing_journals(const std::filesystem::path& path);

}  // namespace leeway::sim
