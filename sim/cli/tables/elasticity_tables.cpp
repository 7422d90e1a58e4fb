#include "sim/cli/tables/elasticity_tables.hpp"

#include <cmath>

#include "sim/cli/output.hpp"

namespace leeway::cli {
namespace {

/// Elasticities below it are not worth a line.
constexpr double kWorthALine = 0.005;

std::string spread_text(const sim::Interval& answer) {
  if (std::isnan(answer.interval_s)) return "none";
  const bool is_longer = answer.outcome == sim::Interval::Outcome::kAlways;
  return fmt::format("{}{:.3g}", is_longer ? "> " : "", answer.interval_s);
}

void print_spread(const sim::Scene& scene, const std::optional<sim::IntervalSpread>& spread) {
  if (!spread) {
    fmt::print("Spread: none, because {} states one number for each specification.\n",
               scene.imu_name);
    return;
  }
  fmt::print(
      "Spread over the range of its class: {} s at the high end, {} s, {} s at the low end.\n",
      spread_text(spread->high), spread_text(spread->mid), spread_text(spread->low));
}

Json relative_error(double predicted_s, double exact_s) { return predicted_s / exact_s - 1.0; }

}  // namespace

Sensitivity sensitivity_of(const sim::Scene& scene, const sim::Interval& answer) {
  sim::Scene limited = scene;
  limited.limit.allow(answer.allowed());
  const sim::Roofline roofline(limited);
  return {sim::elasticities(limited, sim::error_track(limited), answer.interval_s),
          sim::interval_spread(limited, answer.allowed()), roofline.interval_s(answer.limit_m),
          roofline.sum_interval_s(answer.limit_m)};
}

void print_elasticities(const sim::Elasticities& elasticities) {
  Table table({"<1 % more of", "error, %", "interval, %"});
  for (const sim::Elasticity& e : elasticities.each) {
    if (std::abs(e.of_error) < kWorthALine) continue;
    table.add({std::string(name(e.specification)), fmt::format("{:+.2f}", e.of_error),
               std::isnan(e.of_interval) ? "-" : fmt::format("{:+.2f}", e.of_interval)});
  }
  table.print();
  fmt::print("The error grows as the interval to the power of {:.2f} here.\n", elasticities.growth);
}

Json elasticities_json(const sim::Elasticities& elasticities) {
  Json rows = Json::array();
  for (const sim::Elasticity& e : elasticities.each) {
    rows.push_back({{"specification", name(e.specification)},
                    {"of_error", e.of_error},
                    {"of_interval", e.of_interval}});
  }
  return rows;
}

void print_sensitivity(const sim::Scene& scene, const sim::Interval& answer,
                       const Sensitivity& sensitivity) {
  fmt::print("\n{}, {:g} m: what the interval of {:.3g} s depends on\n", scene.imu_name,
             answer.limit_m, answer.interval_s);
  print_elasticities(sensitivity.elasticities);
  print_spread(scene, sensitivity.spread);
  if (std::isnan(sensitivity.roofline_s)) return;
  fmt::print(
      "Closed forms{}: {:.3g} s ({:+.0f} %) where the first line crosses the limit, {:.3g} s "
      "({:+.0f} %) for their sum.\n",
      scene.vehicle ? ", which know no aiding of a vehicle" : "", sensitivity.roofline_s,
      100.0 * (sensitivity.roofline_s / answer.interval_s - 1.0), sensitivity.roofline_sum_s,
      100.0 * (sensitivity.roofline_sum_s / answer.interval_s - 1.0));
}

Json sensitivity_json(const sim::Interval& answer, const Sensitivity& sensitivity) {
  Json spread;
  if (sensitivity.spread) {
    spread = {{"low_interval_s", sensitivity.spread->low.interval_s},
              {"mid_interval_s", sensitivity.spread->mid.interval_s},
              {"high_interval_s", sensitivity.spread->high.interval_s}};
  }
  return {
      {"growth", sensitivity.elasticities.growth},
      {"elasticities", elasticities_json(sensitivity.elasticities)},
      {"spread", std::move(spread)},
      {"roofline",
       {{"interval_s", sensitivity.roofline_s},
        {"relative_error", relative_error(sensitivity.roofline_s, answer.interval_s)},
        {"sum_interval_s", sensitivity.roofline_sum_s},
        {"sum_relative_error", relative_error(sensitivity.roofline_sum_s, answer.interval_s)}}}};
}

}  // namespace leeway::cli
