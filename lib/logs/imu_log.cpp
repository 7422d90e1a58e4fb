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

/// Rows as increments in body axes.
class ImuSource final : public RecordSource<ImuIncrement> {
 public:
  ImuSource(LogSource<ImuRow> rows, const ImuLogOptions& options)
      : rows_(std::move(rows)),
        options_(options),
        rotates_(options.C_bs != Eigen::Matrix3d::Identity()) {}

  std::optional<ImuIncrement> next() override {
    std::optional<ImuRow> row = rows_.next();
    const bool needs_previous = row && !(row->dt_s > 0.0);
    if (needs_previous && !previous_) {
      --rows_.summary().records;  // it only starts the clock
      previous_ = std::exchange(row, rows_.next());
    }
    if (!row) return std::nullopt;
    ImuIncrement inc = increment(*row);
    if (needs_previous) previous_ = row;
    if (rotates_) {
      inc.dtheta_b_rad = options_.C_bs * inc.dtheta_b_rad;
      inc.dv_b_mps = options_.C_bs * inc.dv_b_mps;
    }
    return inc;
  }

  const LogSummary& summary() const override { return std::as_const(rows_).summary(); }
  std::string_view layout() const override { return rows_.layout(); }

 private:
  ImuIncrement increment(const ImuRow& row) const {
    if (row.is_rate) {
      return increment_between({previous_->time, previous_->angular, previous_->linear},
                               {row.time, row.angular, row.linear}, options_.meaning);
    }
    const double dt_s = row.dt_s > 0.0 ? row.dt_s : to_seconds(row.time - previous_->time);
    return {row.time, dt_s, row.angular, row.linear};
  }

  LogSource<ImuRow> rows_;
  ImuLogOptions options_;
  bool rotates_;
  std::optional<ImuRow> previous_{};
};

std::unique_ptr<RecordSource<ImuIncrement>> imu_source(LineReader lines,
                                                       const ImuLogOptions& options) {
  if (!is_proper_rotation(options.C_bs)) {
    throw Error("ImuLogOptions::C_bs: must be a proper rotation (orthonormal, determinant +1)");
  }
  const LogHead head = read_head(lines);
  const ImuLayout& layout = layout_of(head, imu_layouts());
  RowParser<ImuRow> parser = layout.parser(head, lines);
  return std::make_unique<ImuSource>(
      LogSource<ImuRow>(std::move(lines), std::move(parser), layout.name), options);
}

}  // namespace

const std::vector<ImuLayout>& imu_layouts() {
  static const std::vector kLayouts{imu_csv_rates(), imu_csv_increments(), imu_kf_gins()};
  return kLayouts;
}

ImuLogReader::ImuLogReader(const std::filesystem::path& path, const ImuLogOptions& options)
    : LogReader(imu_source(LineReader(path), options)) {}

ImuLogWriter::ImuLogWriter(const std::filesystem::path& path)
    : csv_(path, {"t_s", "dt_s", "dtheta_x_rad", "dtheta_y_rad", "dtheta_z_rad", "dv_x_mps",
                  "dv_y_mps", "dv_z_mps"}) {}

void ImuLogWriter::write(const ImuIncrement& inc) {
  const Eigen::Vector3d& a = inc.dtheta_b_rad;
  const Eigen::Vector3d& v = inc.dv_b_mps;
  csv_.write(inc.time, std::array{inc.dt_s, a.x(), a.y(), a.z(), v.x(), v.y(), v.z()});
}

}  // namespace leeway
