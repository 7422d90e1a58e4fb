#include "sim/cli/tables/look_tables.hpp"

#include <cmath>

namespace leeway::cli {
namespace {

std::string time_text(const sim::TimeFigures& time) {
  return fmt::format("{} records, {:.3f} to {:.3f} s, every {:.4g} s, jitter {:.2g} s",
                     time.records, time.first_s, time.last_s, time.step_s, time.jitter_s);
}

std::string breaks_text(const sim::TimeFigures& time) {
  return fmt::format("{} gaps, the longest {:.3g} s; {} steps shorter than half; {} session{}",
                     time.gaps, time.longest_gap_s, time.bursts, time.sessions,
                     time.sessions == 1 ? "" : "s");
}

std::string axis_text(const Eigen::Vector3d& axis) {
  if (!axis.allFinite()) return "not to be seen";
  return fmt::format("{:.2f}, {:.2f}, {:.2f}", axis.x(), axis.y(), axis.z());
}

/// "1.23 m", or "-".
std::string figure(double value, const char* unit) {
  return std::isfinite(value) ? fmt::format("{:.3g} {}", value, unit) : "-";
}

std::string with_sigma(double value, double sigma, const char* unit) {
  if (!std::isfinite(value)) return "-";
  return fmt::format("{:.3g} {} (sigma {:.2g})", value, unit, sigma);
}

void print_imu(const sim::ImuFigures& imu) {
  fmt::print("\n");
  Table table({"<IMU", "<"});
  table.add({"times", time_text(imu.time)});
  table.add({"breaks", breaks_text(imu.time)});
  table.add({"specific force", figure(imu.specific_force_mps2, "m/s^2, median over seconds")});
  table.add({"up", axis_text(imu.up_b)});
  table.add({"forward", axis_text(imu.forward_b)});
  table.print();
}

void print_gnss(const sim::FixFigures& gnss) {
  fmt::print("\n");
  Table table({"<GNSS", "<"});
  table.add({"times", time_text(gnss.time)});
  table.add({"breaks", breaks_text(gnss.time)});
  table.add({"with velocity", std::to_string(gnss.with_velocity)});
  table.add({"repeated; at 0, 0", fmt::format("{}; {}", gnss.repeated, gnss.zeros)});
  table.add({"claimed", figure(gnss.claimed_h_m, "m an axis, horizontal")});
  table.add({"scatter", fmt::format("{} from fix to fix, {} over 10 s",
                                    figure(gnss.scatter_h_m, "m"), figure(gnss.wander_h_m, "m"))});
  table.add({"velocity lag", with_sigma(gnss.velocity_lag_s, gnss.velocity_lag_sigma_s, "s")});
  table.print();
}

void print_shared(const sim::SharedFigures& shared) {
  fmt::print("\n");
  Table table({"<Together", "<"});
  table.add({"clock offset",
             with_sigma(shared.clock_offset_s, shared.clock_offset_sigma_s, "s, of GNSS times")});
  table.add({"course over gyros", with_sigma(shared.turn_ratio, shared.turn_ratio_sigma, "")});
  table.add({"antenna ahead of the axle", figure(shared.antenna_lead_m, "m, by the turns")});
  table.add({"odometer over GNSS", figure(shared.odometer_ratio, "")});
  table.print();
}

Json time_json(const sim::TimeFigures& time) {
  return {{"records", time.records},
          {"first_s", time.first_s},
          {"last_s", time.last_s},
          {"step_s", time.step_s},
          {"jitter_s", time.jitter_s},
          {"gaps", time.gaps},
          {"longest_gap_s", time.longest_gap_s},
          {"bursts", time.bursts},
          {"sessions", time.sessions}};
}

Json unit_vector_json(const Eigen::Vector3d& axis) {
  return axis.allFinite() ? json_of(axis) : Json();
}

}  // namespace

void print_findings(const std::vector<sim::Finding>& findings) {
  for (const sim::Finding& f : findings) {
    fmt::print("{:<8} {}: {}\n", name(f.certainty), f.log, f.text);
    if (!f.remedy.empty()) fmt::print("{:<8} {}\n", "", "mend it: " + f.remedy);
  }
  if (!findings.empty()) fmt::print("\n");
}

void print_figures(const sim::LogLook& look) {
  if (look.imu.time.records > 0) print_imu(look.imu);
  if (look.gnss.time.records > 0) print_gnss(look.gnss);
  if (look.imu.time.records > 0 && look.gnss.time.records > 0) print_shared(look.shared);
}

Json findings_json(const std::vector<sim::Finding>& findings) {
  Json list = Json::array();
  for (const sim::Finding& f : findings) {
    list.push_back({{"certainty", name(f.certainty)},
                    {"log", f.log},
                    {"about", f.about},
                    {"text", f.text},
                    {"remedy", f.remedy.empty() ? Json() : Json(f.remedy)}});
  }
  return list;
}

Json look_json(const sim::LogLook& look) {
  const sim::ImuFigures& imu = look.imu;
  const sim::FixFigures& gnss = look.gnss;
  const sim::SharedFigures& shared = look.shared;
  return {{"imu",
           {{"time", time_json(imu.time)},
            {"specific_force_mps2", imu.specific_force_mps2},
            {"up_b", unit_vector_json(imu.up_b)},
            {"forward_b", unit_vector_json(imu.forward_b)},
            {"stuck_channels", imu.is_stuck},
            {"saturated", imu.saturated}}},
          {"gnss",
           {{"time", time_json(gnss.time)},
            {"with_velocity", gnss.with_velocity},
            {"repeated", gnss.repeated},
            {"zeros", gnss.zeros},
            {"claimed_h_m", gnss.claimed_h_m},
            {"scatter_h_m", gnss.scatter_h_m},
            {"wander_h_m", gnss.wander_h_m},
            {"velocity_lag_s", gnss.velocity_lag_s},
            {"velocity_lag_sigma_s", gnss.velocity_lag_sigma_s}}},
          {"shared",
           {{"clock_offset_s", shared.clock_offset_s},
            {"clock_offset_sigma_s", shared.clock_offset_sigma_s},
            {"turn_correlation", shared.turn_correlation},
            {"turn_ratio", shared.turn_ratio},
            {"turn_ratio_sigma", shared.turn_ratio_sigma},
            {"antenna_lead_m", shared.antenna_lead_m},
            {"odometer_ratio", shared.odometer_ratio}}},
          {"findings", findings_json(look.findings)}};
}

}  // namespace leeway::cli
