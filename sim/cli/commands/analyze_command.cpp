#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/commands/analysis_files.hpp"
#include "sim/cli/output.hpp"
#include "sim/cli/pages/report.hpp"
#include "sim/cli/pages/report_table.hpp"
#include "sim/cli/scene_options.hpp"

namespace leeway::cli {
namespace {

struct AnalyzeOptions {
  SceneChoice scene{};
  std::filesystem::path moments{};
  std::filesystem::path budget{};
  std::filesystem::path report{};
  bool json{false};
};

std::string optimism(double ratio) {
  if (std::abs(ratio - 1.0) < 5e-3) return "as honest as it can be";
  return ratio > 1.0 ? fmt::format("optimistic by x{:.2f}", ratio)
                     : fmt::format("pessimistic by x{:.2f}", 1.0 / ratio);
}

void print_sigmas(const sim::CovariancePoint& worst) {
  const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(worst.r_e_m)).transpose();
  Table table({"<1 sigma", "north", "east", "down"});
  const auto add = [&](const char* what, const ErrorMatrix& P, int block, double unit) {
    const Eigen::Matrix3d P_n = C_ne * P.block<3, 3>(block, block) * C_ne.transpose();
    std::vector<std::string> cells{what};
    for (int i = 0; i < 3; ++i) cells.push_back(number(std::sqrt(P_n(i, i)) / unit, 4));
    table.add(std::move(cells));
  };
  add("position claimed, m", worst.claimed, kDr, 1.0);
  add("position true, m", worst.truth, kDr, 1.0);
  add("velocity claimed, m/s", worst.claimed, kDv, 1.0);
  add("velocity true, m/s", worst.truth, kDv, 1.0);
  add("attitude claimed, deg", worst.claimed, kPsi, kRadPerDeg);
  add("attitude true, deg", worst.truth, kPsi, kRadPerDeg);
  table.print();
}

void print_sources(sim::ErrorBudget budget) {
  std::sort(budget.begin(), budget.end(), [](const auto& a, const auto& b) {
    return horizontal_m2(a.mean_sq_n_m2) > horizontal_m2(b.mean_sq_n_m2);
  });
  const Eigen::Matrix3d sum = total(budget);
  Table table({"<source", "north, m", "east, m", "down, m", "horizontal, m", "share, %"});
  const auto add = [&](std::string_view source, const Eigen::Matrix3d& P_n) {
    const double m2 = horizontal_m2(P_n);
    std::vector<std::string> cells{std::string(source)};
    for (int i = 0; i < 3; ++i) cells.push_back(number(std::sqrt(std::max(P_n(i, i), 0.0)), 3));
    cells.push_back(number(std::sqrt(m2), 3));
    cells.push_back(number(100.0 * m2 / horizontal_m2(sum), 2));
    table.add(std::move(cells));
  };
  for (const sim::BudgetLine& line : budget) add(name(line.source), line.mean_sq_n_m2);
  add("total", sum);
  table.print();
}

void print_report(const sim::Scene& scene, const sim::CovarianceAnalysis& r) {
  fmt::print("Scene '{}' ({}), {}, fixes every {:g} s, {:g} s\n", scene.name, scene.trajectory.name,
             scene.imu_name, scene.gnss.interval_s, scene.duration_s);
  fmt::print("Largest horizontal error ({}) before a fix in the last {:g} s: {:.3f} m at {:g} s\n",
             name(scene.budget.metric), r.window_s, r.true_m, r.worst_s);
  fmt::print("The filter claims {:.3f} m: {}.\n", r.claimed_m, optimism(r.true_m / r.claimed_m));
  if (r.settled) {
    fmt::print("Settled since {:g} s: every sigma repeats to 0.1 %.\n\n", r.settled_s);
  } else {
    fmt::print("Not settled by the scene's end, {:g} s.\n\n", r.settled_s);
  }
  print_sigmas(r.worst);
  fmt::print("\nWhere the true error comes from\n");
  print_sources(r.budget);
}

Json results_json(const sim::CovarianceAnalysis& r) {
  Json budget = Json::array();
  const double sum_m2 = horizontal_m2(total(r.budget));
  for (const sim::BudgetLine& line : r.budget) {
    budget.push_back({{"source", name(line.source)},
                      {"north_m2", line.mean_sq_n_m2(0, 0)},
                      {"east_m2", line.mean_sq_n_m2(1, 1)},
                      {"down_m2", line.mean_sq_n_m2(2, 2)},
                      {"horizontal_share", horizontal_m2(line.mean_sq_n_m2) / sum_m2}});
  }
  return {{"true_m", r.true_m},
          {"claimed_m", r.claimed_m},
          {"optimistic_by", r.true_m / r.claimed_m},
          {"true_drms_m", r.true_drms_m},
          {"claimed_drms_m", r.claimed_drms_m},
          {"worst_s", r.worst_s},
          {"window_s", r.window_s},
          {"fixes", r.fixes},
          {"settled", r.settled},
          {"settled_s", r.settled ? Json(r.settled_s) : Json()},
          {"budget", std::move(budget)}};
}

/// Horizontal (root of the sum of both variances) and down.
void add_moment(ReportTable& table, const sim::CovariancePoint& point) {
  const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(point.r_e_m)).transpose();
  const auto variances = [&C_ne](const ErrorMatrix& P) -> Eigen::Vector3d {
    return (C_ne * P.block<3, 3>(kDr, kDr) * C_ne.transpose()).diagonal();
  };
  const Eigen::Vector3d claimed_m2 = variances(point.claimed);
  const Eigen::Vector3d true_m2 = variances(point.truth);
  const auto horizontal_m = [](const Eigen::Vector3d& m2) { return std::sqrt(m2.x() + m2.y()); };
  table.add({point.t_s, horizontal_m(claimed_m2), horizontal_m(true_m2), std::sqrt(claimed_m2.z()),
             std::sqrt(true_m2.z())});
}

