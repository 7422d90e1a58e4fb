#include "leeway/logs/csv_writer.hpp"
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

void add_log_options(CLI::App& app, FuseLogs& logs) {
  CLI::Option* drive =
      app.add_option("--drive", logs.drives,
                     "a folder with imu.csv.gz, gnss.csv.gz, reference_position.csv.gz, meta.json "
                     "(mount_rpy_deg, reference_window_s) and outages.json; may be repeated")
          ->type_name("DIR");
  const auto file = [&app, drive](const std::string& name, std::filesystem::path& path,
                                  const std::string& description) {
    add_file_option(app, "--" + name, path, description)->excludes(drive);
  };
  file("imu", logs.files.imu, "IMU log: CSV of rates or increments, KF-GINS; plain or gzip");
  file("gnss", logs.files.gnss, "GNSS log: CSV, KF-GINS, RTKLIB .pos; plain or gzip");
  for (std::size_t a = 0; a < kAidings.size(); ++a) {
    file(kAidings[a].name, logs.files.aidings[a],
         fmt::format("{}, CSV: t_s, {} and maybe {}", kAidings[a].log, kAidings[a].value_column,
                     kAidings[a].sigma_column));
  }
  file("truth", logs.files.truth,
       "truth or reference log to measure errors against; without it the errors of outages are "
       "measured against the withheld fixes");
  file("outages", logs.outages,
       "JSON [{\"start_s\": .., \"duration_s\": ..}, ..]: each is withheld alone");
  add_numbers<2>(app, "--truth-window", "FROM,TO", logs.truth_window_s,
                 "use the truth between these times only, s")
      ->excludes(drive);
  add_numbers<3>(app, "--mount", "ROLL,PITCH,YAW", logs.mount_rpy_deg,
                 "sensor axes to vehicle axes Rz(Y) Ry(P) Rx(R), deg; without it the sensor axes "
                 "are forward, right, down")
      ->excludes(drive);
  add_default_option(app, "--mount-axes", logs.mount_axes,
                     "the vehicle axes of --mount: forward-left-up or forward-right-down")
      ->check(CLI::IsMember({"flu", "frd"}));
  app.add_option("--rate-meaning", logs.files.imu_options.meaning,
                 "what a rate in the IMU log is: the value at its time, the mean since the one "
                 "before, or a value held until the next")
      ->transform(named<RateMeaning>())
      ->default_str(std::string(name(logs.files.imu_options.meaning)));
  add_numbers<2>(app, "--gnss-sigma-scale", "POS,VEL", logs.gnss_sigma_scale,
                 "multiply the standard deviations of the GNSS log (default: 1,1)");
}

void add_start_options(CLI::App& app, FuseLogs& logs) {
  CLI::Option* heading =
      app.add_option("--start-heading-deg", logs.start_heading_deg,
                     "heading of the vehicle at the start of the IMU log, clockwise from true "
                     "north, deg, where it is known: no motion is needed to find it")
          ->type_name("DEG")
          ->check(CLI::Range(-360.0, 360.0))
          ->excludes(app.get_option("--drive"));
  add_default_option(app, "--start-heading-sigma-deg", logs.start_heading_sigma_deg,
                     "standard deviation of --start-heading-deg, deg")
      ->check(CLI::Range(1e-3, 180.0))
      ->needs(heading);
}

void add_filter_options(CLI::App& app, FuseOptions& options) {
  add_imu_options(app, options.imu);
  add_numbers<3>(app, "--lever", "X,Y,Z", options.lever_arm_b_m,
                 "IMU to antenna, forward, right, down, m (default: 0,0,0)");
  EkfConfig& filter = options.filter;
  add_default_option(app, "--gnss-correlation-s", filter.gnss_correlation_s,
                     "correlation time of the GNSS position error, s; 0: white");
  add_default_option(app, "--gate", filter.gate_probability,
                     "refuse a fix that is this improbable; probability");
  add_default_option(app, "--covariance-interval-s", filter.covariance_interval_s,
                     "time between covariance propagations, s; 0: at every IMU sample");
  add_default_option(
      app, "--align-speed-mps", options.alignment.min_speed_mps,
      "the GNSS course is taken as the heading from this speed on, m/s; 1 suits a walker");
  app.add_option("--scheme", filter.strapdown.scheme, "integration scheme of the strapdown")
      ->transform(named<Scheme>())
      ->default_str(std::string(name(filter.strapdown.scheme)));
}

void add_vehicle_options(CLI::App& app, FuseVehicle& vehicle) {
  app.add_option("--vehicle", vehicle.kind,
                 "what the vehicle can do. car: it stands still at times and never slides "
                 "sideways; without --mount the mount is estimated. walker, multirotor, boat: the "
                 "course is not the heading, which is left open until the motion shows it")
      ->transform(named<VehicleKind>())
      ->default_str(std::string(name(vehicle.kind)));
  std::vector<std::string> part_names;
  for (const VehiclePart& part : kVehicleParts) part_names.emplace_back(part.name);
  app.add_option("--without", vehicle.without, "switch a part of --vehicle off; may be repeated")
      ->check(CLI::IsMember(part_names));
  app.add_flag("--estimate-mount", vehicle.estimate_mount,
               "estimate the mount even if meta.json of a --drive gives one")
      ->excludes(app.get_option("--mount"));
}

void add_timing_options(CLI::App& app, TimingConfig& timing) {
  add_default_option(app, "--position-lag-s", timing.position_lag_s,
                     "GNSS positions are those of this long before their time, s");
  add_default_option(app, "--velocity-lag-s", timing.velocity_lag_s,
                     "the same for velocities: half an epoch where they are means over one, s");
  app.add_flag("--estimate-clock", timing.estimate_clock,
               "take the offset between the clocks of receiver and IMU out, once turns show one");
}

void add_solution_options(CLI::App& app, FuseOptions& options) {
  sim::ReplayInput& files = options.logs.files;
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
      ->check(CLI::Range(1e-3, 1e4));
  app.add_flag("--as-is", files.is_as_is,
               "go on even if the logs are certainly not what they say (see leeway info)");
  app.add_flag("--verbose", options.verbose, "list every outage, also when they are more than 20");
  add_output_options(app, options.output);
}

void add_options(CLI::App& app, FuseOptions& options) {
  add_log_options(app, options.logs);
  add_log_form_options(app, options.logs.form);
  add_start_options(app, options.logs);
  add_filter_options(app, options);
  add_vehicle_options(app, options.vehicle);
  add_timing_options(app, options.timing);
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
