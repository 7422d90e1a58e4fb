#include "sim/atlas/faults/fault_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "leeway/sim/tools/parallel.hpp"
#include "sim/atlas/faults/fault_run.hpp"

namespace leeway::sim {
namespace {

constexpr double kAfterS = 150.0;  // watched after the end of a fault
constexpr double kFloors = 3.0;
constexpr double kForGoodS = 10.0;  // right for the last so many seconds

FaultWindow window_of(const Fault& fault, const Regime& regime) {
  const double from_s = fault.from_start ? 0.0 : regime.settled_s;
  return {from_s, from_s + fault.duration_s};
}

/// As long as the longest fault takes.
double longest_run_s(const Regime& regime) {
  double end_s = 0.0;
  for (const Fault& fault : faults()) end_s = std::max(end_s, window_of(fault, regime).to_s);
  return end_s + kAfterS;
}

/// What all cells of a vehicle share.
struct RegimeRun {
  FaultDrive drive{};
  FaultFloor floor{};
  std::vector<Health::State> states{};  // by epoch, without a fault
};

void run_without_fault(const Regime& regime, RegimeRun& run) {
  FaultFloor& floor = run.floor;
  double square_m2 = 0.0;
  double epochs = 0.0;
  Navigator navigator(regime.config);
  run_navigator(navigator, run.drive.inputs, run.drive.way, std::numeric_limits<double>::infinity(),
                [&](const FaultEpoch& epoch) {
                  run.states.push_back(epoch.state);
                  if (epoch.state != Health::State::kAligned) floor.aligned_s = epoch.t_s;
                  if (epoch.t_s <= regime.settled_s) return;
                  square_m2 += epoch.horizontal_m() * epoch.horizontal_m();
                  epochs += 1.0;
                  if (epoch.is_beyond()) floor.beyond_s += kEpochS;
                });
  floor.horizontal_m = std::sqrt(square_m2 / epochs);
  if (run.states.back() != Health::State::kAligned) {
    floor.aligned_s = std::numeric_limits<double>::infinity();
  }
}

RegimeRun regime_run(const Regime& regime) {
  RegimeRun run;
  run.drive = drive_of(regime, regime.trajectory, longest_run_s(regime));
  run_without_fault(regime, run);
  return run;
}

/// Sums up the epochs of a cell.
class CellScore {
 public:
  CellScore(const FaultWindow& window, const Regime& regime, const RegimeRun& shared)
      : window_(window), settled_s_(regime.settled_s), shared_(shared), bad_s_(window.to_s) {}

  void operator()(const FaultEpoch& epoch) {
    end_s_ = epoch.t_s;
    const std::size_t k = epochs_++;
    if (epoch.t_s <= window_.from_s) return;
    cell.finite = cell.finite && epoch.finite;
    if (epoch.is_beyond()) add_wrong(epoch, tells(epoch, k));
    if (window_.has(epoch.t_s)) cell.worst_m = std::max(cell.worst_m, epoch.horizontal_m());
    const bool good = epoch.has_solution && epoch.finite && !epoch.is_beyond() &&
                      epoch.horizontal_m() <= kFloors * shared_.floor.horizontal_m;
    if (!good && epoch.t_s > window_.to_s) bad_s_ = epoch.t_s;
  }

  std::optional<double> recovery_s() const {
    if (bad_s_ > end_s_ - kForGoodS) return std::nullopt;
    return bad_s_ - window_.to_s;
  }

  FaultCell cell{};

 private:
  bool tells(const FaultEpoch& epoch, std::size_t k) const {
    if (epoch.stands_still) return true;
    if (epoch.state == Health::State::kAligned) return false;
    return epoch.t_s <= settled_s_ || epoch.state != shared_.states[k];
  }

  void add_wrong(const FaultEpoch& epoch, bool is_told) {
    (is_told ? cell.told_s : cell.silent_s) += kEpochS;
    for (std::size_t e = 0; e < epoch.sigmas.size() && !is_told; ++e) {
      if (epoch.sigmas[e] > FaultEpoch::kMostSigmas) cell.silent_by_s[e] += kEpochS;
    }
  }

