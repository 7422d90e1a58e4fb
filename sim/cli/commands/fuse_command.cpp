#include "sim/cli/command.hpp"
#include "sim/cli/files/output_files.hpp"
#include "sim/cli/pages/fuse_series.hpp"
#include "sim/cli/tables/fuse_tables.hpp"

namespace leeway::cli {
namespace {

/// The times of the first fix and the last one, which tell how far a replay has come.
std::pair<Time, Time> span_of(const std::filesystem::path& log, const GnssLogOptions& options) {
  std::optional<Time> first;
  Time last{};
  GnssLogReader gnss(log, options);
  while (const auto fix = gnss.next()) {
    first = first.value_or(fix->time);
    last = fix->time;
  }
  return {first.value_or(last), last};
}

/// Whether all that was asked for has an answer.
bool is_answered(const FuseJob& job) {
  const sim::ReplayResult& r = job.result;
  if (!r.has_solution || r.is_refused) return false;
  if (!job.input.truth.empty() && r.rms.epochs == 0) return false;
  return r.outages.empty() || std::any_of(r.outages.begin(), r.outages.end(), [](const auto& o) {
           return o.against != sim::Against::kNothing;
         });
}

/// @pre fuse_jobs() has opened the input: what fails from here on is the output.
/// @param series  collects what a report shows of the run; null: there is none
void replay(FuseJob& job, NavigatorConfig config, FuseSeries* series) {
  if (job.estimates_mount) config.C_bs.reset();
  writing([&] {
    Progress bar(job.input.imu.parent_path().filename().string());
    sim::ReplayObserver observer = series ? series->observer() : sim::ReplayObserver{};
    if (bar.visible() && std::filesystem::is_regular_file(job.input.gnss)) {
      observer.progress = [&bar, span = span_of(job.input.gnss, job.input.gnss_options)](Time t) {
        const auto [first, last] = span;
        if (first < last) bar.show(to_seconds(t - first) / to_seconds(last - first));
      };
    }
    job.result = sim::replay(job.input, config, observer);
  });
}

int run(const FuseOptions& options) {
  const NamedImu imu = imu_of(options.imu);
  const NavigatorConfig config = navigator_config(options, imu.model);
  std::vector<FuseJob> jobs = fuse_jobs(options);
  const bool reported = !options.output.report.empty();
  Json all_series = Json::object();
  for (FuseJob& job : jobs) {
    FuseSeries series;
    replay(job, config, reported ? &series : nullptr);
    if (reported) series.add_to(all_series, job.drive);
    warn(job);
  }
  show(
      options.output, fuse_json(options, imu.name, jobs),
      [&] { print_tables(options, imu.name, jobs); }, [&] { return all_series; });
  return std::all_of(jobs.begin(), jobs.end(), is_answered) ? kSuccess : kNoAnswer;
}

void add_solution_options(CLI::App& app, FuseOptions& options) {
  sim::ReplayInput& files = options.logs.files;
  add_file_option(app, "--outages", options.logs.outages,
                  "JSON [{\"start_s\": .., \"duration_s\": ..}, ..]: each is withheld alone")
      ->excludes(app.get_option("--drive"));
  CLI::Option* out =
      add_output_file(app, "--out", files.solution,
                      "write the solution: .pos (RTKLIB), .tum, .kml, .gpx, .geojson, or else as "
                      "CSV; gzip when .gz comes after it")
          ->excludes(app.get_option("--drive"));
  app.add_option("--out-format", files.solution_form.format,
                 "csv, pos, tum, kml, gpx or geojson, whatever the ending of --out")
      ->type_name("NAME")
      ->needs(out);
  app.add_option("--out-columns", files.solution_form.columns,
                 "columns of a CSV after t_s; also east_m, north_m, up_m")
      ->delimiter(',')
      ->type_name("NAME,..")
      ->needs(out);
  add_numbers<3>(app, "--origin", "LAT,LON,H", options.logs.origin,
                 "where east_m, north_m, up_m and .tum are zero, deg, m; without it at the first "
                 "position written")
      ->needs(out);
  add_default_option(app, "--out-rate-hz", files.solution_rate_hz,
                     "solution epochs per second, in the file and in the RMS errors")
      ->check(in_range(1e-3, 1e4));
  app.add_flag("--verbose", options.verbose, "list every outage, also when they are more than 20");
  add_output_options(app, options.output);
}

void add_options(CLI::App& app, FuseOptions& options) {
  add_log_options(app, options);
  add_solution_options(app, options);
}

const Command<FuseOptions> kFuse{
    "fuse", "Fuse an IMU and a GNSS log, and tell how far the solution is off",
    "Examples:\n"
    "  leeway fuse --imu imu.csv --gnss gnss.csv --truth truth.csv --out solution.csv\n"
    "  leeway fuse --imu imu.csv --gnss gnss.csv --vehicle car\n"
    "  leeway fuse --drive drives/one --drive drives/two --json",
    add_options, run};

}  // namespace
}  // namespace leeway::cli
