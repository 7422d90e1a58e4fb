#include "sim/cli/tables/mismatch_tables.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/cli/output.hpp"

namespace leeway::cli {
namespace {

using sim::FaultError;

constexpr std::string_view kMismatchHead = R"(# IMUs that the navigator does not know

Written by `leeway atlas --mismatch --write docs/guide/mismatch.md`. The default navigator, told
nothing of its IMU, and the same with `VehicleConfig::car()`, on the car drive of
[the matrix of faults](fault-matrix.md) at 50 Hz, with fixes of code (3.2 m horizontally, most of it
lasting for half a minute, and 5 cm/s) and RTK (2 cm, 3 cm/s): every second for 300 s, then every T
for 300 s, which are scored. Each trial has another unit of the IMU: seeds 1 to N.

The default model is that of a car-grade MEMS IMU (`automotive_mems_model()`). In the rows with a
factor the true sensor's white noise, in-run drift, scale factors or misalignments are so many times
larger, or all four. Where the model states no scale factor and no misalignment the factor is of
1000 ppm and 1 mrad. The parts are those of [the catalogue](imu-catalogue.md), by their datasheets,
turn-on bias included.

Entries: RMS of the horizontal error over RMS of its claimed sigma, just before fixes or between,
whichever is further from 1. **Bold**: not within 0.5 to 1.5. A star: health names the factor, as
`imu_sigma_scale` is within 2 x of it. Lost: within the last minute never within 10 m + 10 sigmas of
the truth, or a solution that is not finite.

)";

std::string summary_text(const sim::MismatchCampaign& campaign) {
  const sim::MismatchSummary s = summary_of(campaign);
  return fmt::format(
      "Lost: {} of {} trials, {} a cell.\n"
      "Horizontal claims outside {:g} to {:g}: {} of {} cells; the factor is named in {} of them.\n"
      "Before fixes, velocity outside in {}, heading in {}.\n",
      s.lost, s.trials, campaign.trials, sim::kLeastRatio, sim::kMostRatio, s.outside + s.named,
      s.cells, s.named, s.velocity_outside, s.heading_outside);
}

/// The cells, first those with lost trials, then by how far the claim is off.
std::vector<const sim::MismatchCell*> worst_first(const sim::MismatchCampaign& campaign) {
  std::vector<const sim::MismatchCell*> cells;
  for (const sim::MismatchCell& cell : campaign.cells) cells.push_back(&cell);
  const auto badness = [](const sim::MismatchCell* cell) {
    return std::pair{cell->lost.size(), std::abs(std::log(cell->ratio()))};
  };
  std::stable_sort(cells.begin(), cells.end(),
                   [&](const auto* a, const auto* b) { return badness(a) > badness(b); });
  return cells;
}

const std::vector<std::string> kColumns{
    "<IMU",        "<fixes",  "<vehicle", "T, s",    "lost",         "before fixes, m",
    "RMS / sigma", "between", "velocity", "heading", "> 3 sigma, %", "> 5 sigma, %",
    "IMU scale",   "true",    "<word"};

/// "ok", "named", "TOO SMALL": the claim; "too large".
std::string word(const sim::MismatchCampaign& campaign, const sim::MismatchCell& cell) {
  if (cell.claims_hold()) return "ok";
  if (campaign.is_named(cell)) return "named";
  return cell.ratio() > 1.0 ? "TOO SMALL" : "too large";
}

std::vector<std::string> mismatch_row_of(const sim::MismatchCampaign& campaign,
                                         const sim::MismatchCell& cell) {
  const sim::TrueImu& imu = campaign.imus[cell.imu];
  const sim::ClaimSums& before = cell.before_fixes;
  const auto percent = [&](double epochs) { return number(100.0 * epochs / before.epochs, 1); };
  return {
      imu.name,
      std::string(name(cell.fixes)),
      std::string(name(cell.vehicle)),
      std::to_string(cell.fix_interval_s),
      cell.lost.empty() ? "0" : fmt::format("{} ({})", cell.lost.size(), fmt::join(cell.lost, " ")),
      number(before.rms(FaultError::kPosition), 2),
      number(before.ratio(FaultError::kPosition), 2),
      number(cell.between.ratio(FaultError::kPosition), 2),
      number(before.ratio(FaultError::kVelocity), 2),
      number(before.ratio(FaultError::kHeading), 2),
      percent(before.beyond_3),
      percent(before.beyond_5),
      number(cell.imu_sigma_scale, 2),
      number(imu.factor, 2),
      word(campaign, cell)};
}

Json cell_json(const sim::MismatchCampaign& campaign, const sim::MismatchCell& cell) {
  const sim::TrueImu& imu = campaign.imus[cell.imu];
  const sim::ClaimSums& before = cell.before_fixes;
  return {{"imu", imu.name},
          {"mismatch", name(imu.mismatch)},
          {"factor", imu.factor},
          {"fixes", name(cell.fixes)},
          {"vehicle", name(cell.vehicle)},
          {"fix_interval_s", cell.fix_interval_s},
          {"lost_seeds", cell.lost},
          {"horizontal_rms_m", before.rms(FaultError::kPosition)},
          {"ratio", before.ratio(FaultError::kPosition)},
          {"ratio_between", cell.between.ratio(FaultError::kPosition)},
          {"ratio_velocity", before.ratio(FaultError::kVelocity)},
          {"ratio_heading", before.ratio(FaultError::kHeading)},
          {"beyond_3_sigma", before.beyond_3 / before.epochs},
          {"beyond_5_sigma", before.beyond_5 / before.epochs},
          {"imu_sigma_scale", cell.imu_sigma_scale},
          {"named", campaign.is_named(cell)},
          {"holds", cell.claims_hold()}};
}

std::string entry(const sim::MismatchCampaign& campaign, const sim::MismatchCell& cell) {
  std::string text = number(cell.ratio(), 2);
  if (!cell.claims_hold()) text = "**" + text + "**";
  if (campaign.is_named(cell)) text += " \\*";
  if (!cell.lost.empty()) text += fmt::format(", {} lost", cell.lost.size());
  return text;
}

/// IMUs by vehicles and intervals.
std::string matrix_markdown(const sim::MismatchCampaign& campaign, sim::FixKind fixes) {
  std::string head = fmt::format("\n| {} |", name(fixes));
  std::string rule = "|---|";
  std::vector<std::string> rows;
  for (const sim::TrueImu& imu : campaign.imus) rows.push_back(fmt::format("| {} |", imu.name));
  for (const sim::MismatchCell& cell : campaign.cells) {
    if (cell.fixes != fixes) continue;
    rows[cell.imu] += fmt::format(" {} |", entry(campaign, cell));
    if (cell.imu > 0) continue;
    head += fmt::format(" {}, {} s |", name(cell.vehicle), cell.fix_interval_s);
    rule += "---|";
  }
  return fmt::format("{}\n{}\n{}\n", head, rule, fmt::join(rows, "\n"));
}

}  // namespace

