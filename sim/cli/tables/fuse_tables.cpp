#include "sim/cli/tables/fuse_tables.hpp"

#include <spdlog/spdlog.h>

#include <cmath>
#include <limits>

namespace leeway::cli {
namespace {

std::uint64_t count(const sim::ReplayResult& result, Verdict verdict) {
  return result.verdicts[static_cast<std::size_t>(verdict)];
}

/// Weighted by a count, over the runs in which the value is defined.
template <class Value, class Weight>
double mean(const std::vector<FuseJob>& jobs, const Value& value, const Weight& weight) {
  double sum = 0.0;
  double all = 0.0;
  for (const FuseJob& job : jobs) {
    const auto w = static_cast<double>(weight(job.result));
    if (w <= 0.0 || !std::isfinite(value(job.result))) continue;
    sum += value(job.result) * w;
    all += w;
  }
  return all > 0.0 ? sum / all : std::numeric_limits<double>::quiet_NaN();
}

sim::RmsErrors pooled_rms(const std::vector<FuseJob>& jobs) {
  sim::RmsErrors pooled;
  for (const FuseJob& job : jobs) pooled.epochs += job.result.rms.epochs;
  for (double sim::RmsErrors::*rms :
       {&sim::RmsErrors::horizontal_m, &sim::RmsErrors::vertical_m, &sim::RmsErrors::velocity_mps,
        &sim::RmsErrors::attitude_deg}) {
    pooled.*rms = std::sqrt(mean(
        jobs, [rms](const sim::ReplayResult& r) { return std::pow(r.rms.*rms, 2); },
        [](const sim::ReplayResult& r) { return r.rms.epochs; }));
  }
  return pooled;
}

void print_inputs(const FuseJob& job) {
  fmt::print("Input\n");
  Table table({"<log", "<format", "lines", "damaged", "<file"});
  for (const FuseLog& log : logs_of(job)) {
    table.add({log.title, log.format, std::to_string(log.summary.lines),
               std::to_string(log.summary.damaged_lines()), log.path.string()});
  }
  table.print();
}

/// The reason, and what mends it.
std::string why_no_solution(const FuseJob& job) {
  const sim::ReplayResult& r = job.result;
  const sim::FixFigures& gnss = r.look.gnss;
  if (r.is_refused) return "the logs are certainly wrong: see the warnings, or --as-is";
  if (r.fixes_in_span == 0) {
    return "no fix falls into the time of the IMU data, so never aligned; times of both logs must "
           "count from the same moment";
  }
  const std::string known = "; --start-heading-deg, where it is known, needs no motion";
  if (gnss.fastest_mps < job.align_speed_mps) {
    return fmt::format(
        "never aligned: the fastest of {} fixes is {:.2g} m/s, and the course is taken for the "
        "heading from {:g} m/s on: --align-speed-mps{}",
        gnss.time.records, gnss.fastest_mps, job.align_speed_mps, known);
  }
  return fmt::format(
      "never aligned: no course of the {} fixes ({} with velocity, every {:.3g} s, up to {:.3g} "
      "m/s) was sure enough and kept by the gyros{}",
      gnss.time.records, gnss.with_velocity, gnss.time.step_s, gnss.fastest_mps, known);
}

void print_run(const FuseJob& job) {
  const sim::ReplayResult& r = job.result;
  print_inputs(job);
  if (r.has_solution) {
    fmt::print("\nSolution from {:.3f} to {:.3f} s\n", r.first_solution_s, r.last_solution_s);
  } else {
    fmt::print("\nNo solution: {}\n", why_no_solution(job));
  }
  if (r.is_refused) return;
  Table verdicts({"<verdict", "inputs"});
  for (const Verdict verdict : kAll<Verdict>) {
    if (count(r, verdict) == 0) continue;
    verdicts.add({std::string(name(verdict)), std::to_string(count(r, verdict))});
  }
  verdicts.print();
  const FuseTotals totals = totals_of({job});
  fmt::print("  mean NIS of the fused fixes: {} (expected {})\n", number(totals.nis_mean, 2),
             number(totals.nis_dof_mean, 2));
  if (job.estimates_mount && r.mount_rpy_deg) {
    fmt::print(
        "  mount found, to forward, right, down: roll {:.1f}, pitch {:.1f}, yaw {:.1f} deg\n",
        r.mount_rpy_deg->x(), r.mount_rpy_deg->y(), r.mount_rpy_deg->z());
  }
  if (job.input.truth.empty()) return;
  fmt::print("\nErrors against the reference, RMS over {} epochs\n", r.rms.epochs);
  Table rms({"<", "horizontal, m", "vertical, m", "velocity 3-D, m/s", "attitude 3-D, deg"});
  rms.add({"solution", number(r.rms.horizontal_m, 3), number(r.rms.vertical_m, 3),
           number(r.rms.velocity_mps, 3), number(r.rms.attitude_deg, 3)});
  rms.print();
}

void print_drives(const std::vector<FuseJob>& jobs) {
  fmt::print("Drives (RMS errors against the reference within its window)\n");
  Table table({"<drive", "solution, s", "fused", "gated", "NIS", "of", "RMS h, m", "RMS v, m",
               "RMS vel, m/s", "outages"});
  for (const FuseJob& job : jobs) {
    const sim::ReplayResult& r = job.result;
    const FuseTotals totals = totals_of({job});
    table.add({job.drive,
               r.has_solution
                   ? fmt::format("{:.0f} - {:.0f}", r.first_solution_s, r.last_solution_s)
                   : "none",
               std::to_string(count(r, Verdict::kFused)), std::to_string(count(r, Verdict::kGated)),
               number(totals.nis_mean, 2), number(totals.nis_dof_mean, 2),
               number(r.rms.horizontal_m, 2), number(r.rms.vertical_m, 2),
               number(r.rms.velocity_mps, 2), std::to_string(r.outages.size())});
  }
  table.print();
}

void print_outage_summary(const std::vector<sim::OutageResult>& outages) {
  const auto any = [&outages](sim::Against against) {
    return std::ranges::count(outages, against, &sim::OutageResult::against) > 0;
  };
  const bool reference = any(sim::Against::kReference);
  const bool gnss = any(sim::Against::kGnss);
  fmt::print("\nOutages: error at the end against {}\n",
             reference && gnss ? "the reference, where there is none against the withheld fixes"
             : gnss            ? "the withheld fixes"
                               : "the reference");
  const std::vector<sim::OutageSummary> summaries = sim::summarize(outages);
  Table table = table_of(outage_row(summaries.front()));
  for (const sim::OutageSummary& s : summaries) add_row(table, outage_row(s));
  table.print();
}

void print_outages(const std::vector<FuseJob>& jobs) {
  fmt::print("\nOutages one by one\n");
  Table table = table_of(outage_row({}, sim::OutageResult{}));
  for (const FuseJob& job : jobs) {
    for (const sim::OutageResult& r : job.result.outages) add_row(table, outage_row(job, r));
  }
  table.print();
}

/// The gate counts what sensors beside the receiver read too.
const char* what_is_gated(const FuseJob& job) {
  const auto& aidings = job.input.aidings;
  const bool is_aided =
      std::any_of(aidings.begin(), aidings.end(), [](const auto& path) { return !path.empty(); });
  return is_aided ? "measurements (fixes, or readings of other sensors)" : "fixes";
}

void warn_of_clock(const Health& health, const std::string& where) {
  const double ms = 1000.0 * std::abs(health.clock_offset_s);
  const double sigma_ms = 1000.0 * health.clock_offset_sigma_s;
  const char* direction = health.clock_offset_s > 0.0 ? "older" : "younger";
  if (health.clock_offset_of_velocity) {
    spdlog::warn(
        "{}velocities are {:.0f} +- {:.0f} ms {} than their fixes: --velocity-lag-s {:.3f}", where,
        ms, sigma_ms, direction, health.clock_offset_s);
    return;
  }
  spdlog::warn(
      "{}fixes are {:.0f} +- {:.0f} ms {} than their times say, by the clock of the IMU: "
      "--estimate-clock takes that out (a wrong --lever looks alike: 1 m at 10 m/s is 100 ms)",
      where, ms, sigma_ms, direction);
}

void warn_of(const std::vector<sim::Finding>& findings, const std::string& where) {
  for (const sim::Finding& f : findings) {
    if (f.certainty == sim::Certainty::kNote) continue;
    spdlog::warn("{}{}: {}{}{}", where, f.log, f.text,
                 f.remedy.empty() ? "" : "; mend it: ", f.remedy);
  }
}

void warn_of(const FuseLog& log) {
  const LogSummary& summary = log.summary;
  for (const std::string& note : summary.notes) {
    spdlog::warn("{} log {}: {}", log.title, log.path.string(), note);
  }
  if (summary.carried_over > 0) {
    spdlog::warn(
        "{} log {}: {} of {} lines repeat the time of the line before: their increments "
        "were added to the next one",
        log.title, log.path.string(), summary.carried_over, summary.lines);
  }
  if (summary.damaged_lines() > 0) {
    spdlog::warn("{} log {}: {} of {} lines are damaged and not used", log.title, log.path.string(),
                 summary.damaged_lines(), summary.lines);
    for (const std::string& message : summary.messages) spdlog::warn("  {}", message);
  }
  if (!summary.incomplete.empty()) {
    spdlog::warn("{} log {} ends early: {}", log.title, log.path.string(), summary.incomplete);
  }
}

}  // namespace

std::vector<FuseLog> logs_of(const FuseJob& job) {
  const sim::ReplayInput& in = job.input;
  const sim::ReplayResult& r = job.result;
  std::vector<FuseLog> logs{{"imu", "IMU", job.imu_format, in.imu, r.imu_summary},
                            {"gnss", "GNSS", job.gnss_format, in.gnss, r.gnss_summary}};
  for (std::size_t a = 0; a < kAidings.size(); ++a) {
    if (in.aidings[a].empty()) continue;
    const char* name = kAidings[a].name;
    logs.push_back({name, name, "CSV", in.aidings[a], r.aiding_summaries[a]});
  }
  if (!in.truth.empty()) logs.push_back({"truth", "truth", "CSV", in.truth, r.truth_summary});
  return logs;
}

Row outage_row(const FuseJob& job, const sim::OutageResult& r) {
  const bool by_reference = r.against == sim::Against::kReference;
  const bool is_scored = r.against != sim::Against::kNothing;
  const auto scored = [is_scored](double value) { return is_scored ? Json(value) : Json(); };
  return {{"<run", "", job.drive.empty() ? "-" : job.drive},
          {"start, s", "start_s", r.outage.start_s, 2},
          {"duration, s", "", fmt::format("{:g}", r.outage.duration_s)},
          {"", "duration_s", r.outage.duration_s},
          {"end h, m", "end_error_h_m", scored(r.end_error_h_m), 2},
          {"end v, m", "end_error_v_m", scored(r.end_error_v_m), 2},
          {"largest h, m", "max_error_h_m", scored(r.max_error_h_m), 2},
          {"sigma h, m", "end_sigma_h_m", scored(r.end_sigma_h_m), 2},
          {"<against", "",
           by_reference ? "reference"
           : is_scored  ? "withheld fix"
                        : "nothing there"},
          {"", "against", is_scored ? Json(by_reference ? "reference" : "gnss") : Json()}};
}

Row outage_row(const sim::OutageSummary& s) {
  const auto scored = [&s](double value) { return s.count > 0 ? Json(value) : Json(); };
  return {{"duration, s", "", fmt::format("{:g}", s.duration_s)},
          {"", "duration_s", s.duration_s},
          {"count", "count", s.count},
          {"unscored", "unscored", s.unscored},
          {"RMS h, m", "rms_end_h_m", scored(s.rms_end_h_m), 2},
          {"median h, m", "median_end_h_m", scored(s.median_end_h_m), 2},
          {"largest h, m", "max_end_h_m", scored(s.max_end_h_m), 2},
          {"RMS v, m", "rms_end_v_m", scored(s.rms_end_v_m), 2},
          {"RMS h / sigma", "rms_over_sigma_h", scored(s.rms_over_sigma_h), 2}};
}

FuseTotals totals_of(const std::vector<FuseJob>& jobs) {
  FuseTotals totals;
  for (const FuseJob& job : jobs) {
    const sim::ReplayResult& r = job.result;
    for (std::size_t v = 0; v < kVerdicts; ++v) totals.verdicts[v] += r.verdicts[v];
    totals.outages.insert(totals.outages.end(), r.outages.begin(), r.outages.end());
  }
  const auto fused = [](const sim::ReplayResult& r) { return count(r, Verdict::kFused); };
  totals.nis_mean = mean(jobs, std::mem_fn(&sim::ReplayResult::nis_mean), fused);
  totals.nis_dof_mean = mean(jobs, std::mem_fn(&sim::ReplayResult::nis_dof_mean), fused);
  totals.rms = pooled_rms(jobs);
  return totals;
}

void print_tables(const FuseOptions& options, const std::string& imu_name,
                  const std::vector<FuseJob>& jobs) {
  constexpr std::size_t kListed = 20;
  if (jobs.size() == 1) {
    print_run(jobs.front());
  } else {
    print_drives(jobs);
  }
  const std::vector<sim::OutageResult> outages = totals_of(jobs).outages;
  if (!outages.empty()) print_outage_summary(outages);
  if (!outages.empty() && (outages.size() <= kListed || options.verbose)) {
    print_outages(jobs);
  }
  fmt::print("\nIMU model: {}", imu_name);
  const std::filesystem::path& solution = options.logs.files.solution;
  if (!solution.empty() && !jobs.front().result.is_refused)
    fmt::print("; solution: {}", solution.string());
  fmt::print("\n");
}

void warn(const FuseJob& job) {
  const sim::ReplayResult& r = job.result;
  const std::string where = job.drive.empty() ? "" : job.drive + ": ";
  for (const FuseLog& log : logs_of(job)) warn_of(log);
  warn_of(r.look.findings, where);
  if (r.is_refused) {
    spdlog::error("{}nothing is made of logs that are certainly wrong; --as-is does", where);
    return;
  }
  if (const auto n = count(r, Verdict::kGap); n > 0) {
    spdlog::warn("{}{} gaps in the IMU data were bridged at constant velocity", where, n);
  }
  if (const auto n = count(r, Verdict::kReset); n > 0) {
    spdlog::warn(
        "{}position and velocity began anew {} times, after fixes that agreed with each "
        "other had been refused",
        where, n);
  }
  if (r.health.repairs > 0) {
    spdlog::warn("{}the covariance had to be repaired {} times", where, r.health.repairs);
  }
  if (job.estimates_mount && !r.mount_rpy_deg) {
    spdlog::warn("{}the mount was not found: that takes 3 s straight on at more than 5 m/s", where);
  }
  if (const auto n = count(r, Verdict::kGated); n > 0) {
    spdlog::warn("{}{} {} were refused by the gate", where, n, what_is_gated(job));
  }
  if (const auto n = count(r, Verdict::kPartly); n > 0) {
    spdlog::warn("{}of {} fixes the gate refused the position or the velocity", where, n);
  }
  if (r.health.clock_offset_detected) warn_of_clock(r.health, where);
  if (!r.has_solution) spdlog::warn("{}no solution: {}", where, why_no_solution(job));
  constexpr double kUpsideDownDeg = 90.0;
  if (std::abs(r.final_roll_deg) > kUpsideDownDeg) {
    spdlog::warn(
        "{}roll is {:.0f} deg: the vertical sensor axis points up, and body axes are forward, "
        "right, down; give --mount, see leeway fuse --help",
        where, r.final_roll_deg);
  }
}

}  // namespace leeway::cli
