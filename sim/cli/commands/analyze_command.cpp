#include <cmath>

#include "leeway/logs/csv_writer.hpp"
#include "leeway/sim/analysis/coast.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/files/output_files.hpp"
#include "sim/cli/pages/series_table.hpp"
#include "sim/cli/scene_options.hpp"
#include "sim/cli/tables/coast_tables.hpp"

namespace leeway::cli {
namespace {

struct AnalyzeChoice {
  SceneChoice scene{};
  std::filesystem::path moments{};
  std::filesystem::path error_budget{};
  Output output{};
};

/// Of a 3 x 3 block of an error's covariance, in north, east, down.
Eigen::Vector3d sigma_n(const sim::CovariancePoint& point, const ErrorMatrix& P, int block) {
  const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(point.r_e_m)).transpose();
  return (C_ne * P.block<3, 3>(block, block) * C_ne.transpose())
      .diagonal()
      .cwiseMax(0.0)
      .cwiseSqrt();
}

std::vector<CsvColumn> moment_columns() {
  constexpr int kExact = CsvColumn::kSingle;
  std::vector<CsvColumn> columns{{"t_s"}, {"moment", 0}};
  using Axes = std::array<std::string, 3>;
  for (const Axes& axes : {Axes{"n_m", "e_m", "d_m"}, Axes{"vn_mps", "ve_mps", "vd_mps"},
                           Axes{"tilt_n_rad", "tilt_e_rad", "heading_rad"}}) {
    for (const std::string whose : {"claimed_", "true_"}) {
      for (const std::string& axis : axes) columns.emplace_back((whose + axis).c_str(), kExact);
    }
  }
  columns.emplace_back("optimistic_by", kExact);
  return columns;
}

/// Claimed and true sigmas. The column moment: 0 on the way, 1 before a fix is used, 2 after.
void write_moment(CsvWriter& csv, const sim::CovariancePoint& point) {
  std::vector<double> row{static_cast<double>(point.moment)};
  for (const int block : {kDr, kDv, kPsi}) {
    for (const ErrorMatrix* P : {&point.claimed, &point.truth}) {
      const Eigen::Vector3d sigma = sigma_n(point, *P, block);
      row.insert(row.end(), sigma.begin(), sigma.end());
    }
  }
  row.push_back(std::hypot(row[4], row[5]) / std::hypot(row[1], row[2]));
  csv.write(time_from_seconds(point.t_s), row);
}

/// What a source adds to the mean square of the true error.
struct Source {
  std::string name{};
  Eigen::Vector3d mean_sq_n_m2{Eigen::Vector3d::Zero()};

