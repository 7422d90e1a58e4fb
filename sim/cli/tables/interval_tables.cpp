#include "sim/cli/tables/interval_tables.hpp"

#include <cmath>

#include "leeway/sim/sensors/imu_class_name.hpp"
#include "sim/cli/scene_options.hpp"
#include "sim/cli/tables/coast_tables.hpp"

namespace leeway::cli {
namespace {

std::string calibrated(const sim::Interval& answer) {
  if (answer.outcome == sim::Interval::Outcome::kNever) return "none";
  const bool is_longer = answer.outcome == sim::Interval::Outcome::kAlways;
  return (is_longer ? "> " : "") + seconds(answer.interval_s);
}

/// With its mark: l linear, c checked, t by trials.
std::string marked(const SolvedLimit& answer) {
  switch (answer.mark()) {
    case sim::Mark::kLinear:
      return calibrated(answer.interval) + " l";
    case sim::Mark::kChecked:
      return calibrated(answer.interval) + " c";
    case sim::Mark::kByTrials:
      return (std::isnan(answer.interval_s()) ? "none" : seconds(answer.interval_s())) + " t";
  }
  return {};
}

std::string free_inertial(const sim::Interval& answer, double duration_s) {
  return std::isnan(answer.free_inertial_s) ? "> " + seconds(duration_s)
                                            : seconds(answer.free_inertial_s);
}

void print_answers(const std::vector<SolvedImu>& solved) {
  std::vector<std::string> headings{"<IMU"};
  for (const SolvedLimit& answer : solved.front().limits) {
    headings.push_back(words_of(answer.interval.allowed()));
  }
  Table table(headings);
  for (const SolvedImu& imu : solved) {
    std::vector<std::string> cells{imu.scene.imu_name};
    for (const SolvedLimit& answer : imu.limits) {
      cells.push_back(free_inertial(answer.interval, imu.scene.duration_s) + " / " +
                      marked(answer));
    }
    table.add(std::move(cells));
  }
  table.print();
  fmt::print(
      "  l: linear analysis alone; c: checked, trials of the {} err the same within {:.0f} % and "
      "their\n"
      "  scatter (two sigmas); t: by trials, which err otherwise\n",
      name(solved.front().scene.estimator), 100.0 * (sim::kAgreement - 1.0));
}

/// Whether the answer is only the longest time that the scene can be asked for.
bool is_longer(const SolvedLimit& answer) {
  return answer.interval.outcome == sim::Interval::Outcome::kAlways &&
         answer.mark() != sim::Mark::kByTrials;
}

/// How often, in the words of the paper's conclusion.
std::string how_often(double interval_s) {
  if (interval_s < 60.0) return fmt::format("{} s: more than once a minute", seconds(interval_s));
  if (interval_s < 600.0) return fmt::format("{:.1f} minutes", interval_s / 60.0);
  return fmt::format("{:.0f} minutes: tens of minutes", interval_s / 60.0);
}

/// The paper's conclusion, answered at its own error of 100 m or the largest limit asked for.
void print_conclusion(const std::vector<SolvedImu>& solved) {
  const auto largest = [](const SolvedImu& imu) {
    return *std::max_element(imu.limits.begin(), imu.limits.end(),
                             [](const SolvedLimit& a, const SolvedLimit& b) {
                               return a.interval.limit_m < b.interval.limit_m;
                             });
  };
  fmt::print("\nHow often a fix is needed to stay within {}\n",
             words_of(largest(solved.front()).interval.allowed()));
  Table table({"<IMU", "<without calibration", "<calibrated by the fixes"});
  for (const SolvedImu& imu : solved) {
    const SolvedLimit answer = largest(imu);
    table.add({imu.scene.imu_name,
               std::isnan(answer.interval.free_inertial_s)
                   ? "never within the scene"
                   : how_often(answer.interval.free_inertial_s),
               std::isnan(answer.interval_s())
                   ? "no interval is short enough"
                   : (is_longer(answer) ? "more than " : "") + how_often(answer.interval_s())});
  }
  table.print();
}

/// Where the filter takes its error for smaller than it is.
void print_optimism(const std::vector<SolvedImu>& solved) {
  constexpr double kWorthSaying = 1.05;
  Table table({"<IMU", "limit", "interval, s", "true, m", "claimed, m", "<the filter is"});
  bool any = false;
  double pessimism = 1.0;
  for (const SolvedImu& imu : solved) {
    for (const SolvedLimit& answer : imu.limits) {
      const sim::Interval& a = answer.interval;
      const double ratio = a.true_m / a.claimed_m;
      pessimism = std::max(pessimism, 1.0 / ratio);
      if (ratio < kWorthSaying) continue;
      any = true;
      table.add({imu.scene.imu_name, words_of(a.allowed()), calibrated(a), number(a.true_m, 2),
                 number(a.claimed_m, 2), fmt::format("optimistic by x{:.2f}", ratio)},
                Tone::kDoubtful);
    }
  }
  if (any) {
    fmt::print("\nErrors that the filter does not model\n");
    table.print();
  }
  if (pessimism < kWorthSaying) return;
  fmt::print("\nThe filter claims up to x{:.2f} the error that it makes.\n", pessimism);
}

std::string verdict(const sim::Confirmation& c) {
  if (!c.agrees) {
    return "trials contradict: " +
           (c.interval_s ? seconds(*c.interval_s) + " s" : std::string("no interval found"));
  }
  return c.consistent ? "agree" : "agree; the filter claims otherwise";
}

void print_confirmations(const std::vector<SolvedImu>& solved) {
  Table table({"<IMU", "limit", "linear, s", "trials", "error / linear", "+-", "RMS / sigma",
               "NEES", "95 % band", "diverged", "<verdict"});
  bool any = false;
  for (const SolvedImu& imu : solved) {
    for (const SolvedLimit& answer : imu.limits) {
      if (!answer.confirmation) continue;
      any = true;
      const sim::Confirmation& c = *answer.confirmation;
      const sim::CampaignResult& r = c.campaign;
      table.add({imu.scene.imu_name, words_of(answer.interval.allowed()),
                 seconds(answer.interval.interval_s), std::to_string(r.trials),
                 number(c.error_over_true, 3), number(c.scatter, 3), number(r.rms_over_sigma, 3),
                 number(r.mean_nees, 2), fmt::format("{:.2f} to {:.2f}", r.nees_low, r.nees_high),
                 std::to_string(r.diverged), verdict(c)},
                c.agrees ? Tone::kGood : Tone::kBad);
    }
  }
  if (any) {
    fmt::print("\nTrials of the {} at these intervals\n", name(solved.front().scene.estimator));
    table.print();
  }
  for (const SolvedImu& imu : solved) {
    for (const SolvedLimit& answer : imu.limits) {
      if (answer.failure.empty()) continue;
      fmt::print("  {} at {} could not be tried: {}\n", imu.scene.imu_name,
                 words_of(answer.interval.allowed()), answer.failure);
    }
  }
}

/// What each sensor and constraint of the vehicle buys.
void print_aiding(const SolvedImu& imu) {
  if (imu.aided.empty()) return;
  fmt::print("\nWhat the vehicle tells beside its receiver, {} at {}, linear\n", imu.scene.imu_name,
             words_of(imu.scene.limit.allowed()));
  Table table({"<aiding", "interval, s", "<"});
  for (const AidedInterval& aided : imu.aided) {
    table.add({aided.aiding, calibrated(aided.interval), aided.is_the_scenes ? "the scene's" : ""});
  }
  table.print();
}

void print_how(const std::vector<SolvedImu>& solved) {
  double step_effect = 0.0;
  std::size_t settled = 0;
  std::size_t all = 0;
  for (const SolvedImu& imu : solved) {
    for (const SolvedLimit& answer : imu.limits) {
      step_effect = std::max(step_effect, answer.interval.step_effect);
      settled += answer.interval.settled ? 1U : 0U;
      ++all;
    }
  }
  fmt::print(
      "\nBy covariance analysis in steps of {:g} s; halving them changes an error by {:.2g} % at "
      "most.\n",
      sim::IntervalConfig{}.covariance_step_s, 100.0 * step_effect);
  fmt::print(
      "{} of {} have settled (every sigma repeats to 0.1 %); the others are for the scene's end.\n",
      settled, all);
}

Json imu_json(const std::string& imu) {
  const auto in_range = sim::class_of_name(imu);
  if (!in_range) return {{"imu", imu}, {"range", nullptr}};
  return {{"imu", name(in_range->imu_class)}, {"range", name(in_range->range)}};
}

Json confirm_json(const sim::Confirmation& c) {
  const sim::CampaignResult& r = c.campaign;
  return {{"trials", r.trials},
          {"rms_over_sigma", r.rms_over_sigma},
          {"rms_over_true", c.rms_over_true},
          {"error_over_true", c.error_over_true},
          {"scatter", c.scatter},
          {"nees", r.mean_nees},
          {"nees_low", r.nees_low},
          {"nees_high", r.nees_high},
          {"diverged", r.diverged},
          {"agrees", c.agrees},
          {"monte_carlo_interval_s", c.interval_s ? Json(*c.interval_s) : Json()}};
}

Json coasts_json(const SolvedImu& imu) {
  Json rows = Json::array();
  for (const sim::Coast& c : imu.coasts) {
    Json row = imu_json(imu.scene.imu_name);
    row["metric"] = name(imu.scene.limit.metric);
    row.update(coast_json(c));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json answer_row(const SolvedImu& imu, const SolvedLimit& answer) {
  const sim::Interval& a = answer.interval;
  const bool has_trials = answer.confirmation.has_value();
  Json row = imu_json(imu.scene.imu_name);
  row["motion"] = imu.scene.trajectory.name;
  row["bias_model"] = name(sim::bias_model_of(imu.scene.imu));
  row["metric"] = name(imu.scene.limit.metric);
  row.update(limit_json(a.allowed()));
  row["interval_s"] = a.interval_s;
  row["mark"] = name(answer.mark());
  row["answer_s"] = answer.interval_s();
  row["free_inertial_s"] = a.free_inertial_s;
  row["consistent"] = has_trials ? Json(answer.confirmation->consistent) : Json();
  row["confirm"] = has_trials ? confirm_json(*answer.confirmation) : Json();
  row["not_tried"] = answer.failure.empty() ? Json() : Json(answer.failure);
  row["outcome"] = name(a.outcome);
  row["error_m"] = a.true_m;
  row["allowed_m"] = a.allowed_m;
  row["claimed_error_m"] = a.claimed_m;
  row["settled"] = a.settled;
  row["covariance_step_effect"] = a.step_effect;
  if (answer.sensitivity) row.update(sensitivity_json(a, *answer.sensitivity));
  return row;
}

Json aided_json(const SolvedImu& imu) {
  Json rows = Json::array();
  for (const AidedInterval& aided : imu.aided) {
    Json row = limit_json(aided.interval.allowed());
    row.update({{"aiding", aided.aiding},
                {"is_the_scenes", aided.is_the_scenes},
                {"imu", imu.scene.imu_name},
                {"interval_s", aided.interval.interval_s}});
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

double SolvedLimit::interval_s() const {
  if (mark() != sim::Mark::kByTrials) return interval.interval_s;
  return confirmation->interval_s.value_or(std::numeric_limits<double>::quiet_NaN());
}

void print_interval_tables(const std::vector<SolvedImu>& solved) {
  const sim::Scene& scene = solved.front().scene;
  fmt::print("Scene '{}' ({}), evaluated after {:g} s\n", scene.name, scene.trajectory.name,
             scene.duration_s);
  if (scene.gnss.settle_s > 0.0) {
    fmt::print(
        "Fixes every {:g} s for the first {:g} s, then at the interval; every error after "
        "that counts\n",
        scene.gnss.settle_interval_s, scene.gnss.settle_s);
  }
  fmt::print("{}", preset_line(scene.limit));
  if (solved.front().limits.empty()) {
    fmt::print("The scene has outages: the {} at their ends, fixes every {:g} s else\n",
               words_of(scene.limit.metric), scene.gnss.interval_s);
    std::vector<NamedCoasts> coasts;
    for (const SolvedImu& imu : solved) coasts.push_back({imu.scene.imu_name, imu.coasts});
    return print_coasts(coasts);
  }
  fmt::print(
      "Time without fixes from a perfect start / longest time between fixes, s, for the {} "
      "below\n",
      words_of(scene.limit.metric));
  print_answers(solved);
  for (const SolvedImu& imu : solved) print_aiding(imu);
  print_conclusion(solved);
  print_optimism(solved);
  print_confirmations(solved);
  print_how(solved);
  for (const SolvedImu& imu : solved) {
    for (const SolvedLimit& answer : imu.limits) {
      if (!answer.sensitivity) continue;
      print_sensitivity(imu.scene, answer.interval, *answer.sensitivity);
    }
  }
}

Json interval_json(const std::vector<SolvedImu>& solved) {
  Json results = Json::array();
  Json coasts = Json::array();
  Json aided = Json::array();
  for (const SolvedImu& imu : solved) {
    for (const SolvedLimit& answer : imu.limits) results.push_back(answer_row(imu, answer));
    for (const Json& row : coasts_json(imu)) coasts.push_back(row);
    for (const Json& row : aided_json(imu)) aided.push_back(row);
  }
  Json input = scene_json(solved.front().scene);
  for (const char* varies : {"imu_model", "bias_model", "limit", "limit_m", "share"}) {
    input.erase(varies);
  }
  Json answer = answer_json("interval", std::move(input), std::move(results));
  if (!coasts.empty()) answer["outages"] = std::move(coasts);
  if (!aided.empty()) answer["aiding"] = std::move(aided);
  return answer;
}

}  // namespace leeway::cli
