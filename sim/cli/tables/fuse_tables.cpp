#include "sim/cli/tables/fuse_tables.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <limits>

#include "sim/cli/output.hpp"

namespace leeway::cli {
namespace {

std::uint64_t count(const sim::ReplayResult& result, Verdict verdict) {
  return result.verdicts[static_cast<std::size_t>(verdict)];
}

/// Weighted means that skip what is not defined.
class Mean {
 public:
  void add(double value, double weight) {
    if (weight <= 0.0 || !std::isfinite(value)) return;
    sum_ += value * weight;
    weight_ += weight;
  }
  double mean() const {
    return weight_ > 0.0 ? sum_ / weight_ : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  double sum_{0.0};
  double weight_{0.0};
};

sim::RmsErrors pooled_rms(const std::vector<FuseJob>& jobs) {
  sim::RmsErrors pooled;
  const auto pool = [&jobs](double sim::RmsErrors::*rms) {
    Mean square;
    for (const FuseJob& job : jobs) {
      square.add(std::pow(job.result.rms.*rms, 2), static_cast<double>(job.result.rms.epochs));
    }
    return std::sqrt(square.mean());
  };
  for (const FuseJob& job : jobs) pooled.epochs += job.result.rms.epochs;
  pooled.horizontal_m = pool(&sim::RmsErrors::horizontal_m);
  pooled.vertical_m = pool(&sim::RmsErrors::vertical_m);
  pooled.velocity_mps = pool(&sim::RmsErrors::velocity_mps);
  pooled.attitude_deg = pool(&sim::RmsErrors::attitude_deg);
  return pooled;
}

const char* against_text(sim::Against against) {
  switch (against) {
    case sim::Against::kReference:
      return "reference";
    case sim::Against::kGnss:
      return "withheld fix";
    case sim::Against::kNothing:
      break;
  }
  return "nothing there";
}

void print_inputs(const FuseJob& job) {
  Table table({"<log", "<format", "lines", "damaged", "<file"});
  const auto add = [&table](const char* log, const std::string& format, const LogSummary& summary,
                            const std::filesystem::path& path) {
    table.add({log, format, std::to_string(summary.lines), std::to_string(summary.damaged_lines()),
               path.string()});
  };
  add("IMU", job.imu_format, job.result.imu_summary, job.input.imu);
  add("GNSS", job.gnss_format, job.result.gnss_summary, job.input.gnss);
  for (std::size_t a = 0; a < kAidings.size(); ++a) {
    if (job.input.aidings[a].empty()) continue;
    add(kAidings[a].name, "CSV", job.result.aiding_summaries[a], job.input.aidings[a]);
  }
  if (!job.input.truth.empty()) add("truth", "CSV", job.result.truth_summary, job.input.truth);
  fmt::print("Input\n");
  table.print();
}

const char* why_no_solution(const sim::ReplayResult& r) {
  return r.fixes_in_span == 0
             ? "no fix falls into the time of the IMU data, so never aligned; t_s of both logs "
               "must "
               "count from the same moment"
             : "never moved with a usable course, so never aligned (see --align-speed-mps)";
}

void print_run(const FuseJob& job) {
  const sim::ReplayResult& r = job.result;
  print_inputs(job);
  if (r.has_solution) {
    fmt::print("\nSolution from {:.3f} to {:.3f} s\n", r.first_solution_s, r.last_solution_s);
  } else {
    fmt::print("\nNo solution: {}\n", why_no_solution(r));
  }
  Table verdicts({"<verdict", "inputs"});
  for (std::size_t v = 0; v < kVerdicts; ++v) {
    if (r.verdicts[v] > 0) {
      verdicts.add({std::string(name(static_cast<Verdict>(v))), std::to_string(r.verdicts[v])});
    }
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
  bool reference = false;
  bool gnss = false;
  for (const sim::OutageResult& r : outages) {
    reference = reference || r.against == sim::Against::kReference;
    gnss = gnss || r.against == sim::Against::kGnss;
  }
  fmt::print("\nOutages: error at the end against {}\n",
             reference && gnss ? "the reference, where there is none against the withheld fixes"
             : gnss            ? "the withheld fixes"
                               : "the reference");
  Table table({"duration, s", "count", "unscored", "RMS h, m", "median h, m", "largest h, m",
               "RMS v, m", "RMS h / sigma"});
  for (const sim::OutageSummary& s : sim::summarize(outages)) {
    const auto cell = [&s](double value) { return s.count > 0 ? number(value, 2) : "-"; };
    table.add({fmt::format("{:g}", s.duration_s), std::to_string(s.count),
               std::to_string(s.unscored), cell(s.rms_end_h_m), cell(s.median_end_h_m),
               cell(s.max_end_h_m), cell(s.rms_end_v_m), cell(s.rms_over_sigma_h)});
  }
  table.print();
}

void print_outages(const std::vector<FuseJob>& jobs) {
  fmt::print("\nOutages one by one\n");
  Table table({"<run", "start, s", "duration, s", "end h, m", "end v, m", "largest h, m",
               "sigma h, m", "<against"});
  for (const FuseJob& job : jobs) {
    for (const sim::OutageResult& r : job.result.outages) {
      const bool scored = r.against != sim::Against::kNothing;
      const auto cell = [scored](double value) { return scored ? number(value, 2) : "-"; };
      table.add({job.drive.empty() ? "-" : job.drive, number(r.outage.start_s, 2),
                 fmt::format("{:g}", r.outage.duration_s), cell(r.end_error_h_m),
                 cell(r.end_error_v_m), cell(r.max_error_h_m), cell(r.end_sigma_h_m),
                 against_text(r.against)});
    }
  }
  table.print();
}

void warn_of_log(const char* log, const std::filesystem::path& path, const LogSummary& summary) {
  if (summary.carried_over > 0) {
    spdlog::warn("{} log {}: {} of {} lines repeat the time of the line before: their increments "
                 "were added to the next one",
                 log, path.string(), summary.carried_over, summary.lines);
  }
  if (summary.damaged_lines() > 0) {
    spdlog::warn("{} log {}: {} of {} lines are damaged and not used", log, path.string(),
                 summary.damaged_lines(), summary.lines);
    for (const std::string& message : summary.messages) spdlog::warn("  {}", message);
  }
  if (!summary.incomplete.empty()) {
    spdlog::warn("{} log {} ends early: {}", log, path.string(), summary.incomplete);
  }
}

}  // namespace

FuseTotals totals_of(const std::vector<FuseJob>& jobs) {
  FuseTotals totals;
  Mean nis;
  Mean dof;
  for (const FuseJob& job : jobs) {
    const sim::ReplayResult& r = job.result;
    for (std::size_t v = 0; v < kVerdicts; ++v) totals.verdicts[v] += r.verdicts[v];
    const auto fused = static_cast<double>(count(r, Verdict::kFused));
    nis.add(r.nis_mean, fused);
    dof.add(r.nis_dof_mean, fused);
    totals.outages.insert(totals.outages.end(), r.outages.begin(), r.outages.end());
  }
  totals.nis_mean = nis.mean();
  totals.nis_dof_mean = dof.mean();
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
  if (!outages.empty() && (outages.size() <= kListed || options.output.verbose)) {
    print_outages(jobs);
  }
  fmt::print("\nIMU model: {}", imu_name);
  if (!options.output.solution.empty()) {
    fmt::print("; solution: {}", options.output.solution.string());
  }
  fmt::print("\n");
}

void warn(const FuseJob& job) {
  const sim::ReplayResult& r = job.result;
  const std::string where = job.drive.empty() ? "" : job.drive + ": ";
  warn_of_log("IMU", job.input.imu, r.imu_summary);
  warn_of_log("GNSS", job.input.gnss, r.gnss_summary);
  for (std::size_t a = 0; a < kAidings.size(); ++a) {
    warn_of_log(kAidings[a].name, job.input.aidings[a], r.aiding_summaries[a]);
  }
  if (!job.input.truth.empty()) warn_of_log("truth", job.input.truth, r.truth_summary);
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
    spdlog::warn("{}{} fixes were refused by the gate", where, n);
  }
  if (!r.has_solution) spdlog::warn("{}no solution: {}", where, why_no_solution(r));
  constexpr double kUpsideDownDeg = 90.0;
  if (std::abs(r.final_roll_deg) > kUpsideDownDeg) {
    spdlog::warn(
        "{}roll is {:.0f} deg: the vertical sensor axis points up, and body axes are forward, "
        "right, down; give --mount, see leeway fuse --help",
        where, r.final_roll_deg);
  }
}

}  // namespace leeway::cli
