#include <cmath>

#include "leeway/sim/compare/compare.hpp"
#include "leeway/sim/compare/pareto.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/options.hpp"
#include "sim/cli/scene_options.hpp"

namespace leeway::cli {
namespace {

constexpr double kEnoughS = 600.0;
constexpr double kEnoughFixes = 10.0;

struct CompareChoice {
  SceneChoice scene{.trials = 10};
  sim::CompareOptions compare{};
  Output output{};
};

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

/// Of the variant numbered from 0.
Row row_of(const sim::Comparison& comparison, std::size_t index) {
  const sim::Compared& c = comparison.variants[index];
  const sim::CampaignResult& r = c.accuracy.figures;
  const std::optional<std::size_t>& by = c.dominated_by;
  return {{"no.", "", number_of(index)},
          {"<front", "", c.on_front ? "*" : ""},
          {"<variant", "variant", c.name},
          {"ns/s", "cost_ns_per_s", c.cost.median_ns_per_s},
          {"least", "cost_least_ns_per_s", c.cost.least_ns_per_s},
          {"most", "cost_most_ns_per_s", c.cost.most_ns_per_s},
          {"RMS, m", "rms_horizontal_m", r.rms_horizontal_m, 4},
          {"R95, m", "r95_m", c.accuracy.r95_m, 4},
          {"NEES", "nees", c.accuracy.has_claim ? Json(r.mean_nees) : Json(), 2},
          {"", "nees_band", Json{r.nees_low, r.nees_high}},
          {"<consistency", "", outcome_of(c.accuracy)},
          {"", "consistency", name(sim::consistency_of(c.accuracy))},
          {"", "trials_diverged", r.diverged},
          {"", "trials_not_finite", r.not_finite},
          {"", "front", c.on_front},
          {"<dominated by", "", number_of(by)},
          {"", "dominated_by", by ? Json(comparison.variants[*by].name) : Json()}};
}

void print_rows(const sim::Comparison& comparison, bool only_front) {
  Table table = table_of(row_of(comparison, 0));
  for (std::size_t i = 0; i < comparison.variants.size(); ++i) {
    const sim::Compared& c = comparison.variants[i];
    if (c.on_front || !only_front) add_row(table, row_of(comparison, i), tone_of(c));
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
  for (std::size_t i = 0; i < comparison.variants.size(); ++i) {
    rows.push_back(row_json(row_of(comparison, i)));
  }
  return rows;
}

/// A beginning of the scene unless --at says otherwise.
sim::Scene compared_scene(const CompareChoice& options) {
  sim::Scene scene = scene_of(options.scene);
  if (!options.scene.at_s) {
    const double enough_s = std::max(kEnoughS, kEnoughFixes * scene.gnss.interval_s);
    scene.duration_s = std::min(scene.duration_s, enough_s);
  }
  return scene;
}

sim::Comparison compared(const CompareChoice& options) {
  sim::CompareOptions shown = options.compare;
  Progress progress("compare");
  shown.progress = std::ref(progress);
  return sim::compare(compared_scene(options), shown);
}

int run(const CompareChoice& options) {
  const sim::Comparison comparison = compared(options);
  const int repeat = options.compare.repeat;
  show(options.output,
       answer_json("compare", timed_input_json(comparison.scene, repeat),
                   comparison_json(comparison)),
       [&] { print_comparison(comparison, repeat); });
  return std::ranges::any_of(comparison.variants, &sim::Compared::on_front) ? kSuccess : kNoAnswer;
}

void add_options(CLI::App& app, CompareChoice& options) {
  add_scene_options(app, options.scene);
  add_trial_options(app, options.scene, 10'000, "of every variant, for its errors (default: 10)");
  add_repeat_option(app, options.compare.repeat);
  add_threads_option(app, options.compare.threads, "of the runs that are not timed; ");
  add_output_options(app, options.output);
  // Scripts may still have it.
  app.add_option_function<std::string>(
         "--csv",
         [](const std::string&) {
           throw CLI::ValidationError("--csv", "gone: use --json, whose results[] has these rows");
         })
      ->group("");
}

const Command<CompareChoice> kCompare{
    "compare", "What each way of running the filter costs in a scene, and how much it errs",
    "Without --at: the first 600 s of the scene, or ten fixes. Errors are the same to the bit\n"
    "whenever asked for; costs are of this machine, now.\n"
    "Example:\n"
    "  leeway compare --scene docs/examples/scenes/square-loop.toml --json > variants.json",
    add_options, run};

}  // namespace
}  // namespace leeway::cli
