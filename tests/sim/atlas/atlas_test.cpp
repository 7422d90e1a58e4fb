#include "leeway/sim/atlas/atlas.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/sim/atlas/atlas_expected.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::sim {
namespace {

const std::filesystem::path kDocs{LEEWAY_DOCS_DIR};

std::vector<AtlasResult> run_briefly(const std::vector<std::string>& keys, int threads = 1) {
  return run_atlas(atlas_scenes(keys), {.brief = true}, threads);
}

double figure_of(const AtlasResult& result, const std::string& variant,
                 const std::string& condition) {
  const auto found =
      std::find_if(result.cells.begin(), result.cells.end(), [&](const AtlasCell& cell) {
        return cell.variant == variant && cell.condition == condition;
      });
  REQUIRE(found != result.cells.end());
  return found->figure;
}

std::vector<std::string> fields_of(const std::string& row) {
  std::vector<std::string> fields;
  std::istringstream text(row);
  for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
  return fields;
}

/// Whether the scene's section has a row of the variant with this verdict.
/// @param row  form, scene, variant, condition, verdict, ..
bool documents(const std::string& page, const std::vector<std::string>& row) {
  const std::size_t section = page.find("\n`" + row[1] + "`");
  if (section == std::string::npos) return false;
  const std::size_t variant = page.find("\n| " + row[2] + " |", section);
  if (variant == std::string::npos) return false;
  const std::size_t end = page.find('\n', variant + 1);
  return test::contains(std::string_view(page).substr(variant, end - variant), row[4]);
}

}  // namespace

TEST_CASE("atlas: a figure's verdict, and when a failure is silent") {
  const AtlasLimits limits{1.0, 2.0, "for the test"};
  CHECK(verdict_of(limits, 1.0) == AtlasVerdict::kSurvives);
  CHECK(verdict_of(limits, 2.0) == AtlasVerdict::kDegrades);
  CHECK(verdict_of(limits, 2.1) == AtlasVerdict::kFails);
  CHECK(verdict_of(limits, std::numeric_limits<double>::quiet_NaN()) == AtlasVerdict::kFails);
  AtlasCell cell{AtlasGroup::kEkf, "Ekf", "", 3.0, ""};
  CHECK(fails_silently(limits, cell));
  cell.reported = "NIS high";
  CHECK(!fails_silently(limits, cell));
  cell = {AtlasGroup::kNotOffered, "a method of others", "", 3.0, ""};
  CHECK(!fails_silently(limits, cell));
}

TEST_CASE("atlas: an unknown scene is refused with the nearest one") {
  CHECK_THROWS_WITH_AS(atlas_scenes({"parked-rtx"}),
                       doctest::Contains("did you mean 'parked-rtk'?"), Error);
}

TEST_CASE("atlas: keys and places are unique, every scene has limits with a reason and a page") {
  std::set<std::string> keys;
  std::set<int> places;
  for (const AtlasScene& scene : atlas_scenes()) {
    CAPTURE(scene.key);
    CHECK(keys.insert(scene.key).second);
    CHECK(places.insert(scene.place).second);
    CHECK(scene.limits.survives < scene.limits.degrades);
    CHECK(!scene.limits.reason.empty());
    const std::filesystem::path page = kDocs / "atlas" / (scene.key + ".md");
    REQUIRE(std::filesystem::exists(page));
    CHECK(test::contains(test::read_file(page), "leeway atlas --scene " + scene.key));
  }
}

TEST_CASE("atlas: docs/atlas.md has every committed verdict of the whole form") {
  const std::string page = test::read_file(kDocs / "atlas.md");
  std::istringstream csv(test::read_file(LEEWAY_ATLAS_CSV));
  int rows = 0;
  for (std::string row; std::getline(csv, row);) {
    if (!row.starts_with("whole,")) continue;
    CAPTURE(row);
    ++rows;
    CHECK(documents(page, fields_of(row)));
  }
  CHECK(rows > 400);
}

TEST_CASE("atlas: a frozen Phi overstates a body-frame bias 1.6 times in 10 s, 12 times in 60 s") {
  // On a circle at w = 0.4 rad/s a body-frame bias b moves the position by
  // b / w^2 |(1 - cos wT, wT - sin wT)|; frozen, by b T^2 / 2. 50 over 31.5, 1800 over 155.7.
  const auto result = run_briefly({"frozen-transition"}).front();
  const std::string frozen = "Phi frozen at the fix";
  CHECK(figure_of(result, frozen, "10 s") == doctest::Approx(1.59).epsilon(0.01));
  CHECK(figure_of(result, frozen, "60 s") == doctest::Approx(11.6).epsilon(0.01));
  for (const AtlasCell& cell : result.cells) {
    CAPTURE(cell.variant);
    if (cell.group != AtlasGroup::kNotOffered) CHECK(cell.figure < 1.01);
  }
}

TEST_CASE("atlas: height without a gravity gradient misses the growth cosh(t / 570 s)") {
  // Half an hour at sqrt(R / 2g) = 570 s: cosh(3.16) = 11.8.
  const auto result = run_briefly({"vertical-channel"}).front();
  CHECK(figure_of(result, "F without gravity gradient", "30 min") ==
        doctest::Approx(11.8).epsilon(0.02));
}

TEST_CASE("atlas: the same cells on any number of threads, and no comma in a name") {
  const std::vector<std::string> keys{"dead-row", "lever-arm", "gate-lockout"};
  const auto one = run_briefly(keys, 1);
  CHECK(atlas_csv(one, {.brief = true}) == atlas_csv(run_briefly(keys, 2), {.brief = true}));
  for (const AtlasResult& result : one) {
    for (const AtlasCell& cell : result.cells) {
      CHECK((cell.variant + cell.condition + cell.reported).find(',') == std::string::npos);
    }
  }
}

TEST_CASE("atlas: a verdict that is not the committed one, and a lost cell, are surprises") {
  auto results = run_briefly({"dead-row"});
  CHECK(atlas_surprises(results, {.brief = true}).empty());
  results.front().cells.front().figure = 50.0;
  results.front().cells.pop_back();
  const auto surprises = atlas_surprises(results, {.brief = true});
  REQUIRE(surprises.size() == 2);
  CHECK(test::contains(surprises[0].found, "fails, 50"));
  CHECK(test::contains(surprises[0].expected, "survives"));
  CHECK(surprises[1].found == "no such cell");
}

}  // namespace leeway::sim
