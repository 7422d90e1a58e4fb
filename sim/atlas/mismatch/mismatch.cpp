#include "sim/atlas/mismatch/mismatch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "leeway/sim/tools/parallel.hpp"

namespace leeway::sim {
namespace {

constexpr double kFirstFixS = 0.5;

std::vector<int> fix_intervals_s(bool brief) {
  return brief ? std::vector{10} : std::vector{1, 5, 10, 20};
}

/// The cells of one IMU and kind of fixes.
std::vector<MismatchCell> cells_of(std::size_t imu, FixKind fixes, bool brief) {
  std::vector<MismatchCell> cells;
  for (const VehicleKind vehicle : {VehicleKind::kNone, VehicleKind::kCar}) {
    for (const int t_s : fix_intervals_s(brief)) {
      cells.push_back({.imu = imu, .fixes = fixes, .vehicle = vehicle, .fix_interval_s = t_s});
    }
  }
  return cells;
}

/// A sensor unit on a drive: a trial of several cells.
struct Drive {
  std::size_t imu{};
  FixKind fixes{};
  std::uint64_t seed{};
  std::size_t first_cell{};
};

std::vector<Drive> drives_of(MismatchCampaign& campaign, bool brief) {
  std::vector<Drive> drives;
  for (std::size_t imu = 0; imu < campaign.imus.size(); ++imu) {
    for (const FixKind fixes : kAll<FixKind>) {
      const std::size_t first = campaign.cells.size();
      for (int k = 1; k <= campaign.trials; ++k) {
        drives.push_back({imu, fixes, static_cast<std::uint64_t>(k), first});
      }
      for (const MismatchCell& cell : cells_of(imu, fixes, brief)) campaign.cells.push_back(cell);
    }
  }
  return drives;
}

GnssScenario receiver_of(FixKind fixes) {
  return {.errors = fixes == FixKind::kCode ? code_receiver() : rtk_receiver()};
}

/// The scores of the cells of a drive, in their order.
std::vector<ClaimScore> scores_of(const Drive& drive, const MismatchCampaign& campaign,
                                  const TrueDrive& way, bool brief) {
  const FaultInputs inputs = inputs_of(way, campaign.imus[drive.imu].model,
                                       receiver_of(drive.fixes), kFirstFixS, drive.seed);
  std::vector<ClaimScore> scores;
  for (const MismatchCell& cell : cells_of(drive.imu, drive.fixes, brief)) {
    NavigatorConfig config;
    config.vehicle = VehicleConfig::of(cell.vehicle);
    scores.push_back(run_claims(config, inputs, way, cell.fix_interval_s));
  }
  return scores;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Takes the scores of a cell, one a seed, in the order of the seeds.
void sum_up(MismatchCell& cell, const std::vector<ClaimScore>& scores) {
  std::vector<double> scales;
  for (std::size_t k = 0; k < scores.size(); ++k) {
    cell.before_fixes.add(scores[k].before_fixes);
    cell.between.add(scores[k].between);
    if (scores[k].lost) cell.lost.push_back(k + 1);
    scales.push_back(scores[k].imu_sigma_scale);
  }
  cell.imu_sigma_scale = median(std::move(scales));
}

void sum_up(MismatchCampaign& campaign, const std::vector<Drive>& drives,
            const std::vector<std::vector<ClaimScore>>& scores) {
  std::vector<std::vector<ClaimScore>> by_cell(campaign.cells.size());
  for (std::size_t k = 0; k < drives.size(); ++k) {
    for (std::size_t c = 0; c < scores[k].size(); ++c) {
      by_cell[drives[k].first_cell + c].push_back(scores[k][c]);
    }
  }
  for (std::size_t c = 0; c < by_cell.size(); ++c) sum_up(campaign.cells[c], by_cell[c]);
}

}  // namespace

double MismatchCell::ratio() const {
  const double a = before_fixes.ratio(FaultError::kPosition);
  const double b = between.ratio(FaultError::kPosition);
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::infinity();
  return std::abs(std::log(a)) > std::abs(std::log(b)) ? a : b;
}

bool MismatchCampaign::is_named(const MismatchCell& cell) const {
  const double factor = imus[cell.imu].factor;
  const auto is_near = [](double a, double b) {
    return std::abs(std::log(a / b)) <= std::log(kNamedWithin);
  };
  return !is_near(factor, 1.0) && is_near(cell.imu_sigma_scale, factor);
}

MismatchCampaign run_mismatch(const MismatchOptions& options,
                              const std::function<void(double fraction)>& progress) {
  MismatchCampaign campaign{.imus = true_imus(options.brief), .trials = options.trials};
  const std::vector<Drive> drives = drives_of(campaign, options.brief);
  const Regime& car = regimes()[kCarRegime];
  const TrueDrive way = true_drive(car.trajectory, car.imu_rate_hz, kDenseS + kSparseS);
  std::vector<std::vector<ClaimScore>> scores(drives.size());
  parallel_for(
      drives.size(),
      [&](std::size_t k) { scores[k] = scores_of(drives[k], campaign, way, options.brief); },
      [&](std::size_t done) {
        if (progress) progress(static_cast<double>(done) / static_cast<double>(drives.size()));
      },
      options.threads);
  sum_up(campaign, drives, scores);
  return campaign;
}

MismatchSummary summary_of(const MismatchCampaign& campaign) {
  MismatchSummary summary{.cells = campaign.cells.size()};
  for (const MismatchCell& cell : campaign.cells) {
    summary.trials += static_cast<std::size_t>(campaign.trials);
    summary.lost += cell.lost.size();
    if (!is_honest(cell.before_fixes.ratio(FaultError::kVelocity))) ++summary.velocity_outside;
    if (!is_honest(cell.before_fixes.ratio(FaultError::kHeading))) ++summary.heading_outside;
    if (cell.claims_hold()) continue;
    ++(campaign.is_named(cell) ? summary.named : summary.outside);
  }
  return summary;
}

}  // namespace leeway::sim
