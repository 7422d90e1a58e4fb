#include "sim/cli/pages/interval_series.hpp"

namespace leeway::cli {

sim::IntervalConfig IntervalSeries::observed(sim::IntervalConfig config) {
  config.observer = [this](double interval_s, const sim::CovarianceAnalysis& analysis) {
    errors_m_[interval_s] = {analysis.true_m, analysis.claimed_m};
  };
  config.free_inertial_observer = [this](double t_s, double error_m) {
    free_inertial_.add({t_s, error_m});
  };
  return config;
}

void IntervalSeries::add_to(Json& series, const std::string& imu) const {
  SeriesTable curve({"interval_s", "true_m", "claimed_m"});
  for (const auto& [interval_s, error_m] : errors_m_) {
    curve.add({interval_s, error_m.first, error_m.second});
  }
  series["curve/" + imu] = curve.json();
  series["free_inertial/" + imu] = free_inertial_.json();
}

}  // namespace leeway::cli
