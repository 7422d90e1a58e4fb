#include "sim/cli/tables/mismatch_tables.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "sim/cli/output.hpp"

namespace leeway::cli {
namespace {

using sim::FaultError;

std::string summary_text(const sim::MismatchCampaign& campaign) {
  const sim::MismatchSummary s = summary_of(campaign);
  return fmt::format(
      "Lost: {} of {} trials.\n"
      "Claims outside {:g} to {:g}: {} of {} cells, {} of them named by health.\n",
      s.lost, s.trials, sim::kLeastRatio, sim::kMostRatio, s.outside + s.named, s.cells, s.named);
}

/// The cells, first those with lost trials, then by how far the claim is off.
std::vector<const sim::MismatchCell*> worst_first(const sim::MismatchCampaign& campaign) {
  std::vector<const sim::MismatchCell*> cells;
  for (const sim::MismatchCell& cell : campaign.cells) cells.push_back(&cell);
  const auto badness = [](const sim::MismatchCell* cell) {
    return std::pair{cell->lost.size(), std::abs(std::log(cell->ratio()))};
  };
  std::stable_sort(cells.begin(), cells.end(), [&](const auto* a, const auto* b) {
    return badness(a) > badness(b);
  });
  return cells;
}

const std::vector<std::string> kColumns{
    "<IMU", "<fixes", "<vehicle", "T, s", "lost", "before fixes, m", "RMS / sigma",
    "between", "velocity", "heading", "> 3 sigma, %", "> 5 sigma, %", "IMU scale", "true", "<word"};

std::string word(const sim::MismatchCampaign& campaign, const sim::MismatchCell& cell) {
  if (cell.claims_hold()) return "ok";
  if (campaign.is_named(cell)) return "named";
  return cell.ratio() > 1.0 ? "TOO SMALL" : "too large";
}

std::vector<std::string> row_of(const sim::MismatchCampaign& campaign,
                                const sim::MismatchCell& cell) {
  const sim::TrueImu& imu = campaign.imus[cell.imu];
  const sim::ClaimSums& before = cell.before_fixes;
  const auto percent = [&](double epochs) { return number(100.0 * epochs / before.epochs, 1); };
  return {imu.name,
          std::string(name(cell.fixes)),
          std::string(name(cell.vehicle)),
          std::to_string(cell.fix_interval_s),
          cell.lost.empty() ? "0" : fmt::format("{} ({})", cell.lost.size(),
                                                fmt::join(cell.lost, " ")),
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

}  // namespace

void print_mismatch(const sim::MismatchCampaign& campaign) {
  fmt::print("{}\n", summary_text(campaign));
  Table table(kColumns);
  for (const sim::MismatchCell* cell : worst_first(campaign)) table.add(row_of(campaign, *cell));
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
            {"named", s.named}}},
          {"cells", std::move(cells)}};
}

std::string mismatch_markdown(const sim::MismatchCampaign& campaign) {
  return summary_text(campaign);
}

}  // namespace leeway::cli
