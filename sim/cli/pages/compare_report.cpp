#include "sim/cli/pages/compare_report.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "leeway/sim/compare/pareto.hpp"

namespace leeway::cli {
namespace {

double nees_of(const sim::Accuracy& accuracy) {
  return accuracy.has_claim ? accuracy.figures.mean_nees : std::numeric_limits<double>::quiet_NaN();
}

/// Rows are numbered from 1.
std::string number_of(const std::optional<std::size_t>& index) {
  return index ? fmt::format("#{}", *index + 1) : std::string();
}

std::string outcome_of(const sim::Accuracy& accuracy) {
  const sim::Consistency consistency = sim::consistency_of(accuracy);
  const sim::CampaignResult& r = accuracy.figures;
  const std::string word(name(consistency));
  if (consistency == sim::Consistency::kNotFinite) {
    return fmt::format("{}: {} of {}", word, r.not_finite, r.trials);
  }
  if (consistency == sim::Consistency::kDiverged) {
    return fmt::format("{}: {} of {}", word, r.diverged, r.trials);
  }
  return word;
}

Tone tone_of(const sim::Compared& c) {
  const sim::Consistency consistency = sim::consistency_of(c.accuracy);
  if (consistency == sim::Consistency::kDiverged || consistency == sim::Consistency::kNotFinite) {
    return Tone::kBad;
  }
  return c.on_front ? Tone::kGood : Tone::kPlain;
}

void print_rows(const sim::Comparison& comparison, bool only_front) {
  Table table({"no.", "<front", "<variant", "ns/s", "least", "most", "RMS, m", "R95, m", "NEES",
               "<consistency", "<dominated by"});
  for (std::size_t i = 0; i < comparison.variants.size(); ++i) {
    const sim::Compared& c = comparison.variants[i];
    if (only_front && !c.on_front) continue;
    table.add({number_of(i), c.on_front ? "*" : "", c.name, number(c.cost.median_ns_per_s, 0),
               number(c.cost.least_ns_per_s, 0), number(c.cost.most_ns_per_s, 0),
               number(c.accuracy.figures.rms_horizontal_m, 4), number(c.accuracy.r95_m, 4),
               number(nees_of(c.accuracy), 2), outcome_of(c.accuracy), number_of(c.dominated_by)},
              tone_of(c));
  }
  table.print();
}

void print_conditions(const sim::Comparison& comparison, int repeat) {
  const sim::Scene& scene = comparison.scene;
  std::vector<std::string> rates_hz;
  for (const int n : comparison.imu_dividers) {
    rates_hz.push_back(fmt::format("{:g}", scene.imu_rate_hz / n));
  }
  const sim::CampaignResult& any = comparison.variants.front().accuracy.figures;
  fmt::print("Scene '{}': the first {:g} s, IMU {} at {} Hz, fixes every {:g} s\n", scene.name,
             scene.duration_s, scene.imu_name, fmt::join(rates_hz, ", "), scene.gnss.interval_s);
  fmt::print(
      "{} variants. Errors: {} trials, seeds {} to {}, before each fix in the last {:g} s.\n",
      comparison.variants.size(), scene.trials, scene.first_seed,
      scene.first_seed + static_cast<std::uint64_t>(scene.trials) - 1,
      std::min(sim::scored_part_s(scene), scene.duration_s));
  fmt::print(
      "Cost: the filter alone, ns per second of IMU data; median, least and most of {} runs of the "
      "first seed, all variants in turn.\n",
      repeat);
  fmt::print("NEES of 15 states: {:.2f} to {:.2f} is consistent (95 %). No gate: fixes come {}.\n",
             any.nees_low, any.nees_high, "without latency and outliers");
}

}  // namespace

void print_comparison(const sim::Comparison& comparison, int repeat) {
  print_conditions(comparison, repeat);
  fmt::print("\nThe front: whoever wants less error pays more\n");
  print_rows(comparison, true);
  fmt::print(
      "\nAll, from the cheapest on; dominated by another that errs no more (within {:g} %) and "
      "costs less beyond the spread, or errs less and costs no more\n",
      100.0 * sim::kErrorResolution);
  print_rows(comparison, false);
}

Json comparison_json(const sim::Comparison& comparison) {
  Json rows = Json::array();
  for (const sim::Compared& c : comparison.variants) {
    const sim::CampaignResult& r = c.accuracy.figures;
    const std::optional<std::size_t>& by = c.dominated_by;
    rows.push_back({{"variant", c.name},
                    {"cost_ns_per_s", c.cost.median_ns_per_s},
                    {"cost_least_ns_per_s", c.cost.least_ns_per_s},
                    {"cost_most_ns_per_s", c.cost.most_ns_per_s},
                    {"rms_horizontal_m", r.rms_horizontal_m},
                    {"r95_m", c.accuracy.r95_m},
                    {"nees", nees_of(c.accuracy)},
                    {"nees_band", {r.nees_low, r.nees_high}},
                    {"consistency", name(sim::consistency_of(c.accuracy))},
                    {"trials_diverged", r.diverged},
                    {"trials_not_finite", r.not_finite},
                    {"front", c.on_front},
                    {"dominated_by", by ? Json(comparison.variants[*by].name) : Json()}});
  }
  return rows;
}

std::string comparison_csv(const sim::Comparison& comparison) {
  const auto cell = [](double x) { return std::isfinite(x) ? fmt::format("{}", x) : ""; };
  std::string csv =
      "variant,cost_ns_per_s,cost_least_ns_per_s,cost_most_ns_per_s,rms_horizontal_m,r95_m,nees,"
      "consistency,trials_diverged,trials_not_finite,front,dominated_by\n";
  for (const sim::Compared& c : comparison.variants) {
    const sim::CampaignResult& r = c.accuracy.figures;
    csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", c.name,
                       cell(c.cost.median_ns_per_s), cell(c.cost.least_ns_per_s),
                       cell(c.cost.most_ns_per_s), cell(r.rms_horizontal_m), cell(c.accuracy.r95_m),
                       cell(nees_of(c.accuracy)), name(sim::consistency_of(c.accuracy)), r.diverged,
                       r.not_finite, c.on_front ? 1 : 0,
                       c.dominated_by ? comparison.variants[*c.dominated_by].name : "");
  }
  return csv;
}

}  // namespace leeway::cli
