#include "leeway/logs/imu_log.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "leeway/earth/error.hpp"
#include "lib/logs/layouts/imu_layouts.hpp"

namespace leeway {
namespace {

constexpr double kRotationTolerance = 1e-6;

bool is_proper_rotation(const Eigen::Matrix3d& C) {
  return (C * C.transpose()).isIdentity(kRotationTolerance) && C.determinant() > 0.0;
}

}  // namespace

struct ImuLogReader::Impl {
  std::string_view layout;
  ImuLogOptions options;
  bool rotates;
  LogSource<ImuRow> source;
  std::optional<ImuRow> previous{};

  ImuIncrement increment(const ImuRow& row) const {
    if (row.is_rate) {
      return increment_between({previous->time, previous->angular, previous->linear},
                               {row.time, row.angular, row.linear}, options.meaning);
    }
    const double dt_s = row.dt_s > 0.0 ? row.dt_s : to_seconds(row.time - previous->time);
    return {row.time, dt_s, row.angular, row.linear};
  }
};

ImuLogReader::ImuLogReader(const std::filesystem::path& path, const ImuLogOptions& options) {
  if (!is_proper_rotation(options.C_bs)) {
    throw Error("ImuLogOptions::C_bs: must be a proper rotation (orthonormal, determinant +1)");
  }
  LineReader lines(path);
  const LogHead head = read_head(lines);
  const ImuLayout& layout = layout_of<ImuRow>(head, kImuLayouts);
  RowParser<ImuRow> parser = layout.parser(head, lines);
  impl_ = std::make_unique<Impl>(Impl{layout.name,
                                      options,
                                      options.C_bs != Eigen::Matrix3d::Identity(),
                                      {std::move(lines), std::move(parser)}});
}

ImuLogReader::~ImuLogReader() = default;
ImuLogReader::ImuLogReader(ImuLogReader&&) noexcept = default;
ImuLogReader& ImuLogReader::operator=(ImuLogReader&&) noexcept = default;

std::optional<ImuIncrement> ImuLogReader::next() {
  Impl& log = *impl_;
  std::optional<ImuRow> row = log.source.next();
  const bool needs_previous = row && !(row->dt_s > 0.0);
  if (needs_previous && !log.previous) log.previous = std::exchange(row, log.source.next());
  if (!row) return std::nullopt;
  ImuIncrement inc = log.increment(*row);
  if (needs_previous) log.previous = row;
  if (log.rotates) {
    inc.dtheta_b_rad = log.options.C_bs * inc.dtheta_b_rad;
    inc.dv_b_mps = log.options.C_bs * inc.dv_b_mps;
  }
  ++log.source.report().records;
  return inc;
}

std::string_view ImuLogReader::layout() const { return impl_->layout; }
const LogSummary& ImuLogReader::report() const { return impl_->source.report(); }

ImuLogWriter::ImuLogWriter(const std::filesystem::path& path)
    : csv_(path, {"t_s", "dt_s", "dtheta_x_rad", "dtheta_y_rad", "dtheta_z_rad", "dv_x_mps",
                  "dv_y_mps", "dv_z_mps"}) {}

void ImuLogWriter::write(const ImuIncrement& inc) {
  const Eigen::Vector3d& a = inc.dtheta_b_rad;
  const Eigen::Vector3d& v = inc.dv_b_mps;
  csv_.write(inc.time, std::array{inc.dt_s, a.x(), a.y(), a.z(), v.x(), v.y(), v.z()});
}

}  // namespace leeway
