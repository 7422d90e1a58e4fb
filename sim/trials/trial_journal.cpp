#include "leeway/sim/trials/trial_journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "sim/trials/fingerprint.hpp"

namespace leeway::sim {
namespace {

constexpr std::string_view kTitle = "leeway campaign journal, scene ";

template <class T>
void put(std::string& line, T value) {
  std::array<char, 32> text;
  std::to_chars_result end{};
  if constexpr (std::is_floating_point_v<T>) {
    end = std::to_chars(text.begin(), text.end(), value, std::chars_format::hex);
  } else {
    end = std::to_chars(text.begin(), text.end(), value);
  }
  line.append(text.begin(), end.ptr);
  line += ' ';
}

/// Takes the next number and the space behind it off the line.
template <class T>
bool take(std::string_view& line, T& value) {
  std::from_chars_result end{};
  if constexpr (std::is_floating_point_v<T>) {
    end = std::from_chars(line.begin(), line.end(), value, std::chars_format::hex);
  } else {
    end = std::from_chars(line.begin(), line.end(), value);
  }
  if (end.ec != std::errc{} || end.ptr == line.end() || *end.ptr != ' ') return false;
  line.remove_prefix(static_cast<std::size_t>(end.ptr - line.begin()) + 1);
  return true;
}

/// The one list of what a line holds, for both directions.
template <class Score, class F>
void for_each_field(Score& score, F&& f) {
  f(score.seed);
  f(score.epochs);
  for (Eigen::Index i = 0; i < 3; ++i) f(score.error_sq_n_m2[i]);
  for (Eigen::Index i = 0; i < 3; ++i) f(score.variance_n_m2[i]);
  f(score.nees);
  f(score.nis);
  f(score.nis_dof);
  f(score.beyond_r95);
  f(score.largest_horizontal_m);
  f(score.fused);
  f(score.gated);
}

std::string line_of(const TrialScore& score) {
  std::string line;
  for_each_field(score, [&line](const auto& value) { put(line, value); });
  put(line, score.diverged ? 1 : 0);
  put(line, score.finite ? 1 : 0);
  put(line, hash_of(line));
  line.back() = '\n';
  return line;
}

/// @param line  with a space in place of its newline
bool parse(std::string_view line, TrialScore& score) {
  const std::string_view whole = line;
  bool good = true;
  for_each_field(score, [&](auto& value) { good = good && take(line, value); });
  int diverged = 0;
  int finite = 0;
  good = good && take(line, diverged) && take(line, finite);
  score.diverged = diverged != 0;
  score.finite = finite != 0;
  const std::size_t checked = whole.size() - line.size();
  std::uint64_t checksum = 0;
  good = good && take(line, checksum) && line.empty();
  return good && checksum == hash_of(whole.substr(0, checked));
}

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
              "another file, or remove this one to start anew");
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

void TrialJournal::append(const TrialScore& score) { write_all(path_, file_, line_of(score)); }

void read_journal(const std::filesystem::path& path, std::uint64_t fingerprint,
                  const std::function<void(const TrialScore&)>& f) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path.string() + ": cannot be read");
  const std::string header = header_of(fingerprint);
  std::string start(header.size(), '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  if (!check_header(path, start, header)) return;
  for (std::string line; std::getline(file, line) && !file.eof();) {
    TrialScore score;
    if (parse(line + ' ', score)) f(score);
  }
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
