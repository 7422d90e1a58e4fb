#include "sim/cli/commands/analysis_files.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace leeway::cli {
namespace {

constexpr int kExact = CsvColumn::kSingle;

}  // namespace

MomentWriter::MomentWriter(const std::filesystem::path& path)
    : csv_(path, {{"t_s"},
                  {"moment", 0},
                  {"claimed_n_m", kExact},
                  {"claimed_e_m", kExact},
                  {"claimed_d_m", kExact},
                  {"true_n_m", kExact},
                  {"true_e_m", kExact},
                  {"true_d_m", kExact},
                  {"claimed_vn_mps", kExact},
                  {"claimed_ve_mps", kExact},
                  {"claimed_vd_mps", kExact},
                  {"true_vn_mps", kExact},
                  {"true_ve_mps", kExact},
                  {"true_vd_mps", kExact},
                  {"claimed_tilt_n_rad", kExact},
                  {"claimed_tilt_e_rad", kExact},
                  {"claimed_heading_rad", kExact},
                  {"true_tilt_n_rad", kExact},
                  {"true_tilt_e_rad", kExact},
                  {"true_heading_rad", kExact},
                  {"optimistic_by", kExact}}) {}

void MomentWriter::write(const sim::CovariancePoint& point) {
  const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(point.r_e_m)).transpose();
  std::array<double, 20> row{};
  std::size_t at = 0;
  row[at++] = static_cast<double>(point.moment);
  for (const int block : {kDr, kDv, kPsi}) {
    for (const ErrorMatrix* P : {&point.claimed, &point.truth}) {
      const Eigen::Matrix3d P_n = C_ne * P->block<3, 3>(block, block) * C_ne.transpose();
      for (int i = 0; i < 3; ++i) row[at++] = std::sqrt(std::max(P_n(i, i), 0.0));
    }
  }
  row[at] = std::hypot(row[4], row[5]) / std::hypot(row[1], row[2]);
  csv_.write(time_from_seconds(point.t_s), row);
}

std::string budget_csv(const sim::ErrorBudget& budget) {
  const Eigen::Matrix3d sum = total(budget);
  std::string csv = "source,north_m,east_m,down_m,horizontal_m2,horizontal_share\n";
  const auto add = [&](std::string_view source, const Eigen::Matrix3d& P_n) {
    const Eigen::Vector3d sigma_m = P_n.diagonal().cwiseMax(0.0).cwiseSqrt();
    csv += fmt::format("{},{},{},{},{},{}\n", source, sigma_m.x(), sigma_m.y(), sigma_m.z(),
                       horizontal_m2(P_n), horizontal_m2(P_n) / horizontal_m2(sum));
  };
  for (const sim::BudgetLine& line : budget) add(name(line.source), line.mean_sq_n_m2);
  add("total", sum);
  return csv;
}

double horizontal_m2(const Eigen::Matrix3d& mean_sq_n_m2) {
  return mean_sq_n_m2.topLeftCorner<2, 2>().trace();
}

Eigen::Matrix3d total(const sim::ErrorBudget& budget) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const sim::BudgetLine& line : budget) sum += line.mean_sq_n_m2;
  return sum;
}

}  // namespace leeway::cli
