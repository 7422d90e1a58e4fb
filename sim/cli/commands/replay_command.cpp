#include "sim/cli/command.hpp"
#include "sim/cli/commands/fuse_jobs.hpp"
#include "sim/cli/jobs/on_ranks.hpp"
#include "sim/cli/limit_options.hpp"
#include "sim/cli/tables/fuse_tables.hpp"
#include "sim/cli/tables/replay_tables.hpp"
#include "sim/tools/shared_work.hpp"

namespace leeway::cli {
namespace {

struct ReplayCommand {
  FuseOptions run{};
  LimitChoice limit{};
  sim::LogStudyConfig study{};
};

/// Metric and limits, m: as asked, else 95 % within 5 m and 10 m.
std::vector<double> limits_m(const ReplayCommand& command, ErrorMetric& metric) {
  sim::ErrorLimit limit;
  limit.metric = metric;
  change_limit(command.limit, limit);
  metric = limit.metric;
  std::vector<sim::AllowedError> allowed = limits_of(command.limit.limits);
  if (!command.limit.preset.empty()) allowed = {limit.allowed()};
  if (allowed.empty()) allowed = {5.0, 10.0};
  std::vector<double> metres;
  for (const sim::AllowedError& a : allowed) {
    if (a.share > 0.0) {
      throw Error("--limit " + sim::text_of(a) +
                  ": replay measures limits that do not grow with the way: give metres alone");
    }
    metres.push_back(a.limit_m);
  }
  return metres;
}

std::string name_of(const FuseJob& job) {
  return job.drive.empty() ? job.input.imu.filename().string() : job.drive;
}

/// The logs by their size, the largest first, so that no rank gets all that take long.
std::vector<std::size_t> largest_first(const std::vector<FuseJob>& jobs) {
  std::vector<std::pair<std::uintmax_t, std::size_t>> sizes;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    std::error_code unknown;
    sizes.emplace_back(std::filesystem::file_size(jobs[k].input.imu, unknown), k);
  }
  std::stable_sort(sizes.begin(), sizes.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::size_t> order;
  for (const auto& [size, k] : sizes) order.push_back(k);
  return order;
}

/// Every log on one of the ranks, which gives it all its threads.
std::vector<sim::LogStudy> studies_of(const std::vector<FuseJob>& jobs,
                                      const NavigatorConfig& config,
                                      const sim::LogStudyConfig& study, const sim::Ranks& ranks) {
  Progress bar("replay");
  sim::LogStudyConfig of_rank = study;
  of_rank.threads = sim::threads_of_rank(study.threads, ranks);
  const std::vector<std::size_t> order = largest_first(jobs);
  const auto job = [&](std::size_t place) {
    const std::size_t k = order[place];
    NavigatorConfig own = config;
    if (jobs[k].estimates_mount) own.C_bs.reset();
    const auto warn_of_log = [&](const sim::ReplayResult& surveyed) {
      FuseJob surveyed_job = jobs[k];
      surveyed_job.result = surveyed;
      warn(surveyed_job);
    };
    return bytes_of(sim::study_log(jobs[k].input, own, of_rank, warn_of_log));
  };
  std::vector<sim::LogStudy> studies(jobs.size());
  const auto found = sim::shared_work(jobs.size(), job, ranks, std::ref(bar), 1);
  for (std::size_t place = 0; place < found.size(); ++place) {
    studies[order[place]] = sim::log_study_of(found[place]);
  }
  return studies;
}

ReplayAnswer answer_of(const std::vector<FuseJob>& jobs, std::vector<sim::LogStudy> studies,
                       const sim::LogStudyConfig& study, const std::vector<double>& limits) {
  ReplayAnswer answer;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    answer.logs.push_back(
        {name_of(jobs[k]), jobs[k].input.imu, jobs[k].input.gnss, std::move(studies[k])});
  }
  std::vector<const sim::LogStudy*> all;
  for (NamedStudy& log : answer.logs) {
    const sim::LogStudy* one = &log.study;
    log.answer = sim::answer_of({&one, 1}, study, limits);
    all.push_back(one);
  }
  answer.pooled = sim::answer_of(all, study, limits);
  return answer;
}

bool has_errors(const NamedStudy& log) {
  return std::any_of(log.answer.intervals.begin(), log.answer.intervals.end(),
                     [](const auto& e) { return e.fixes > 0; });
}

Json input_json(const ReplayCommand& command, const NamedImu& imu, const sim::LogStudyConfig& study,
                const std::vector<double>& limits) {
  return {{"imu", imu.name},
          {"vehicle", name(command.run.vehicle.kind)},
          {"limits_m", limits},
          {"metric", name(study.metric)},
          {"durations_s", study.durations_s},
          {"every_s", study.every_s},
          {"settle_s", study.settle_s},
          {"most_phases", study.most_phases},
          {"min_speed_mps", study.min_speed_mps}};
}

int run_on(const ReplayCommand& command, const sim::Ranks& ranks) {
  sim::LogStudyConfig study = command.study;
  std::sort(study.durations_s.begin(), study.durations_s.end());
  const std::vector<double> limits = limits_m(command, study.metric);
  const NamedImu imu = imu_of(command.run.imu);
  const NavigatorConfig config = navigator_config(command.run, imu.model);
  const std::vector<FuseJob> jobs = fuse_jobs(command.run);
  std::vector<sim::LogStudy> studies = studies_of(jobs, config, study, ranks);
  if (!ranks.is_first()) return kSuccess;
  const ReplayAnswer answer = answer_of(jobs, std::move(studies), study, limits);
  show(command.run.output,
       answer_json("replay", input_json(command, imu, study, limits), replay_json(answer, study)),
       [&] {
         print_tables(answer, study);
         fmt::print("\nIMU model: {}\n", imu.name);
       });
  return std::all_of(answer.logs.begin(), answer.logs.end(), has_errors) ? kSuccess : kNoAnswer;
}

int run(const ReplayCommand& command) {
  return on_ranks([&command](const sim::Ranks& ranks) { return run_on(command, ranks); });
}

void add_options(CLI::App& app, ReplayCommand& command) {
  add_log_options(app, command.run);
  add_limit_options(app, command.limit);
  sim::LogStudyConfig& study = command.study;
  app.add_option("--durations", study.durations_s, "of the outages, s; several with commas")
      ->delimiter(',')
      ->check(positive())
      ->capture_default_str()
      ->type_name("S,..");
  add_default_option(app, "--every-s", study.every_s, "an outage begins so long after another, s")
      ->check(positive());
  add_default_option(app, "--settle-s", study.settle_s,
                     "use all fixes for so long, s; at most half of the log")
      ->check(not_negative());
  add_default_option(app, "--phases", study.most_phases,
                     "beginnings of a row of thinned fixes that are tried, at most")
      ->check(in_range(1, 1000));
  add_default_option(app, "--min-speed-mps", study.min_speed_mps,
                     "an outage begins while the vehicle is as fast as this, m/s")
      ->check(not_negative());
  add_threads_option(app, study.threads);
  add_output_options(app, command.run.output);
}

const Command<ReplayCommand> kReplay{
    "replay", "How often a fix has to come on recorded logs, measured and predicted",
    "Outages and thinned fixes shifted over each log: their errors against the reference, or\n"
    "against the fixes withheld; the interval between fixes that keeps a limit, beside the one\n"
    "that the covariance analysis predicts for the log's own motion.\n"
    "Examples:\n"
    "  leeway replay --imu imu.csv --gnss gnss.csv --vehicle car --limit 5m,10m\n"
    "  leeway replay --drive drives --vehicle car --json",
    add_options, run};

}  // namespace
}  // namespace leeway::cli
