#include "sim/cli/tables/fuse_tables.hpp"
#include "sim/cli/tables/look_tables.hpp"

namespace leeway::cli {
namespace {

Json path_json(const std::filesystem::path& path) {
  return path.empty() ? Json() : Json(path.string());
}

Json log_json(const FuseLog& log) {
  Json damaged = Json::object();
  for (const LineDamage damage : kAll<LineDamage>) {
    const auto count = log.summary.damaged[static_cast<std::size_t>(damage)];
    if (count > 0) damaged[std::string(name(damage))] = count;
  }
  const std::string& incomplete = log.summary.incomplete;
  return {{"path", log.path.string()},
          {"format", log.format},
          {"lines", log.summary.lines},
          {"records", log.summary.records},
          {"carried_over", log.summary.carried_over},
          {"damaged_lines", log.summary.damaged_lines()},
          {"damaged", damaged},
          {"notes", log.summary.notes},
          {"messages", log.summary.messages},
          {"incomplete", incomplete.empty() ? Json() : Json(incomplete)}};
}

Json logs_json(const FuseJob& job) {
  Json logs;
  for (const FuseLog& log : logs_of(job)) logs[log.key] = log_json(log);
  return logs;
}

Json health_json(const sim::ReplayResult& r) {
  const Health& h = r.health;
  return {{"state", name(h.state)},
          {"position_nis_ratio", h.position_nis_ratio},
          {"velocity_nis_ratio", h.velocity_nis_ratio},
          {"position_sigma_scale", h.position_sigma_scale},
          {"velocity_sigma_scale", h.velocity_sigma_scale},
          {"imu_sigma_scale", h.imu_sigma_scale},
          {"clock_offset_s", h.clock_offset_s},
          {"clock_offset_sigma_s", h.clock_offset_sigma_s},
          {"clock_offset_detected", h.clock_offset_detected},
          {"clock_offset_of_velocity", h.clock_offset_of_velocity},
          {"repairs", h.repairs},
          {"resets", h.resets},
          {"realignments", h.realignments},
          {"mount_rpy_deg", json_of(r.mount_rpy_deg)}};
}

Json solution_json(const FuseJob& job) {
  const sim::ReplayResult& r = job.result;
  if (!r.has_solution) return nullptr;
  return {{"path", path_json(job.input.solution)},
          {"first_s", r.first_solution_s},
          {"last_s", r.last_solution_s},
          {"final_roll_deg", r.final_roll_deg},
          {"health", health_json(r)}};
}

Json verdicts_json(const std::array<std::uint64_t, kVerdicts>& counts) {
  Json verdicts = Json::object();
  for (const Verdict verdict : kAll<Verdict>) {
    verdicts[std::string(name(verdict))] = counts[static_cast<std::size_t>(verdict)];
  }
  return verdicts;
}

Json rms_json(const sim::RmsErrors& rms) {
  return {{"epochs", rms.epochs},
          {"horizontal_m", rms.horizontal_m},
          {"vertical_m", rms.vertical_m},
          {"velocity_mps", rms.velocity_mps},
          {"attitude_deg", rms.attitude_deg}};
}

Json outages_json(const std::vector<FuseJob>& jobs) {
  Json outages = Json::array();
  for (const FuseJob& job : jobs) {
    for (const sim::OutageResult& outage : job.result.outages) {
      outages.push_back(row_json(outage_row(job, outage)));
      if (!job.drive.empty()) outages.back()["drive"] = job.drive;
    }
  }
  return outages;
}

Json summary_json(const std::vector<sim::OutageResult>& outages) {
  Json summary = Json::array();
  for (const sim::OutageSummary& s : sim::summarize(outages)) {
    summary.push_back(row_json(outage_row(s)));
  }
  return summary;
}

Json drives_json(const std::vector<FuseJob>& jobs) {
  Json drives = Json::array();
  for (const FuseJob& job : jobs) {
    const FuseTotals totals = totals_of({job});
    Json drive{{"drive", job.drive},
               {"mount_rpy_deg", json_of(job.mount_rpy_deg)},
               {"findings", findings_json(job.result.look.findings)},
               {"refused", job.result.is_refused},
               {"solution", solution_json(job)},
               {"verdicts", verdicts_json(job.result.verdicts)},
               {"nis_mean", totals.nis_mean},
               {"nis_dof_mean", totals.nis_dof_mean}};
    if (!job.input.truth.empty()) drive["rms"] = rms_json(job.result.rms);
    drive["logs"] = logs_json(job);
    drives.push_back(std::move(drive));
  }
  return drives;
}

Json input_json(const FuseOptions& o, const std::string& imu_name) {
  Json input;
  if (o.logs.drives.empty()) {
    const sim::ReplayInput& files = o.logs.files;
    input = {{"imu", path_json(files.imu)}, {"gnss", path_json(files.gnss)}};
    for (std::size_t a = 0; a < kAidings.size(); ++a) {
      input[kAidings[a].name] = path_json(files.aidings[a]);
    }
    input.update(
        {{"truth", path_json(files.truth)},
         {"outages", path_json(o.logs.outages)},
         {"mount_rpy_deg", json_of(o.logs.mount_rpy_deg)},
         {"start_heading_deg", o.logs.start_heading_deg ? Json(*o.logs.start_heading_deg) : Json()},
         {"start_heading_sigma_deg", o.logs.start_heading_sigma_deg}});
  } else {
    for (const auto& folder : o.logs.drives) input["drives"].push_back(folder.string());
  }
  const Eigen::Vector2d scale = o.logs.gnss_sigma_scale.value_or(Eigen::Vector2d::Ones());
  input.update({{"vehicle", name(o.vehicle.kind)},
                {"without", o.vehicle.without},
                {"estimate_mount", o.vehicle.estimate_mount},
                {"position_lag_s", o.timing.position_lag_s},
                {"velocity_lag_s", o.timing.velocity_lag_s},
                {"estimate_clock", o.timing.estimate_clock},
                {"mount_axes", o.logs.mount_axes},
                {"lever_arm_m", json_of(o.lever_arm_b_m.value_or(Eigen::Vector3d::Zero()))},
                {"imu_model", imu_name},
                {"rate_meaning", name(o.logs.files.imu_options.meaning)},
                {"scheme", name(o.filter.strapdown.scheme)},
                {"gnss_correlation_s", o.filter.gnss_correlation_s},
                {"gnss_position_sigma_scale", scale.x()},
                {"gnss_velocity_sigma_scale", scale.y()},
                {"gate_probability", o.filter.gate_probability},
                {"covariance_interval_s", o.filter.covariance_interval_s}});
  return input;
}

}  // namespace

Json fuse_json(const FuseOptions& options, const std::string& imu_name,
               const std::vector<FuseJob>& jobs) {
  const FuseTotals totals = totals_of(jobs);
  Json results{{"outages", outages_json(jobs)},
               {"outage_summary", summary_json(totals.outages)},
               {"verdicts", verdicts_json(totals.verdicts)},
               {"nis_mean", totals.nis_mean},
               {"nis_dof_mean", totals.nis_dof_mean}};
  const auto has_truth = [](const FuseJob& job) { return !job.input.truth.empty(); };
  if (std::ranges::any_of(jobs, has_truth)) results["rms"] = rms_json(totals.rms);
  if (options.logs.drives.empty()) {
    results["findings"] = findings_json(jobs.front().result.look.findings);
    results["refused"] = jobs.front().result.is_refused;
    results["solution"] = solution_json(jobs.front());
    results["logs"] = logs_json(jobs.front());
  } else {
    results["drives"] = drives_json(jobs);
  }
  return answer_json("fuse", input_json(options, imu_name), std::move(results));
}

}  // namespace leeway::cli
