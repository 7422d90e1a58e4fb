#include "leeway/logs/line_reader.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "leeway/earth/error.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::contains;
using test::TempDir;

std::vector<std::string> all_lines(LineReader& reader) {
  std::vector<std::string> lines;
  while (const auto line = reader.next()) lines.emplace_back(*line);
  return lines;
}

std::vector<std::string> all_lines(const std::filesystem::path& path) {
  LineReader reader(path);
  return all_lines(reader);
}

std::string numbered_lines(int count) {
  std::string text;
  for (int i = 1; i <= count; ++i) text += "line " + std::to_string(i) + "\n";
  return text;
}

using Lines = std::vector<std::string>;

TEST_CASE("lines come without their ends, and the last one needs none") {
  const TempDir dir;
  CHECK(all_lines(dir.file("a", "one\ntwo\n")) == Lines{"one", "two"});
  CHECK(all_lines(dir.file("b", "one\r\ntwo\r\n")) == Lines{"one", "two"});
  CHECK(all_lines(dir.file("c", "one\n\ntwo")) == Lines{"one", "", "two"});
  CHECK(all_lines(dir.file("d", "")).empty());
  CHECK(all_lines(dir.file("e", "\n")) == Lines{""});
  CHECK(all_lines(dir.file("f", "\xEF\xBB\xBFone\n")) == Lines{"one"});
}

TEST_CASE("gzip and plain files read alike, whatever their name") {
  const TempDir dir;
  const std::string text = numbered_lines(100'000);  // many times the buffer
  LineReader plain(dir.file("plain.gz", text));
  LineReader gzip(dir.gzip_file("gzip.csv", text));
  const Lines lines = all_lines(plain);
  REQUIRE(lines.size() == 100'000);
  CHECK(lines.back() == "line 100000");
  CHECK(all_lines(gzip) == lines);
  CHECK(plain.line_number() == 100'000);
  CHECK(plain.damage().empty());
  CHECK(gzip.damage().empty());
}

TEST_CASE("unread delivers a line again under its number") {
  const TempDir dir;
  LineReader reader(dir.file("a", "one\ntwo\n"));
  CHECK(reader.next() == "one");
  reader.unread();
  CHECK(reader.line_number() == 0);
  CHECK(reader.next() == "one");
  CHECK(reader.line_number() == 1);
  CHECK(reader.next() == "two");
}

TEST_CASE("a file that cannot be read is an error that names it and the reason") {
  const TempDir dir;
  const auto message = [](const std::filesystem::path& path) {
    return test::message_of<Error>([&] { LineReader reader(path); });
  };
  CHECK(message(dir / "absent.csv") ==
        (dir / "absent.csv").string() + ": cannot be opened: No such file or directory");
  CHECK(message(dir / "") == (dir / "").string() + ": is a directory, not a file");
}

TEST_CASE("a cut gzip stream delivers its whole lines and says where it ends") {
  const TempDir dir;
  const std::string text = numbered_lines(20'000);
  const std::string whole = test::read_file(dir.gzip_file("whole.gz", text));
  for (const double part : {0.1, 0.5, 0.9, 0.999}) {
    CAPTURE(part);
    const auto size = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
    LineReader reader(dir.file("cut.gz", whole.substr(0, size)));
    const Lines lines = all_lines(reader);
    REQUIRE(!lines.empty());
    std::string delivered;
    for (const std::string& line : lines) delivered += line + "\n";
    CHECK(text.starts_with(delivered));  // nothing but whole lines
    CHECK(contains(reader.damage(), "gzip stream ends early after line " +
                                        std::to_string(lines.size()) + "; the file is incomplete"));
  }
}

TEST_CASE("a corrupt gzip stream ends with a message, not silently") {
  const TempDir dir;
  const std::string text = numbered_lines(200'000);
  std::string bytes = test::read_file(dir.gzip_file("whole.gz", text));
  bytes[bytes.size() - 6] ^= 0x55;  // in the checksum, which is the last but one word
  LineReader reader(dir.file("corrupt.gz", bytes));
  const Lines lines = all_lines(reader);
  CHECK(contains(reader.damage(), "gzip stream is corrupt after line"));
  std::size_t delivered = 0;
  for (const std::string& line : lines) delivered += line.size() + 1;
  CHECK(text.size() - delivered <= 64 * 1024);  // one chunk of 32 KiB, and what is in the buffer
}

TEST_CASE("a line without an end ends the file with a message") {
  LineReader reader("/dev/zero");
  REQUIRE(reader.next());
  CHECK(reader.overlong());
  CHECK(!reader.next());
  CHECK(contains(reader.damage(), "/dev/zero: line 1 has no end within 64 MiB"));
}

TEST_CASE("an over-long line is cut, flagged and skipped in bounded memory") {
  const TempDir dir;
  for (const std::size_t excess : {std::size_t{1}, std::size_t{100'000}, std::size_t{10'000'000}}) {
    CAPTURE(excess);
    const std::string monster(LineReader::kMaxLineBytes + excess, 'x');
    LineReader reader(dir.file("a", "one\n" + monster + "\nthree\n"));
    CHECK(reader.next() == "one");
    CHECK(!reader.overlong());
    CHECK(reader.next()->size() == LineReader::kMaxLineBytes);
    CHECK(reader.overlong());
    CHECK(reader.next() == "three");
    CHECK(!reader.overlong());
    CHECK(reader.line_number() == 3);
    CHECK(!reader.next());
  }
  const std::string longest(LineReader::kMaxLineBytes, 'x');
  LineReader reader(dir.file("b", longest + "\nend"));
  CHECK(reader.next() == longest);
  CHECK(!reader.overlong());
  CHECK(reader.next() == "end");
}

}  // namespace
}  // namespace leeway
