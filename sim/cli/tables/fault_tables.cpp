#include "sim/cli/tables/fault_tables.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "sim/cli/output.hpp"

namespace leeway::cli {
namespace {

constexpr std::string_view kHead = R"(# The matrix of faults

Written by `leeway atlas --faults --write docs/guide/fault-matrix.md`. Each fault is done to each
vehicle, once its navigator has settled, for 30 s, or 60 s where it takes time to show, unless its
row says otherwise; those of the start last for the first 30 s. Then 150 s follow. Seed 1, an IMU of
the car-grade MEMS class at 50 Hz, a fix every second. Wrong is beyond 5 claimed sigmas in
horizontal position, velocity or heading.

| word | meaning |
|---|---|
| ok | wrong for 2 s at most |
| said | wrong, and health is not `aligned`, or the time of the solution stands still |
| SILENT n s | wrong for n s, more than 2, and nothing says so |
| silent n s | the same, where no navigator could tell: see the end of this page |
| lost | not within 5 sigma and 3 times the RMS without a fault for good, 150 s after |

Where clocks disagree, a solution is right that is right by one of them. A state of health that the
navigator has without a fault, too, tells nothing.

)";

const sim::Fault& fault_of(const sim::FaultCell& cell) { return sim::faults()[cell.fault]; }

bool is_lost(const sim::FaultCell& cell) { return !fault_of(cell).lasts && !cell.recovery_s; }

/// "ok", "said", "SILENT 12 s"; "silent 12 s" where nobody could tell; "lost" beside it where the
/// way back was not found.
std::string word(const sim::FaultCell& cell) {
  std::string text = "ok";
  if (cell.told_s > sim::kBearableSilenceS) text = "said";
  if (cell.is_silent()) {
    text = fmt::format("{} {:.0f} s", is_unknowable(cell) ? "silent" : "SILENT", cell.silent_s);
  }
  if (!cell.finite) text = "NaN";
  return is_lost(cell) ? text + ", lost" : text;
}

/// A row for each fault, with nothing where a cell was not run.
std::vector<std::vector<std::string>> rows_of(const sim::FaultMatrix& matrix) {
  std::vector<std::vector<std::string>> rows(sim::faults().size(),
                                             std::vector<std::string>(sim::regimes().size() + 1));
  for (std::size_t f = 0; f < rows.size(); ++f) rows[f][0] = sim::faults()[f].name;
  for (const sim::FaultCell& cell : matrix.cells) rows[cell.fault][cell.regime + 1] = word(cell);
  return rows;
}

std::string percent(std::size_t part, std::size_t whole) {
  return number(whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole),
                1) +
         " %";
}

std::string summary_text(const sim::FaultSummary& s) {
  return fmt::format(
      "{} cells. Silent where it could be told: {} ({}); where nobody could: {}; not a number: "
      "{}.\n"
      "Recovered: {} of {} cells whose fault ends ({}), 95 % of them within {:.0f} s of its end.\n",
      s.cells, s.silent, percent(s.silent, s.cells), s.unknowable, s.not_finite, s.recovered,
      s.ending, percent(s.recovered, s.ending), s.recovery_95_s);
}

std::string row_text(const std::vector<std::string>& row) {
  std::string text = "|";
  for (const std::string& entry : row) text += fmt::format(" {} |", entry);
  return text + "\n";
}

std::vector<std::string> headings(std::string first) {
  std::vector<std::string> all{std::move(first)};
  for (const sim::Regime& regime : sim::regimes()) all.push_back(regime.name);
  return all;
}

std::string rule(std::size_t columns) {
  std::string text = "|";
  for (std::size_t k = 0; k < columns; ++k) text += "---|";
  return text + "\n";
}

std::string floors_markdown(const sim::FaultMatrix& matrix) {
  std::string text = row_text(headings("without a fault")) + rule(sim::regimes().size() + 1);
  std::vector<std::string> aligned{"aligned after, s"};
  std::vector<std::string> rms{"horizontal RMS, m"};
  std::vector<std::string> beyond{"beyond 5 sigma, s"};
  for (const sim::FaultFloor& floor : matrix.floors) {
    aligned.push_back(std::isfinite(floor.aligned_s) ? number(floor.aligned_s, 0) : "never");
    rms.push_back(number(floor.horizontal_m, 2));
    beyond.push_back(number(floor.beyond_s, 1));
  }
  return text + row_text(aligned) + row_text(rms) + row_text(beyond);
}

