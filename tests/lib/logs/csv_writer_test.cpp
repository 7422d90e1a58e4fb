#include "leeway/logs/csv_writer.hpp"

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/logs/line_reader.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::contains;
using test::TempDir;

TEST_CASE("numbers are written with the decimals asked for, rounded, and never as -0") {
  const TempDir dir;
  CsvWriter csv(dir / "a.csv",
                {"t_s", {"whole", 0}, {"two", 2}, {"single", CsvColumn::kSingle}, "exact"});
  csv.write(time_from_seconds(1.0), std::array{2.6, -1.005, 0.1, 0.1 + 0.2});
  csv.write(time_from_seconds(-0.25), std::array{-0.4, -0.001, 1e-20, -1e300});
  csv.write(Time{Duration{-1}}, std::array{1e300, 1e17, std::nan(""), HUGE_VAL});
  csv.close();
  CHECK(test::read_file(dir / "a.csv") ==
        "t_s,whole,two,single,exact\n"
        "1,3,-1.00,0.1,0.30000000000000004\n"
        "-0.25,0,0.00,1e-20,-1e+300\n"
        "-0.000000001,1e+300,1e+17,nan,inf\n");
}

TEST_CASE("a row of the wrong width is misuse") {
  const TempDir dir;
  CsvWriter csv(dir / "a.csv", {"t_s", "x"});
  CHECK_THROWS_AS(csv.write(Time{}, std::array{1.0, 2.0}), Error);
  CHECK_THROWS_AS(CsvWriter(dir / "b.csv", {"t_s", {"x", 13}}), Error);
  CHECK(!std::filesystem::exists(dir / "b.csv.partial"));
}

TEST_CASE("exact columns read back bit for bit") {
  const TempDir dir;
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::uint64_t> bits;
  std::vector<double> values;
  while (values.size() < 20'000) {
    const double value = std::bit_cast<double>(bits(random));
    if (std::isfinite(value)) values.push_back(value);
  }
  CsvWriter csv(dir / "a.csv", {"t_s", "x"});
  for (const double value : values) csv.write(Time{}, std::array{value});
  csv.close();
  LineReader lines(dir / "a.csv");
  lines.next();
  for (const double value : values) {
    const auto line = lines.next();
    REQUIRE(line);
    double read = 0.0;
    std::from_chars(line->data() + 2, line->data() + line->size(), read);
    REQUIRE(std::bit_cast<std::uint64_t>(read) == std::bit_cast<std::uint64_t>(value));
  }
  CHECK(!lines.next());
}

TEST_CASE("the file appears whole on close and not at all without it") {
  const TempDir dir;
  dir.file("a.csv", "old");
  {
    CsvWriter csv(dir / "a.csv", {"t_s", "x"});
    csv.write(Time{}, std::array{1.0});
    CHECK(std::filesystem::exists(dir / "a.csv.partial"));
  }
  CHECK(!std::filesystem::exists(dir / "a.csv.partial"));
  CHECK(test::read_file(dir / "a.csv") == "old");
  CsvWriter csv(dir / "a.csv", {"t_s", "x"});
  CsvWriter moved(std::move(csv));
  moved.write(Time{}, std::array{1.0});
  CHECK(test::read_file(dir / "a.csv") == "old");
  moved.close();
  moved.close();
  CHECK(!std::filesystem::exists(dir / "a.csv.partial"));
  CHECK(test::read_file(dir / "a.csv") == "t_s,x\n0,1\n");
  CHECK_THROWS_AS(moved.write(Time{}, std::array{1.0}), Error);
}

TEST_CASE("a name in .gz makes gzip of the same text") {
  const TempDir dir;
  CsvWriter csv(dir / "a.csv.gz", {"t_s", "x"});
  for (int i = 0; i < 50'000; ++i) csv.write(Time{}, std::array{1.0});
  csv.close();
  CHECK(test::read_file(dir / "a.csv.gz").starts_with("\x1F\x8B"));
  LineReader lines(dir / "a.csv.gz");
  CHECK(lines.next() == "t_s,x");
  while (const auto line = lines.next()) REQUIRE(*line == "0,1");
  CHECK(lines.line_number() == 50'001);
  CHECK(lines.damage().empty());
}

TEST_CASE("a file that cannot be written is an error that names it and the reason") {
  const TempDir dir;
  CHECK(contains(test::message_of<Error>([&] { CsvWriter csv(dir / "absent/a.csv", {"t_s"}); }),
                 "absent/a.csv: cannot be created: No such file or directory"));
  for (const char* name : {"a.csv", "a.csv.gz"}) {
    CAPTURE(name);
    // A device that is always full stands in for a full disk.
    std::filesystem::create_symlink("/dev/full", (dir / name).string() + ".partial");
    CsvWriter csv(dir / name, {"t_s", "x"});
    const auto fill = [&] {
      for (int i = 0; i < 100'000; ++i) csv.write(Time{Duration{i}}, std::array{std::sqrt(i)});
      csv.close();
    };
    CHECK(contains(test::message_of<Error>(fill), "cannot be written: No space left on device"));
    CHECK(!std::filesystem::exists(dir / name));
  }
  {
    std::filesystem::create_symlink("/dev/full", (dir / "b.csv").string() + ".partial");
    CsvWriter csv(dir / "b.csv", {"t_s"});  // so short that it is written on close
    CHECK_THROWS_AS(csv.close(), Error);
    CHECK(!std::filesystem::exists(dir / "b.csv"));
  }
  std::filesystem::create_directory(dir / "c.csv");
  CsvWriter csv(dir / "c.csv", {"t_s"});
  CHECK(contains(test::message_of<Error>([&] { csv.close(); }), "cannot be renamed"));
  CHECK(!std::filesystem::exists(dir / "c.csv.partial"));
}

}  // namespace
}  // namespace leeway