  FaultWindow window_;
  double settled_s_;
  const RegimeRun& shared_;
  std::size_t epochs_{0};
  double bad_s_;
  double end_s_{0.0};
};

void run_cell(FaultCell& cell, const Fault& fault, const Regime& regime, const RegimeRun& shared) {
  const FaultWindow window = window_of(fault, regime);
  const double end_s = window.to_s + kAfterS;
  std::optional<FaultDrive> own;
  if (fault.motion) own = drive_of(regime, fault.motion(regime), end_s);
  const FaultDrive& drive = own ? *own : shared.drive;
  FaultInputs inputs = drive.inputs;
  if (fault.damage) {
    fault.damage(inputs, {window.from_s, fault.lasts ? 2.0 * end_s : window.to_s});
  }
  Navigator navigator(regime.config);
  if (fault.heading_error_rad != 0.0) {
    start_turned(navigator, regime, drive.way.truth.front(), fault.heading_error_rad);
  }
  CellScore score(window, regime, shared);
  score.cell = cell;
  run_navigator(navigator, std::move(inputs), drive.way, end_s, std::ref(score));
  cell = score.cell;
  if (!fault.lasts) cell.recovery_s = score.recovery_s();
}

/// One of a receiver, one of an IMU, one of a clock.
bool is_brief(const Fault& fault) {
  return fault.name == "dead for 30 s" || fault.name == "hole of 2 s" ||
         fault.name == "fixes arrive after 1.5 s";
}

std::vector<FaultCell> cells_to_run(bool brief) {
  std::vector<FaultCell> cells;
  for (std::size_t f = 0; f < faults().size(); ++f) {
    for (std::size_t r = 0; r < regimes().size(); ++r) {
      if (!faults()[f].can_befall(regimes()[r].config.vehicle.kind)) continue;
      if (brief && r != kCarRegime && !is_brief(faults()[f])) continue;
      cells.push_back({.fault = f, .regime = r});
    }
  }
  return cells;
}

}  // namespace

bool is_unknowable(const FaultCell& cell) {
  const Fault& fault = faults()[cell.fault];
  const double sigma_m = regimes()[cell.regime].gnss.position_sigma_n_m.x();
  return !fault.unknowable.empty() && sigma_m >= fault.knowable_below_m;
}

FaultMatrix run_fault_matrix(bool brief, int threads,
                             const std::function<void(double fraction)>& progress) {
  FaultMatrix matrix{std::vector<FaultFloor>(regimes().size()), cells_to_run(brief)};
  std::vector<RegimeRun> shared(regimes().size());
  const double jobs = static_cast<double>(shared.size() + matrix.cells.size());
  const auto show = [&](std::size_t done) {
    if (progress) progress(static_cast<double>(done) / jobs);
  };
  parallel_for(
      shared.size(), [&](std::size_t r) { shared[r] = regime_run(regimes()[r]); }, show, threads);
  for (std::size_t r = 0; r < shared.size(); ++r) matrix.floors[r] = shared[r].floor;
  parallel_for(
      matrix.cells.size(),
      [&](std::size_t k) {
        FaultCell& cell = matrix.cells[k];
        run_cell(cell, faults()[cell.fault], regimes()[cell.regime], shared[cell.regime]);
      },
      [&](std::size_t done) { show(shared.size() + done); }, threads);
  return matrix;
}

FaultSummary summary_of(const FaultMatrix& matrix) {
  FaultSummary summary{.cells = matrix.cells.size()};
  std::vector<double> recoveries_s;
  for (const FaultCell& cell : matrix.cells) {
    if (cell.is_silent()) ++(is_unknowable(cell) ? summary.unknowable : summary.silent);
    if (!cell.finite) ++summary.not_finite;
    if (!faults()[cell.fault].lasts) ++summary.ending;
    if (cell.recovery_s) recoveries_s.push_back(*cell.recovery_s);
  }
  summary.recovered = recoveries_s.size();
  if (recoveries_s.empty()) return summary;
  std::sort(recoveries_s.begin(), recoveries_s.end());
  const auto last = static_cast<double>(recoveries_s.size() - 1);
  summary.recovery_95_s = recoveries_s[static_cast<std::size_t>(std::ceil(0.95 * last))];
  return summary;
}

}  // namespace leeway::sim
