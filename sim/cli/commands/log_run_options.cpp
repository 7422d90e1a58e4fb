#include "sim/cli/commands/fuse_jobs.hpp"

namespace leeway::cli {
namespace {

void add_file_options(CLI::App& app, FuseLogs& logs) {
  CLI::Option* drive =
      app.add_option("--drive", logs.drives,
                     "a folder with imu.csv.gz, gnss.csv.gz, reference_position.csv.gz, meta.json "
                     "(mount_rpy_deg, reference_window_s) and maybe outages.json, or a folder of "
                     "such; may be repeated")
          ->type_name("DIR");
  const auto file = [&app, drive](const std::string& name, std::filesystem::path& path,
                                  const std::string& description) {
    add_file_option(app, "--" + name, path, description)->excludes(drive);
  };
  file("imu", logs.files.imu,
       "IMU log: CSV of rates or increments, KF-GINS, u-blox UBX, PX4 ULog; plain or gzip; or the "
       "folder of a phone's recording");
  file("gnss", logs.files.gnss,
       "GNSS log: CSV, KF-GINS, RTKLIB .pos, NMEA, u-blox UBX, PX4 ULog; plain or gzip; or the "
       "folder of a phone's recording");
  for (std::size_t a = 0; a < kAidings.size(); ++a) {
    file(kAidings[a].name, logs.files.aidings[a],
         fmt::format("{}, CSV: t_s, {} and maybe {}", kAidings[a].log, kAidings[a].value_column,
                     kAidings[a].sigma_column));
  }
  file("truth", logs.files.truth,
       "truth or reference log to measure errors against; without it the errors of outages are "
       "measured against the withheld fixes");
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
  app.add_flag("--as-is", logs.files.is_as_is,
               "go on even if the logs are certainly not what they say (see leeway info)");
}

void add_start_options(CLI::App& app, FuseLogs& logs) {
  CLI::Option* heading =
      app.add_option("--start-heading-deg", logs.start_heading_deg,
                     "heading of the vehicle at the start of the IMU log, clockwise from true "
                     "north, deg, where it is known: no motion is needed to find it")
          ->type_name("DEG")
          ->check(in_range(-360.0, 360.0))
          ->excludes(app.get_option("--drive"));
  add_default_option(app, "--start-heading-sigma-deg", logs.start_heading_sigma_deg,
                     "standard deviation of --start-heading-deg, deg")
      ->check(in_range(1e-3, 180.0))
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

}  // namespace

void add_log_options(CLI::App& app, FuseOptions& options) {
  add_file_options(app, options.logs);
  add_log_form_options(app, options.logs.form);
  add_start_options(app, options.logs);
  add_filter_options(app, options);
  add_vehicle_options(app, options.vehicle);
  add_timing_options(app, options.timing);
}

}  // namespace leeway::cli