  double horizontal_m2() const { return mean_sq_n_m2.x() + mean_sq_n_m2.y(); }
  Eigen::Vector3d sigma_n_m() const { return mean_sq_n_m2.cwiseMax(0.0).cwiseSqrt(); }
};

/// Every source, and as the last the total.
std::vector<Source> sources_of(const sim::ErrorBudget& error_budget) {
  std::vector<Source> sources;
  Source total{"total"};
  for (const sim::ErrorBudgetLine& line : error_budget) {
    sources.push_back({std::string(name(line.source)), line.mean_sq_n_m2.diagonal()});
    total.mean_sq_n_m2 += sources.back().mean_sq_n_m2;
  }
  sources.push_back(total);
  return sources;
}

std::string error_budget_csv(const std::vector<Source>& sources) {
  std::string csv = "source,north_m,east_m,down_m,horizontal_m2,horizontal_share\n";
  for (const Source& source : sources) {
    const Eigen::Vector3d sigma_m = source.sigma_n_m();
    csv += fmt::format("{},{},{},{},{},{}\n", source.name, sigma_m.x(), sigma_m.y(), sigma_m.z(),
                       source.horizontal_m2(),
                       source.horizontal_m2() / sources.back().horizontal_m2());
  }
  return csv;
}

std::string optimism(double ratio) {
  if (std::abs(ratio - 1.0) < 5e-3) return "as honest as it can be";
  return ratio > 1.0 ? fmt::format("optimistic by x{:.2f}", ratio)
                     : fmt::format("pessimistic by x{:.2f}", 1.0 / ratio);
}

void print_sigmas(const sim::CovariancePoint& worst) {
  Table table({"<1 sigma", "north", "east", "down"});
  const auto add = [&](const char* what, const ErrorMatrix& P, int block, double unit) {
    const Eigen::Vector3d sigma = sigma_n(worst, P, block) / unit;
    table.add({what, number(sigma.x(), 4), number(sigma.y(), 4), number(sigma.z(), 4)});
  };
  add("position claimed, m", worst.claimed, kDr, 1.0);
  add("position true, m", worst.truth, kDr, 1.0);
  add("velocity claimed, m/s", worst.claimed, kDv, 1.0);
  add("velocity true, m/s", worst.truth, kDv, 1.0);
  add("attitude claimed, deg", worst.claimed, kPsi, kRadPerDeg);
  add("attitude true, deg", worst.truth, kPsi, kRadPerDeg);
  table.print();
}

/// The greatest first.
void print_sources(std::vector<Source> sources) {
  std::sort(sources.begin(), sources.end() - 1,
            [](const Source& a, const Source& b) { return a.horizontal_m2() > b.horizontal_m2(); });
  Table table({"<source", "north, m", "east, m", "down, m", "horizontal, m", "share, %"});
  for (const Source& source : sources) {
    const Eigen::Vector3d sigma_m = source.sigma_n_m();
    const double m2 = source.horizontal_m2();
    table.add({source.name, number(sigma_m.x(), 3), number(sigma_m.y(), 3), number(sigma_m.z(), 3),
               number(std::sqrt(m2), 3), number(100.0 * m2 / sources.back().horizontal_m2(), 2)});
  }
  table.print();
}

/// Whether the scene's limit is kept: before every fix that counts, and at the end of each outage.
void print_limit(const sim::Scene& scene, const sim::CovarianceAnalysis& r,
                 const std::vector<sim::Coast>& coasts) {
  const std::string limit = words_of(scene.limit.allowed());
  fmt::print("{}", preset_line(scene.limit));
  fmt::print("Keeps {} there, {:.6g} m: {}.\n", limit, r.allowed_m,
             r.true_m <= r.allowed_m ? "yes" : "no");
  for (const sim::Coast& c : coasts) {
    fmt::print("Outage of {:g} s at {:g} s: {:.3g} m at its end, {:.1f} s; keeps {}: {}\n",
               c.outage.duration_s, c.outage.start_s, c.end_error_m, c.end_s, limit,
               c.keeps_limit() ? "yes" : fmt::format("no, for {:.1f} s only", c.coast_s));
  }
}

/// Down, without a fix, an error grows by gravity's gradient: e-fold in sqrt(R / 2 g), 570 s.
/// Source: Groves (2013) section 5.7.2.
void print_vertical_channel(const sim::Scene& scene) {
  constexpr double kEfoldS = 570.0;
  const bool has_barometer = scene.vehicle && scene.vehicle->barometer;
  if (scene.gnss.interval_s < kEfoldS || has_barometer) return;
  fmt::print(
      "Fixes are further apart than the {:g} s in which an error of height grows e-fold by "
      "itself:\n"
      "the height, and all that hangs on it, is of no use before a fix. A barometer holds it.\n",
      kEfoldS);
}

void print_tables(const sim::Scene& scene, const sim::CovarianceAnalysis& r,
                  const std::vector<sim::Coast>& coasts) {
  fmt::print("Scene '{}' ({}), {}, fixes every {:g} s, {:g} s\n", scene.name, scene.trajectory.name,
             scene.imu_name, scene.gnss.interval_s, scene.duration_s);
  fmt::print("Largest {} before a fix in the last {:g} s: {:.3f} m at {:g} s\n",
             words_of(scene.limit.metric), r.window_s, r.true_m, r.worst_s);
  fmt::print("The filter claims {:.3f} m: {}.\n", r.claimed_m, optimism(r.true_m / r.claimed_m));
  print_limit(scene, r, coasts);
  print_vertical_channel(scene);
  if (r.settled) {
    fmt::print("Settled since {:g} s: every sigma repeats to 0.1 %.\n\n", r.settled_s);
  } else {
    fmt::print("Not settled by the scene's end, {:g} s.\n\n", r.settled_s);
  }
  print_sigmas(r.worst);
  fmt::print("\nWhere the true error comes from\n");
  print_sources(sources_of(r.error_budget));
}

Json outages_json(const std::vector<sim::Coast>& coasts) {
  Json rows = Json::array();
  for (const sim::Coast& coast : coasts) rows.push_back(coast_json(coast));
  return rows;
}

Json results_json(const sim::CovarianceAnalysis& r, const std::vector<sim::Coast>& coasts) {
  std::vector<Source> sources = sources_of(r.error_budget);
  const double total_m2 = sources.back().horizontal_m2();
  sources.pop_back();
  Json error_budget = Json::array();
  for (const Source& source : sources) {
    error_budget.push_back({{"source", source.name},
                            {"north_m2", source.mean_sq_n_m2.x()},
                            {"east_m2", source.mean_sq_n_m2.y()},
                            {"down_m2", source.mean_sq_n_m2.z()},
                            {"horizontal_share", source.horizontal_m2() / total_m2}});
  }
  return {{"true_m", r.true_m},
          {"allowed_m", r.allowed_m},
          {"claimed_m", r.claimed_m},
          {"optimistic_by", r.true_m / r.claimed_m},
          {"true_drms_m", r.true_drms_m},
          {"claimed_drms_m", r.claimed_drms_m},
          {"worst_s", r.worst_s},
          {"keeps_limit", r.true_m <= r.allowed_m},
          {"outages", outages_json(coasts)},
          {"window_s", r.window_s},
          {"fixes", r.fixes},
          {"settled", r.settled},
          {"settled_s", r.settled ? Json(r.settled_s) : Json()},
          {"budget", std::move(error_budget)}};
}

/// Horizontal (root of the sum of both variances) and down.
void add_moment(SeriesTable& table, const sim::CovariancePoint& point) {
  const Eigen::Vector3d claimed_m = sigma_n(point, point.claimed, kDr);
  const Eigen::Vector3d true_m = sigma_n(point, point.truth, kDr);
  table.add({point.t_s, std::hypot(claimed_m.x(), claimed_m.y()),
             std::hypot(true_m.x(), true_m.y()), claimed_m.z(), true_m.z()});
}

int run(const AnalyzeChoice& options) {
  const sim::Scene scene = scene_of(options.scene);
  std::optional<CsvWriter> moments;
  if (!options.moments.empty())
    writing([&] { moments.emplace(options.moments, moment_columns()); });
  Progress progress("analyze");
  sim::CovarianceConfig config;
  config.by_source = true;
  SeriesTable shown({"t_s", "claimed_h_m", "true_h_m", "claimed_d_m", "true_d_m"});
  const bool reported = !options.output.report.empty();
  if (moments || reported || progress.visible()) {
    config.observer = [&](const sim::CovariancePoint& point) {
      if (moments) writing([&] { write_moment(*moments, point); });
      if (reported) add_moment(shown, point);
      progress.show(point.t_s / scene.duration_s);
    };
  }
  const sim::ErrorTrack track = sim::error_track(scene);
  const sim::CovarianceAnalysis result = sim::analyze(scene, track, config);
  const std::vector<sim::Coast> coasts = sim::coasts(scene, track, scene.limit.allowed());
  if (moments) writing([&] { moments->close(); });
  if (!options.error_budget.empty()) {
    write_file(options.error_budget, error_budget_csv(sources_of(result.error_budget)));
  }
  show(
      options.output, answer_json("analyze", scene_json(scene), results_json(result, coasts)),
      [&] { print_tables(scene, result, coasts); },
      [&] {
        return Json{{"moments", shown.json()}};
      });
  return kSuccess;
}

void add_options(CLI::App& app, AnalyzeChoice& options) {
  add_scene_options(app, options.scene);
  add_output_file(app, "--out", options.moments,
                  "write claimed and true sigmas at every moment of the scene as CSV");
  add_output_file(app, "--error-budget", options.error_budget, "write the error budget as CSV");
  add_output_options(app, options.output);
}

const Command<AnalyzeChoice> kAnalyze{
    "analyze", "What the filter claims in a scene, what is true, and where the error comes from",
    "Example:\n"
    "  leeway analyze --scene docs/examples/scenes/town-car.toml --interval-s 5 --error-budget "
    "budget.csv",
    add_options, run};

}  // namespace
}  // namespace leeway::cli
