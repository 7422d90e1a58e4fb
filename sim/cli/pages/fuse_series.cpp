#include "sim/cli/pages/fuse_series.hpp"

#include <spdlog/fmt/fmt.h>

#include <limits>

#include "leeway/model/chi_square.hpp"

namespace leeway::cli {
namespace {

const Eigen::Vector3d kNone = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());

}  // namespace

sim::ReplayObserver FuseSeries::observer() {
  sim::ReplayObserver observer;
  observer.epoch = [this](const Solution& s, const std::optional<TruthRecord>& truth) {
    add(s, truth);
  };
  observer.fix = [this](const UpdateOutcome& update) {
    // Within them are 95 % of an honest filter's.
    const double low = chi_square_threshold(0.975, update.dof);
    const double high = chi_square_threshold(0.025, update.dof);
    fixes_.add({to_seconds(update.time), update.nis, low, high});
  };
  observer.verdict = [this](Time t, Verdict verdict) {
    verdicts_[static_cast<std::size_t>(verdict)].add({to_seconds(t)});
  };
  observer.outage = [this](const sim::OutageEpoch& e) {
    outages_.add({e.since_s, static_cast<double>(e.outage), e.error_h_m, e.sigma_h_m});
  };
  return observer;
}

void FuseSeries::add(const Solution& s, const std::optional<TruthRecord>& truth) {
  std::optional<Eigen::Vector3d> true_r_e_m;
  Eigen::Vector3d error_n_m = kNone;
  if (truth) {
    true_r_e_m = ecef_from_geodetic(truth->nav.position);
    error_n_m = ned_to_ecef(truth->nav.position).transpose() * (s.nav.r_e_m - *true_r_e_m);
  }
  Eigen::Matrix<double, 19, 1> row;
  row << to_seconds(s.nav.time), error_n_m, s.sigma_position_n_m, s.b_a_mps2, s.sigma_b_a_mps2,
      s.b_g_radps, s.sigma_b_g_radps;
  solution_.add({row.data(), static_cast<std::size_t>(row.size())});
  add_to_track(s, true_r_e_m);
}

void FuseSeries::add_to_track(const Solution& s, const std::optional<Eigen::Vector3d>& true_r_e_m) {
  if (!origin_) origin_ = geodetic_from_ecef(s.nav.r_e_m);
  const auto local = [this](const Eigen::Vector3d& r_e_m) -> Eigen::Vector3d {
    return ned_to_ecef(*origin_).transpose() * (r_e_m - ecef_from_geodetic(*origin_));
  };
  const Eigen::Vector3d here_n_m = local(s.nav.r_e_m);
  const Eigen::Vector3d there_n_m = true_r_e_m ? local(*true_r_e_m) : kNone;
  track_.add({to_seconds(s.nav.time), here_n_m.y(), here_n_m.x(), there_n_m.y(), there_n_m.x()});
}

void FuseSeries::add_to(Json& series, const std::string& run) const {
  const auto put = [&](const std::string& name, const SeriesTable& table) {
    if (!table.empty()) series[name] = table.json();
  };
  put("solution/" + run, solution_);
  put("track/" + run, track_);
  put("fixes/" + run, fixes_);
  put("outages/" + run, outages_);
  for (const Verdict verdict : kAll<Verdict>) {
    put(fmt::format("verdict/{}/{}", run, name(verdict)),
        verdicts_[static_cast<std::size_t>(verdict)]);
  }
}

}  // namespace leeway::cli