void print_mismatch(const sim::MismatchCampaign& campaign) {
  fmt::print("{}\n", summary_text(campaign));
  Table table(kColumns);
  for (const sim::MismatchCell* cell : worst_first(campaign)) {
    const bool is_good = cell->lost.empty() && cell->claims_hold();
    table.add(mismatch_row_of(campaign, *cell), is_good ? Tone::kPlain : Tone::kBad);
  }
  table.print();
}

Json mismatch_json(const sim::MismatchCampaign& campaign) {
  const sim::MismatchSummary s = summary_of(campaign);
  Json cells = Json::array();
  for (const sim::MismatchCell& cell : campaign.cells) cells.push_back(cell_json(campaign, cell));
  return {{"summary",
           {{"trials", s.trials},
            {"lost", s.lost},
            {"cells", s.cells},
            {"outside", s.outside},
            {"named", s.named},
            {"velocity_outside", s.velocity_outside},
            {"heading_outside", s.heading_outside}}},
          {"cells", std::move(cells)}};
}

std::string mismatch_markdown(const sim::MismatchCampaign& campaign) {
  std::string text = std::string(kMismatchHead) + summary_text(campaign);
  for (const sim::FixKind fixes : kAll<sim::FixKind>) text += matrix_markdown(campaign, fixes);
  return text;
}

}  // namespace leeway::cli