int run(const AnalyzeOptions& options) {
  const sim::Scene scene = scene_of(options.scene);
  std::optional<MomentWriter> moments;
  if (!options.moments.empty()) writing([&] { moments.emplace(options.moments); });
  Progress progress("analyze");
  sim::CovarianceConfig config;
  config.by_source = true;
  ReportTable shown({"t_s", "claimed_h_m", "true_h_m", "claimed_d_m", "true_d_m"});
  const bool reported = !options.report.empty();
  if (moments || reported || progress.visible()) {
    config.observer = [&](const sim::CovariancePoint& point) {
      if (moments) writing([&] { moments->write(point); });
      if (reported) add_moment(shown, point);
      progress.show(point.t_s / scene.duration_s);
    };
  }
  const sim::CovarianceAnalysis result = sim::analyze(scene, sim::error_track(scene), config);
  if (moments) writing([&] { moments->close(); });
  if (!options.budget.empty()) write_file(options.budget, budget_csv(result.budget));
  const Json answer = answer_json("analyze", scene_json(scene), results_json(result));
  if (options.json) {
    print_json(answer);
  } else {
    print_report(scene, result);
  }
  write_report(options.report, answer, {{"moments", shown.json()}});
  return kSuccess;
}

}  // namespace

void add_analyze_command(CLI::App& program, int& exit_code) {
  CLI::App* app = program.add_subcommand(
      "analyze", "What the filter claims in a scene, what is true, and where the error comes from");
  const auto options = std::make_shared<AnalyzeOptions>();
  add_scene_options(*app, options->scene);
  app->add_option("--out", options->moments,
                  "write claimed and true sigmas at every moment of the scene as CSV")
      ->type_name("FILE");
  app->add_option("--budget", options->budget, "write the error budget as CSV")->type_name("FILE");
  add_report_option(*app, options->report);
  app->add_flag("--json", options->json, "one JSON object on standard output instead of tables");
  app->footer(
      "Example:\n"
      "  leeway analyze --scene docs/examples/scenes/town-car.toml --interval-s 5 --budget "
      "budget.csv");
  app->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace leeway::cli
