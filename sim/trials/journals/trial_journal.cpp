#include "leeway/sim/trials/trial_journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "sim/trials/journals/journal_line.hpp"

namespace leeway::sim {
namespace {

constexpr std::string_view kTitle = "leeway campaign journal, scene ";

std::string header_of(std::uint64_t fingerprint) {
  std::array<char, 17> hex{};
  std::snprintf(hex.data(), hex.size(), "%016llx", static_cast<unsigned long long>(fingerprint));
  return std::string(kTitle) + hex.data() + "\n";
}

/// @returns whether the file begins with the header; false when it ends within it.
bool check_header(const std::filesystem::path& path, std::string_view start,
                  std::string_view header) {
  if (start.size() < header.size() && header.starts_with(start)) return false;
  if (start == header) return true;
  if (!start.starts_with(kTitle)) {
    throw Error(path.string() + ": is no campaign journal; give another file");
  }
  throw Error(path.string() +
              ": is the journal of another scene, scoring window or version of the program; give "
              "the options it was made with, leave it out, or remove it to start anew");
}

[[noreturn]] void fail(const std::filesystem::path& path, const char* what) {
  throw JournalFailure(path.string() + ": the journal cannot be " + what + ": " +
                       std::strerror(errno));
}

std::string read_start(int file, std::size_t size) {
  std::string start(size, '\0');
  const ssize_t count = pread(file, start.data(), size, 0);
  start.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  return start;
}

/// Length of the file without a last line that has no end.
off_t whole_lines(int file) {
  std::array<char, 4096> block;
  off_t length = lseek(file, 0, SEEK_END);
  while (length > 0) {
    const off_t from = std::max<off_t>(0, length - static_cast<off_t>(block.size()));
    const ssize_t count = pread(file, block.data(), static_cast<std::size_t>(length - from), from);
    for (ssize_t i = count; i > 0; --i) {
      if (block[static_cast<std::size_t>(i - 1)] == '\n') return from + i;
    }
    length = from;
  }
  return 0;
}

void write_all(const std::filesystem::path& path, int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = write(file, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, "written");
    text.remove_prefix(static_cast<std::size_t>(count));
  }
}

}  // namespace

TrialJournal::TrialJournal(const std::filesystem::path& path, std::uint64_t fingerprint)
    : path_(path), file_(open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666)) {
  if (file_ < 0) fail(path_, "opened");
  try {
    if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
      throw Error(path_.string() + ": is in use by another campaign; give each its own journal");
    }
    const std::string header = header_of(fingerprint);
    const bool has_header = check_header(path_, read_start(file_, header.size()), header);
    if (ftruncate(file_, has_header ? whole_lines(file_) : 0) != 0) fail(path_, "written");
    if (!has_header) write_all(path_, file_, header);
  } catch (...) {
    close(file_);
    throw;
  }
}

TrialJournal::~TrialJournal() { close(file_); }

void TrialJournal::append(const TrialScore& score) {
  write_all(path_, file_, line_of(score) + "\n");
}

JournalDamage read_journal(const std::filesystem::path& path, std::uint64_t fingerprint,
                           const std::function<void(const TrialScore&)>& f) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path.string() + ": cannot be read");
  const std::string header = header_of(fingerprint);
  std::string start(header.size(), '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  JournalDamage damage{path, 0, 0};
  if (!check_header(path, start, header)) return damage;
  std::int64_t number = 1;
  for (std::string line; std::getline(file, line) && !file.eof();) {
    ++number;
    if (line + '\n' == header) continue;  // of journals that were put behind each other
    TrialScore score;
    if (parse_line(line, score)) {
      f(score);
    } else if (damage.lines++ == 0) {
      damage.first_line = number;
    }
  }
  return damage;
}

std::filesystem::path journal_of_rank(const std::filesystem::path& path, int rank, int ranks) {
  if (ranks == 1) return path;
  std::filesystem::path own = path;
  own += ".rank" + std::to_string(rank);
  return own;
}

std::vector<std::filesystem::path> existing_journals(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> journals;
  if (std::filesystem::exists(path)) journals.push_back(path);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const std::string prefix = path.filename().string() + ".rank";
  std::error_code none;  // a folder that is not there has no journals
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    const bool numbered = name.starts_with(prefix) && name.size() > prefix.size() &&
                          std::all_of(name.begin() + static_cast<std::ptrdiff_t>(prefix.size()),
                                      name.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (numbered) journals.push_back(entry.path());
  }
  return journals;
}

}  // namespace leeway::sim
