#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <string_view>

#include "leeway/sim/atlas/atlas_expected.hpp"
#include "sim/atlas/committed_verdicts.hpp"

namespace leeway::sim {
namespace {

constexpr std::string_view kCsvHeader = "form,scene,variant,condition,verdict,figure,reported\n";

std::string_view form_of(const AtlasOptions& options) { return options.brief ? "short" : "whole"; }

/// What a cell is known by.
struct CellKey {
  std::string scene{};
  std::string variant{};
  std::string condition{};
  auto operator<=>(const CellKey&) const = default;
};

struct CellOutcome {
  std::string verdict{};
  double figure{};
  std::string reported{};
};

using Outcomes = std::map<CellKey, CellOutcome>;

/// The text up to a separator, which is taken away with it.
std::string_view taken(std::string_view& text, char separator) {
  const std::size_t end = std::min(text.find(separator), text.size());
  const std::string_view field = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return field;
}

double number_in(std::string_view field) {
  double value = std::numeric_limits<double>::infinity();
  std::from_chars(field.data(), field.data() + field.size(), value);
  return value;
}

/// Rows of the form, of scenes that were run.
Outcomes committed_outcomes(const std::vector<AtlasResult>& results, const AtlasOptions& options) {
  Outcomes outcomes;
  std::string_view rest = kCommittedVerdicts;
  taken(rest, '\n');
  while (!rest.empty()) {
    std::string_view row = taken(rest, '\n');
    if (taken(row, ',') != form_of(options)) continue;
    CellKey key{std::string(taken(row, ',')), std::string(taken(row, ',')),
                std::string(taken(row, ','))};
    const bool was_run = std::any_of(results.begin(), results.end(), [&](const AtlasResult& r) {
      return r.scene.key == key.scene;
    });
    if (!was_run) continue;
    const std::string verdict(taken(row, ','));
    const double figure = number_in(taken(row, ','));
    outcomes[key] = {verdict, figure, std::string(taken(row, ','))};
  }
  return outcomes;
}

bool is_as_expected(const CellOutcome& found, const CellOutcome& expected,
                    const AtlasLimits& limits) {
  const auto where_it_matters = [&limits](double figure) {
    return figure > 0.1 * limits.survives ? std::min(figure, 10.0 * limits.degrades)
                                          : 0.1 * limits.survives;
  };
  const double a = where_it_matters(found.figure);
  const double b = where_it_matters(expected.figure);
  return found.verdict == expected.verdict && found.reported == expected.reported &&
         a <= kAtlasFigureFactor * b && b <= kAtlasFigureFactor * a;
}

std::string told(const CellOutcome& outcome, const std::string& unit) {
  return fmt::format("{}, {:.3g}{}{}, reported: {}", outcome.verdict, outcome.figure,
                     unit.empty() ? "" : " ", unit,
                     outcome.reported.empty() ? "nothing" : outcome.reported);
}

CellOutcome outcome_of(const AtlasResult& result, const AtlasCell& cell) {
  return {std::string(name(verdict_of(result.scene.limits, cell.figure))), cell.figure,
          cell.reported};
}

}  // namespace

std::vector<AtlasSurprise> atlas_surprises(const std::vector<AtlasResult>& results,
                                           const AtlasOptions& options) {
  constexpr const char* kNone = "no such cell";
  Outcomes expected = committed_outcomes(results, options);
  std::vector<AtlasSurprise> surprises;
  for (const AtlasResult& result : results) {
    const std::string& unit = result.scene.unit;
    for (const AtlasCell& cell : result.cells) {
      const CellOutcome found = outcome_of(result, cell);
      const auto row = expected.find({result.scene.key, cell.variant, cell.condition});
      if (row == expected.end()) {
        surprises.push_back(
            {result.scene.key, cell.variant, cell.condition, kNone, told(found, unit)});
        continue;
      }
      if (!is_as_expected(found, row->second, result.scene.limits)) {
        surprises.push_back({result.scene.key, cell.variant, cell.condition,
                             told(row->second, unit), told(found, unit)});
      }
      expected.erase(row);
    }
  }
  for (const auto& [key, outcome] : expected) {
    surprises.push_back({key.scene, key.variant, key.condition, told(outcome, ""), kNone});
  }
  return surprises;
}

std::string atlas_csv(const std::vector<AtlasResult>& results, const AtlasOptions& options,
                      bool with_header) {
  std::string csv(with_header ? kCsvHeader : "");
  for (const AtlasResult& result : results) {
    for (const AtlasCell& cell : result.cells) {
      const CellOutcome outcome = outcome_of(result, cell);
      csv += fmt::format("{},{},{},{},{},{:.4g},{}\n", form_of(options), result.scene.key,
                         cell.variant, cell.condition, outcome.verdict, outcome.figure,
                         outcome.reported);
    }
  }
  return csv;
}

}  // namespace leeway::sim
