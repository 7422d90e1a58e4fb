#include "sim/cli/tables/interval_tables.hpp"

#include <cmath>

#include "sim/cli/scene_options.hpp"

namespace leeway::cli {
namespace {

/// Three significant digits, in seconds.
std::string seconds(double s) {
  if (std::isnan(s)) return "-";
  return number(s, s < 10.0 ? 2 : s < 100.0 ? 1 : 0);
}

std::string calibrated(const sim::Interval& answer) {
  if (answer.outcome == sim::Interval::Outcome::kNever) return "none";
  const bool is_longer = answer.outcome == sim::Interval::Outcome::kAlways;
  return (is_longer ? "> " : "") + seconds(answer.interval_s);
}

std::string free_inertial(const sim::Interval& answer, double duration_s) {
  return std::isnan(answer.free_inertial_s) ? "> " + seconds(duration_s)
                                            : seconds(answer.free_inertial_s);
}

void print_answers(const std::vector<SolvedImu>& solved) {
  std::vector<std::string> headings{"<IMU"};
  for (const sim::Interval& answer : solved.front().intervals) {
    headings.push_back(fmt::format("{:g} m", answer.limit_m));
  }
  Table table(headings);
  for (const SolvedImu& imu : solved) {
    std::vector<std::string> cells{imu.scene.imu_name};
    for (const sim::Interval& answer : imu.intervals) {
      cells.push_back(free_inertial(answer, imu.scene.duration_s) + " / " + calibrated(answer));
    }
    table.add(std::move(cells));
  }
  table.print();
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
    return *std::max_element(imu.intervals.begin(), imu.intervals.end(),
                             [](const auto& a, const auto& b) { return a.limit_m < b.limit_m; });
  };
  fmt::print("\nHow often a fix is needed to stay within {:g} m\n",
             largest(solved.front()).limit_m);
  Table table({"<IMU", "<without calibration", "<calibrated by the fixes"});
  for (const SolvedImu& imu : solved) {
    const sim::Interval answer = largest(imu);
    table.add({imu.scene.imu_name,
               std::isnan(answer.free_inertial_s) ? "never within the scene"
                                                  : how_often(answer.free_inertial_s),
               std::isnan(answer.interval_s) ? "no interval is short enough"
                                             : how_often(answer.interval_s)});
  }
  table.print();
}

/// Where the filter takes its error for smaller than it is.
void print_optimism(const std::vector<SolvedImu>& solved) {
  constexpr double kWorthSaying = 1.05;
  Table table({"<IMU", "limit, m", "interval, s", "true, m", "claimed, m", "<the filter is"});
  bool any = false;
  double pessimism = 1.0;
  for (const SolvedImu& imu : solved) {
    for (const sim::Interval& a : imu.intervals) {
      const double ratio = a.true_m / a.claimed_m;
      pessimism = std::max(pessimism, 1.0 / ratio);
      if (ratio < kWorthSaying) continue;
      any = true;
      table.add(
          {imu.scene.imu_name, fmt::format("{:g}", a.limit_m), calibrated(a), number(a.true_m, 2),
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
  if (c.consistent) return "consistent";
  const std::string by_monte_carlo =
      c.interval_s ? seconds(*c.interval_s) + " s" : std::string("no interval found");
  return "FILTER INCONSISTENT; by Monte Carlo " + by_monte_carlo;
}

void print_confirmations(const std::vector<SolvedImu>& solved) {
  if (solved.front().confirmations.empty()) return;
  fmt::print("\nMonte Carlo of the whole filter at these intervals\n");
  Table table({"<IMU", "limit, m", "interval, s", "trials", "RMS / sigma", "RMS / true", "NEES",
               "95 % band", "diverged", "<verdict"});
  for (const SolvedImu& imu : solved) {
    for (std::size_t i = 0; i < imu.intervals.size(); ++i) {
      if (!imu.confirmations[i]) continue;
      const sim::Confirmation& c = *imu.confirmations[i];
      const sim::CampaignResult& r = c.campaign;
      table.add({imu.scene.imu_name, fmt::format("{:g}", imu.intervals[i].limit_m),
                 seconds(imu.intervals[i].interval_s), std::to_string(r.trials),
                 number(r.rms_over_sigma, 3), number(c.rms_over_true, 3), number(r.mean_nees, 2),
                 fmt::format("{:.2f} to {:.2f}", r.nees_low, r.nees_high),
                 std::to_string(r.diverged), verdict(c)},
                c.consistent ? Tone::kGood : Tone::kBad);
    }
  }
  table.print();
}

void print_how(const std::vector<SolvedImu>& solved) {
  double step_effect = 0.0;
  std::size_t settled = 0;
  std::size_t all = 0;
  for (const SolvedImu& imu : solved) {
    for (const sim::Interval& answer : imu.intervals) {
      step_effect = std::max(step_effect, answer.step_effect);
      settled += answer.settled ? 1U : 0U;
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

/// "tactical/mid" is a class and where in its range; anything else is a name alone.
Json imu_json(const std::string& imu) {
  const std::size_t slash = imu.rfind('/');
  if (slash == imu.npos || !from_name<RangeEnd>(imu.substr(slash + 1))) {
    return {{"imu", imu}, {"range", nullptr}};
  }
  return {{"imu", imu.substr(0, slash)}, {"range", imu.substr(slash + 1)}};
}

Json confirm_json(const sim::Confirmation& c) {
  const sim::CampaignResult& r = c.campaign;
  return {{"trials", r.trials},
          {"rms_over_sigma", r.rms_over_sigma},
          {"rms_over_true", c.rms_over_true},
          {"nees", r.mean_nees},
          {"nees_low", r.nees_low},
          {"nees_high", r.nees_high},
          {"diverged", r.diverged},
          {"monte_carlo_interval_s", c.interval_s ? Json(*c.interval_s) : Json()}};
}

}  // namespace

void print_interval_tables(const std::vector<SolvedImu>& solved) {
  const sim::Scene& scene = solved.front().scene;
  fmt::print("Scene '{}' ({}), evaluated after {:g} s\n", scene.name, scene.trajectory.name,
             scene.duration_s);
  fmt::print(
      "Time without fixes from a perfect start / longest time between fixes, s, for a horizontal "
      "error ({}) below\n",
      name(scene.limit.metric));
  print_answers(solved);
  print_conclusion(solved);
  print_optimism(solved);
  print_confirmations(solved);
  print_how(solved);
}

Json interval_json(const std::vector<SolvedImu>& solved) {
  Json results = Json::array();
  for (const SolvedImu& imu : solved) {
    for (std::size_t i = 0; i < imu.intervals.size(); ++i) {
      const sim::Interval& a = imu.intervals[i];
      const bool asked = !imu.confirmations.empty() && imu.confirmations[i];
      Json row = imu_json(imu.scene.imu_name);
      row["motion"] = imu.scene.trajectory.name;
      row["bias_model"] = name(sim::bias_model_of(imu.scene.imu));
      row["metric"] = name(imu.scene.limit.metric);
      row["limit_m"] = a.limit_m;
      row["interval_s"] = a.interval_s;
      row["free_inertial_s"] = a.free_inertial_s;
      row["consistent"] = asked ? Json(imu.confirmations[i]->consistent) : Json();
      row["confirm"] = asked ? confirm_json(*imu.confirmations[i]) : Json();
      row["outcome"] = name(a.outcome);
      row["error_m"] = a.true_m;
      row["claimed_error_m"] = a.claimed_m;
      row["settled"] = a.settled;
      row["covariance_step_effect"] = a.step_effect;
      results.push_back(std::move(row));
    }
  }
  Json input = scene_json(solved.front().scene);
  for (const char* varies : {"imu_model", "bias_model", "limit_m"}) input.erase(varies);
  return answer_json("interval", std::move(input), std::move(results));
}

}  // namespace leeway::cli
