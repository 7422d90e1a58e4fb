#include "sim/cli/tables/replay_tables.hpp"

#include <spdlog/fmt/ranges.h>

#include <cmath>

#include "leeway/sim/tools/quantile.hpp"
#include "sim/cli/limit_options.hpp"

namespace leeway::cli {
namespace {

using sim::Banded;
using Supports = sim::SupportedInterval::Outcome;

std::string with_band(const Banded& b, int decimals) {
  if (std::isnan(b.low)) return number(b.value, decimals);
  return fmt::format("{} ({}..{})", number(b.value, decimals), number(b.low, decimals),
                     number(b.high, decimals));
}

const char* sign_of(Supports outcome) {
  return outcome == Supports::kShorter ? "below " : outcome == Supports::kLonger ? "at least " : "";
}

std::string interval_text(Supports outcome, double interval_s) {
  return sign_of(outcome) + seconds(interval_s);
}

std::string band_text(const Banded& b) {
  return std::isnan(b.low) ? "-" : seconds(b.low) + " to " + seconds(b.high);
}

void print_log(const NamedStudy& log) {
  const sim::LogStudy& s = log.study;
  if (!s.has_solution) return fmt::print("{}: no solution\n", log.name);
  fmt::print("{}: all fixes from {:.0f} to {:.0f} s, fewer until {:.0f} s; errors against {}\n",
             log.name, s.first_s, s.settled_s, s.last_s,
             s.against == sim::Against::kReference ? "the reference" : "withheld fixes");
  const sim::LogReceiver& r = s.receiver;
  fmt::print("  receiver: every {:g} s, sigma {:.2f} m, {:.2f} m/s (claim x {:.2f}, {:.2f})\n",
             r.interval_s, r.sigma_h_m, r.sigma_h_mps, r.position_scale, r.velocity_scale);
  if (!s.not_expected.empty()) fmt::print("  not predicted: {}\n", s.not_expected);
}

void print_outages(const sim::StudyAnswer& answer) {
  fmt::print("\nOutages that begin while moving: horizontal error, m (90 % band)\n");
  Table table({"duration, s", "outages", "end R50", "R68", "R95", "largest R50", "R68", "R95"});
  for (const sim::OutageAnswer& o : answer.outages) {
    std::vector<std::string> row{fmt::format("{:g}", o.duration_s), std::to_string(o.outages)};
    for (const auto& errors : {o.end_h_m, o.largest_h_m}) {
      for (const Banded& b : errors) row.push_back(with_band(b, 1));
    }
    table.add(row);
  }
  table.print();
}

void print_intervals(const sim::StudyAnswer& answer, ErrorMetric metric) {
  fmt::print("\nFixes further apart: {} just before a fix, m\n", words_of(metric));
  Table table({"interval, s", "fixes", "measured (90 % band)", "predicted"});
  for (const sim::IntervalErrors& e : answer.intervals) {
    if (e.fixes == 0) continue;
    table.add({fmt::format("{:g}", e.interval_s), std::to_string(e.fixes),
               with_band(e.measured_m, 2), number(e.expected_m, 2)});
  }
  table.print();
}

void add_supported(Table& table, const std::string& log, const sim::StudyAnswer& answer) {
  constexpr double kHonest = 1.4;
  for (const sim::SupportedInterval& s : answer.supported) {
    const double ratio = s.expected_over_measured();
    const bool is_honest = ratio < kHonest && ratio > 1.0 / kHonest;
    table.add({log, fmt::format("{:g}", s.limit_m),
               interval_text(s.measured_outcome, s.measured_s.value), band_text(s.measured_s),
               interval_text(s.expected_outcome, s.expected_s), number(ratio, 2)},
              std::isnan(ratio) ? Tone::kPlain
              : is_honest       ? Tone::kGood
                                : Tone::kDoubtful);
  }
}

/// The intervals that the logs support, smallest first; of those at least so long, that.
std::vector<double> intervals_of_logs(const ReplayAnswer& answer, std::size_t limit) {
  std::vector<double> intervals_s;
  for (const NamedStudy& log : answer.logs) {
    const sim::SupportedInterval& s = log.answer.supported[limit];
    if (s.measured_outcome != Supports::kUnknown) intervals_s.push_back(s.measured_s.value);
  }
  std::sort(intervals_s.begin(), intervals_s.end());
  return intervals_s;
}

void print_distribution(const ReplayAnswer& answer) {
  fmt::print("\nThe interval over the logs, s\n");
  Table table({"limit, m", "logs", "shortest", "R25", "median", "R75", "longest"});
  for (std::size_t k = 0; k < answer.pooled.supported.size(); ++k) {
    const std::vector<double> s = intervals_of_logs(answer, k);
    if (s.empty()) continue;
    table.add({fmt::format("{:g}", answer.pooled.supported[k].limit_m), std::to_string(s.size()),
               seconds(s.front()), seconds(sim::quantile_of(s, 0.25)),
               seconds(sim::quantile_of(s, 0.5)), seconds(sim::quantile_of(s, 0.75)),
               seconds(s.back())});
  }
  table.print();
  fmt::print("  Of a log whose answer is \"at least\" or \"below\": that number.\n");
}

Json banded_json(const Banded& b) { return {{"value", b.value}, {"low", b.low}, {"high", b.high}}; }

Json outages_json(const sim::StudyAnswer& answer) {
  Json all = Json::array();
  for (const sim::OutageAnswer& o : answer.outages) {
    Json json{{"duration_s", o.duration_s}, {"outages", o.outages}};
    for (std::size_t p = 0; p < sim::kOutagePercentiles.size(); ++p) {
      const int percent = static_cast<int>(std::lround(100.0 * sim::kOutagePercentiles[p]));
      json[fmt::format("end_r{}_m", percent)] = banded_json(o.end_h_m[p]);
      json[fmt::format("largest_r{}_m", percent)] = banded_json(o.largest_h_m[p]);
    }
    all.push_back(json);
  }
  return all;
}

Json answer_json(const sim::StudyAnswer& answer) {
  Json intervals = Json::array();
  for (const sim::IntervalErrors& e : answer.intervals) {
    if (e.fixes == 0) continue;
    intervals.push_back({{"interval_s", e.interval_s},
                         {"fixes", e.fixes},
                         {"measured_m", banded_json(e.measured_m)},
                         {"predicted_m", e.expected_m}});
  }
  Json supported = Json::array();
  for (const sim::SupportedInterval& s : answer.supported) {
    supported.push_back({{"limit_m", s.limit_m},
                         {"measured", name(s.measured_outcome)},
                         {"measured_s", banded_json(s.measured_s)},
                         {"predicted", name(s.expected_outcome)},
                         {"predicted_s", s.expected_s},
                         {"predicted_over_measured", s.expected_over_measured()}});
  }
  return {{"outages", outages_json(answer)}, {"errors", intervals}, {"intervals", supported}};
}

Json log_json(const NamedStudy& log) {
  const sim::LogStudy& s = log.study;
  const sim::LogReceiver& r = s.receiver;
  Json json{{"log", log.name},
            {"imu", log.imu.string()},
            {"gnss", log.gnss.string()},
            {"has_solution", s.has_solution}};
  if (!s.has_solution) return json;
  json.update({{"against", s.against == sim::Against::kReference ? "reference" : "gnss"},
               {"first_s", s.first_s},
               {"settled_s", s.settled_s},
               {"last_s", s.last_s},
               {"receiver",
                {{"interval_s", r.interval_s},
                 {"sigma_h_m", r.sigma_h_m},
                 {"sigma_v_m", r.sigma_v_m},
                 {"sigma_h_mps", r.sigma_h_mps},
                 {"sigma_v_mps", r.sigma_v_mps},
                 {"position_sigma_scale", r.position_scale},
                 {"velocity_sigma_scale", r.velocity_scale}}},
               {"imu_sigma_scale", s.imu_sigma_scale},
               {"not_predicted", s.not_expected.empty() ? Json() : Json(s.not_expected)}});
  json.update(answer_json(log.answer));
  return json;
}

}  // namespace

void print_tables(const ReplayAnswer& answer, const sim::LogStudyConfig& study) {
  for (const NamedStudy& log : answer.logs) print_log(log);
  if (answer.logs.size() > 1) fmt::print("\nAll logs together:\n");
  print_outages(answer.pooled);
  print_intervals(answer.pooled, study.metric);
  fmt::print("\nThe interval that keeps a limit on the {}, s\n", words_of(study.metric));
  Table table({"<log", "limit, m", "measured", "90 % band", "predicted", "predicted / measured"});
  for (const NamedStudy& log : answer.logs) add_supported(table, log.name, log.answer);
  if (answer.logs.size() > 1) add_supported(table, "all", answer.pooled);
  table.print();
  if (answer.logs.size() > 1) print_distribution(answer);
}

Json replay_json(const ReplayAnswer& answer, const sim::LogStudyConfig& study) {
  Json logs = Json::array();
  for (const NamedStudy& log : answer.logs) logs.push_back(log_json(log));
  Json over_logs = Json::array();
  for (std::size_t k = 0; k < answer.pooled.supported.size(); ++k) {
    over_logs.push_back({{"limit_m", answer.pooled.supported[k].limit_m},
                         {"intervals_s", intervals_of_logs(answer, k)}});
  }
  return {{"metric", name(study.metric)},
          {"logs", logs},
          {"pooled", answer_json(answer.pooled)},
          {"intervals_over_logs", over_logs}};
}

}  // namespace leeway::cli
