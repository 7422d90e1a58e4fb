#include "leeway/logs/scalar_log.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "leeway/earth/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::contains;
using test::TempDir;

const ScalarColumns kSpeed{"speed_mps", "sigma_mps", 500.0};

TEST_CASE("a value is enough; its sigma may be missing in the log or in a row") {
  const TempDir dir;
  ScalarLogReader bare(dir.file("a.csv", "gear,speed_mps,t_s\n3,-1.5,0.25\n"), kSpeed);
  const auto only = bare.next();
  REQUIRE(only);
  CHECK(only->time == time_from_seconds(0.25));
  CHECK(only->value == -1.5);
  CHECK(std::isnan(only->sigma));
  CHECK_FALSE(bare.next());

  ScalarLogReader full(dir.file("b.csv", "t_s,speed_mps,sigma_mps\n0,1,0.5\n1,2,\n"), kSpeed);
  CHECK(full.next()->sigma == 0.5);
  CHECK(std::isnan(full.next()->sigma));
  CHECK(full.summary().records == 2);
}

TEST_CASE("a damaged line costs that line") {
  const TempDir dir;
  const auto path = dir.file("a.csv",
                             "t_s,speed_mps,sigma_mps\n"
                             "0,1,0.1\n"
                             "1,x,0.1\n"
                             "2,nan,0.1\n"
                             "3,501,0.1\n"
                             "4,2,0\n"
                             "0.5,2,0.1\n"
                             "5,3,0.1\n");
  ScalarLogReader reader(path, kSpeed);
  CHECK(reader.next()->value == 1.0);
  CHECK(reader.next()->value == 2.0);  // at 0.5 s
  CHECK(reader.next()->value == 3.0);
  CHECK_FALSE(reader.next());
  CHECK(reader.summary().damaged_lines() == 4);
}

TEST_CASE("a log of something else is refused, naming the column") {
  const TempDir dir;
  const auto path = dir.file("log.csv", "t_s,temperature\n0,3\n");
  const std::string message = test::message_of<Error>([&] { ScalarLogReader(path, kSpeed); });
  CHECK(contains(message, path.string()));
  CHECK(contains(message, "missing columns speed_mps"));
}

}  // namespace
}  // namespace leeway
