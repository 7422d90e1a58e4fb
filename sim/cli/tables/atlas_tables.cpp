#include "sim/cli/tables/atlas_tables.hpp"

#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace leeway::cli {
namespace {

std::string with_unit(double figure, const std::string& unit) {
  if (!std::isfinite(figure)) return "-";
  return unit.empty() ? fmt::format("{:.3g}", figure) : fmt::format("{:.3g} {}", figure, unit);
}

/// "error, m", or what a ratio is called.
std::string figure_heading(const sim::AtlasScene& scene, const std::string& figure = "figure") {
  return scene.unit.empty() ? figure : figure + ", " + scene.unit;
}

std::string limits_text(const sim::AtlasScene& scene) {
  return fmt::format("survives up to {}, degrades up to {}: {}",
                     with_unit(scene.limits.survives, scene.unit),
                     with_unit(scene.limits.degrades, scene.unit), scene.limits.reason);
}

std::string verdict_text(const sim::AtlasScene& scene, const sim::AtlasCell& cell) {
  return std::string(name(sim::verdict_of(scene.limits, cell.figure)));
}

std::string reported_text(const sim::AtlasScene& scene, const sim::AtlasCell& cell) {
  return sim::fails_silently(scene.limits, cell) ? "NOTHING" : cell.reported;
}

Row row_of(const sim::AtlasScene& scene, const sim::AtlasCell& cell) {
  return {{"", "scene", scene.key},
          {"", "title", scene.title},
          {"<of", "group", name(cell.group)},
          {"<variant", "variant", cell.variant},
          {"<condition", "condition", cell.condition},
          {figure_heading(scene), "", with_unit(cell.figure, "")},
          {"", "figure", cell.figure},
          {"", "figure_unit", scene.unit},
          {"<verdict", "verdict", verdict_text(scene, cell)},
          {"<reported", "", reported_text(scene, cell)},
          {"", "reported", cell.reported},
          {"", "silent", sim::fails_silently(scene.limits, cell)}};
}

Row row_of(const sim::AtlasSurprise& s) {
  return {{"<scene", "scene", s.scene},
          {"<variant", "variant", s.variant},
          {"<condition", "condition", s.condition},
          {"<expected", "expected", s.expected},
          {"<found", "found", s.found}};
}

void print_scene(const sim::AtlasResult& result) {
  const sim::AtlasScene& scene = result.scene;
  fmt::print("\n{}: {}\n  {}; {}\n", scene.key, scene.title, scene.figure, limits_text(scene));
  Table table = table_of(row_of(scene, {}));
  for (const sim::AtlasCell& cell : result.cells) add_row(table, row_of(scene, cell));
  table.print();
}

/// Where verdict or figure is worst among the cells of a group; null without any.
const sim::AtlasCell* worst_of(const sim::AtlasResult& result, sim::AtlasGroup group) {
  const sim::AtlasCell* worst = nullptr;
  for (const sim::AtlasCell& cell : result.cells) {
    if (cell.group != group) continue;
    // A figure that is none is the worst.
    if (worst == nullptr || !(cell.figure <= worst->figure)) worst = &cell;
  }
  return worst;
}

std::string matrix_entry(const sim::AtlasResult& result, sim::AtlasGroup group) {
  const sim::AtlasCell* worst = worst_of(result, group);
  if (worst == nullptr) return "";
  return fmt::format("{} {}", verdict_text(result.scene, *worst),
                     with_unit(worst->figure, result.scene.unit));
}

/// The words in lines of at most 120 characters.
std::string wrapped(const std::string& text) {
  constexpr std::size_t kLongest = 120;
  std::string lines;
  std::size_t length = 0;
  std::istringstream words(text);
  for (std::string word; words >> word; lines += word) {
    const bool fits = length + 1 + word.size() <= kLongest;
    if (length > 0) lines += fits ? ' ' : '\n';
    length = length > 0 && fits ? length + 1 + word.size() : word.size();
  }
  return lines;
}

std::string markdown_row(const std::vector<std::string>& cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string markdown_head(const std::vector<std::string>& cells) {
  std::string rule = "|";
  for (std::size_t i = 0; i < cells.size(); ++i) rule += "---|";
  return markdown_row(cells) + rule + "\n";
}

std::string markdown_matrix(const std::vector<sim::AtlasResult>& results) {
  std::vector<std::string> head{"scene"};
  head.insert(head.end(), kNames<sim::AtlasGroup>.begin(), kNames<sim::AtlasGroup>.end());
  std::string text = markdown_head(head);
  for (const sim::AtlasResult& result : results) {
    const sim::AtlasScene& scene = result.scene;
    std::vector<std::string> cells{fmt::format("[{}](atlas/{}.md)", scene.title, scene.key)};
    for (const auto group : kAll<sim::AtlasGroup>) cells.push_back(matrix_entry(result, group));
    text += markdown_row(cells);
  }
  return text;
}

/// Each once, in the order of the cells.
std::vector<std::string> each_once(const sim::AtlasResult& result,
                                   std::string sim::AtlasCell::*member) {
  std::vector<std::string> names;
  for (const sim::AtlasCell& cell : result.cells) {
    if (std::find(names.begin(), names.end(), cell.*member) == names.end()) {
      names.push_back(cell.*member);
    }
  }
  return names;
}

/// "fails 7.3 (NIS high)"; nothing where there is no such cell.
std::string markdown_cell(const sim::AtlasResult& result, const std::string& variant,
                          const std::string& condition) {
  for (const sim::AtlasCell& cell : result.cells) {
    if (cell.variant != variant || cell.condition != condition) continue;
    const std::string reported = reported_text(result.scene, cell);
    return fmt::format("{} {}{}", verdict_text(result.scene, cell), with_unit(cell.figure, ""),
                       reported.empty() ? "" : " (" + reported + ")");
  }
  return "";
}

/// Variants by conditions.
std::string markdown_scene(const sim::AtlasResult& result) {
  const sim::AtlasScene& scene = result.scene;
  const auto conditions = each_once(result, &sim::AtlasCell::condition);
  std::string text = fmt::format("\n## {}\n\n", scene.title);
  text += wrapped(fmt::format("`{}`, [{}.md](atlas/{}.md). Figure: {}; {}.", scene.key, scene.key,
                              scene.key, figure_heading(scene, scene.figure), limits_text(scene)));
  text += "\n\n";
  std::vector<std::string> head{"variant"};
  head.insert(head.end(), conditions.begin(), conditions.end());
  text += markdown_head(head);
  for (const std::string& variant : each_once(result, &sim::AtlasCell::variant)) {
    std::vector<std::string> cells{variant};
    for (const std::string& condition : conditions) {
      cells.push_back(markdown_cell(result, variant, condition));
    }
    text += markdown_row(cells);
  }
  return text;
}

}  // namespace

void print_atlas_list() {
  Table table({"<scene", "<title", "<figure"});
  for (const sim::AtlasScene& scene : sim::atlas_scenes()) {
    table.add({scene.key, scene.title, figure_heading(scene, scene.figure)});
  }
  table.print();
}

bool any_silent(const std::vector<sim::AtlasResult>& results) {
  return std::any_of(results.begin(), results.end(), [](const sim::AtlasResult& result) {
    return std::any_of(result.cells.begin(), result.cells.end(), [&result](const auto& cell) {
      return sim::fails_silently(result.scene.limits, cell);
    });
  });
}

void print_atlas(const std::vector<sim::AtlasResult>& results,
                 const std::vector<sim::AtlasSurprise>& surprises) {
  for (const sim::AtlasResult& result : results) print_scene(result);
  if (any_silent(results)) {
    fmt::print("\nVariants of the library that fail, and no detector says so: see NOTHING above\n");
  }
  if (surprises.empty()) {
    fmt::print("\nAll cells are as expected, figures within a factor of {:g}\n",
               sim::kAtlasFigureFactor);
    return;
  }
  fmt::print("\n{} cells are not as expected\n", surprises.size());
  Table table = table_of(row_of(surprises.front()));
  for (const sim::AtlasSurprise& s : surprises) add_row(table, row_of(s));
  table.print();
}

Json atlas_json(const std::vector<sim::AtlasResult>& results,
                const std::vector<sim::AtlasSurprise>& surprises) {
  Json cells = Json::array();
  for (const sim::AtlasResult& result : results) {
    for (const sim::AtlasCell& cell : result.cells) {
      cells.push_back(row_json(row_of(result.scene, cell)));
    }
  }
  Json unexpected = Json::array();
  for (const sim::AtlasSurprise& s : surprises) unexpected.push_back(row_json(row_of(s)));
  return {{"cells", std::move(cells)}, {"unexpected", std::move(unexpected)}};
}

std::string atlas_markdown(const std::vector<sim::AtlasResult>& results) {
  std::string text = "# The failure atlas\n\n";
  text += wrapped(
      "Scenes that are each built to break a method, run against every way of running the filter. "
      "Written by `leeway atlas --markdown docs/atlas.md`; the verdicts are checked by the tests. "
      "A figure is the larger the worse. In the matrix: the worst of each group of variants. *Not "
      "offered* are methods that the library does not have: they are what a scene shows failing. "
      "Every variant that the library offers and that fails is reported by one of its detectors, "
      "in "
      "brackets.");
  text += "\n\n" + markdown_matrix(results);
  for (const sim::AtlasResult& result : results) text += markdown_scene(result);
  return text;
}

}  // namespace leeway::cli