std::string matrix_markdown(const sim::FaultMatrix& matrix) {
  const auto rows = rows_of(matrix);
  std::string text;
  const sim::FaultGroup* before = nullptr;
  for (std::size_t f = 0; f < rows.size(); ++f) {
    const sim::FaultGroup& group = sim::faults()[f].group;
    if (before == nullptr || *before != group) {
      text += "\n" + row_text(headings(std::string(name(group)))) + rule(rows[f].size());
    }
    before = &group;
    text += row_text(rows[f]);
  }
  return text;
}

/// A line of names for each reason.
std::string unknowable_markdown() {
  std::string text;
  std::string reason;
  for (const sim::Fault& fault : sim::faults()) {
    if (fault.unknowable.empty()) continue;
    const std::string why =
        fault.unknowable +
        (fault.knowable_below_m == 0.0
             ? ""
             : fmt::format(", unless its 1 sigma is below {:g} m", fault.knowable_below_m));
    if (why != reason && !reason.empty()) text += fmt::format(":\n  {}.\n", reason);
    text += fmt::format("{}{}", why == reason ? ", " : "- ", fault.name);
    reason = why;
  }
  return text + fmt::format(":\n  {}.\n", reason);
}

Json cell_json(const sim::FaultCell& cell) {
  const sim::Fault& fault = fault_of(cell);
  return {{"fault", fault.name},
          {"group", name(fault.group)},
          {"vehicle", sim::regimes()[cell.regime].name},
          {"word", word(cell)},
          {"told_s", cell.told_s},
          {"silent_s", cell.silent_s},
          {"silent_position_s", cell.silent_by_s[0]},
          {"silent_velocity_s", cell.silent_by_s[1]},
          {"silent_heading_s", cell.silent_by_s[2]},
          {"silent", cell.is_silent()},
          {"unknowable", is_unknowable(cell)},
          {"finite", cell.finite},
          {"worst_m", cell.worst_m},
          {"ends", !fault.lasts},
          {"recovery_s", cell.recovery_s ? Json(*cell.recovery_s) : Json()}};
}

}  // namespace

void print_faults(const sim::FaultMatrix& matrix) {
  std::vector<std::string> columns = headings("fault");
  for (std::string& column : columns) column.insert(0, "<");
  Table table(columns);
  for (const auto& row : rows_of(matrix)) table.add(row);
  table.print();
  fmt::print("\n{}", summary_text(summary_of(matrix)));
}

Json faults_json(const sim::FaultMatrix& matrix) {
  const sim::FaultSummary s = summary_of(matrix);
  Json floors = Json::array();
  for (std::size_t r = 0; r < matrix.floors.size(); ++r) {
    floors.push_back({{"vehicle", sim::regimes()[r].name},
                      {"aligned_s", matrix.floors[r].aligned_s},
                      {"horizontal_rms_m", matrix.floors[r].horizontal_m},
                      {"beyond_s", matrix.floors[r].beyond_s}});
  }
  Json cells = Json::array();
  for (const sim::FaultCell& cell : matrix.cells) cells.push_back(cell_json(cell));
  return {{"summary",
           {{"cells", s.cells},
            {"silent", s.silent},
            {"silent_share", s.silent_share()},
            {"unknowable", s.unknowable},
            {"not_finite", s.not_finite},
            {"ending", s.ending},
            {"recovered", s.recovered},
            {"recovery_95_s", s.recovery_95_s}}},
          {"without_fault", std::move(floors)},
          {"cells", std::move(cells)}};
}

std::string faults_markdown(const sim::FaultMatrix& matrix) {
  return std::string(kHead) + summary_text(summary_of(matrix)) + "\n" + floors_markdown(matrix) +
         matrix_markdown(matrix) + "\n## What cannot be known\n\n" + unknowable_markdown();
}

}  // namespace leeway::cli
