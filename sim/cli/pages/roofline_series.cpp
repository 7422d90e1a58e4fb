#include "sim/cli/pages/roofline_series.hpp"

#include <cmath>
#include <set>

#include "leeway/sim/analysis/roofline.hpp"

namespace leeway::cli {
namespace {

constexpr double kShortestS = 0.1;
constexpr int kPointsPerDecade = 12;

}  // namespace

SeriesTable roofline_series(const sim::Scene& scene, const std::map<double, double>& true_m) {
  const sim::Roofline roofline(scene);
  std::vector<std::string> columns{"interval_s"};
  for (const auto name : kNames<sim::RooflineTerm>) columns.push_back(std::string(name) + "_m");
  for (const char* column : {"roof_m", "sum_m", "true_m"}) columns.emplace_back(column);
  SeriesTable table(columns);
  std::set<double> intervals_s;
  for (const auto& [interval_s, error_m] : true_m) intervals_s.insert(interval_s);
  const double longest_s = sim::longest_interval_s(scene);
  for (int i = 0; kShortestS * std::pow(10.0, i / double{kPointsPerDecade}) < longest_s; ++i) {
    intervals_s.insert(kShortestS * std::pow(10.0, i / double{kPointsPerDecade}));
  }
  intervals_s.insert(longest_s);
  for (const double interval_s : intervals_s) {
    std::vector<double> row{interval_s};
    for (const sim::RooflineTerm term : kAll<sim::RooflineTerm>) {
      row.push_back(roofline.error_m(term, interval_s));
    }
    row.push_back(roofline.roof_m(interval_s));
    row.push_back(roofline.sum_m(interval_s));
    const auto exact = true_m.find(interval_s);
    row.push_back(exact == true_m.end() ? std::nan("") : exact->second);
    table.add(row);
  }
  return table;
}

}  // namespace leeway::cli
