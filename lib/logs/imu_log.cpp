#include "leeway/logs/imu_log.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "leeway/earth/error.hpp"
#include "lib/logs/layouts/imu_layouts.hpp"
#include "lib/logs/layouts/phone_folder.hpp"

namespace leeway {
namespace {

constexpr double kRotationTolerance = 1e-6;

bool is_proper_rotation(const Eigen::Matrix3d& C) {
  return (C * C.transpose()).isIdentity(kRotationTolerance) && C.determinant() > 0.0;
}

/// The body axis that a letter names.
Eigen::Vector3d axis_named(char letter) {
  constexpr std::string_view kPositive = "frd", kNegative = "blu";
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < kPositive.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    if (letter == kPositive[k]) axis[at] = 1.0;
    if (letter == kNegative[k]) axis[at] = -1.0;
  }
  return axis;
}

/// Log axes to sensor axes forward, right, down.
Eigen::Matrix3d axes_rotation(const std::string& axes) {
  if (axes.empty() || axes == "ned") return Eigen::Matrix3d::Identity();
  const std::string letters = axes == "enu" ? "rfu" : axes;
  Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < 3 && letters.size() == 3; ++k) {
    C.col(static_cast<Eigen::Index>(k)) = axis_named(letters[k]);
  }
  if (is_proper_rotation(C)) return C;
  throw Error("axes '" + axes +
              "': wanted three letters for x, y, z, of forward, back, right, left, up, down, of a "
              "right-handed frame, as frd, flu, rfu");
}

/// Rows as increments in body axes.
template <class Rows>
class ImuSource final : public RecordSource<ImuIncrement> {
 public:
  ImuSource(Rows rows, const ImuLogOptions& options)
      : rows_(std::move(rows)),
        options_(with_axes(options)),
        rotates_(options_.C_bs != Eigen::Matrix3d::Identity()) {}

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
  static ImuLogOptions with_axes(ImuLogOptions options) {
    options.C_bs *= axes_rotation(options.format.axes);
    return options;
  }

  ImuIncrement increment(const ImuRow& row) const {
    if (row.is_rate) {
      return increment_between({previous_->time, previous_->angular, previous_->linear},
                               {row.time, row.angular, row.linear},
                               row.is_mean ? RateMeaning::kMean : options_.meaning);
    }
    const double dt_s = row.dt_s > 0.0 ? row.dt_s : to_seconds(row.time - previous_->time);
    return {row.time, dt_s, row.angular, row.linear};
  }

  Rows rows_;
  ImuLogOptions options_;
  bool rotates_;
  std::optional<ImuRow> previous_{};
};

void validate_rotation(const ImuLogOptions& options) {
  if (is_proper_rotation(options.C_bs)) return;
  throw Error("ImuLogOptions::C_bs: must be a proper rotation (orthonormal, determinant +1)");
}

std::unique_ptr<RecordSource<ImuIncrement>> phone_source(const std::filesystem::path& folder,
                                                         const ImuLogOptions& options) {
  validate_rotation(options);
  return std::make_unique<ImuSource<PhoneRows>>(PhoneRows(folder, options.format), options);
}

std::unique_ptr<RecordSource<ImuIncrement>> imu_source(LineReader lines,
                                                       const ImuLogOptions& options) {
  validate_rotation(options);
  std::vector<std::string> notes;
  LogOpening log{read_head(lines), lines, options.format, notes, {}};
  const ImuLayout& layout = layout_of(log, imu_layouts());
  RowParser<ImuRow> parser = layout.parser(log);
  using Lines = LogSource<ImuRow>;
  using Messages = LogSource<ImuRow, MessageReader>;
  if (log.framing) {
    MessageReader messages(std::move(lines).take_bytes(), std::move(log.framing));
    return std::make_unique<ImuSource<Messages>>(
        Messages(std::move(messages), std::move(parser), layout.name, std::move(notes)), options);
  }
  return std::make_unique<ImuSource<Lines>>(
      Lines(std::move(lines), std::move(parser), layout.name, std::move(notes)), options);
}

}  // namespace

const std::vector<ImuLayout>& imu_layouts() {
  static const std::vector kLayouts{imu_csv_rates(), imu_csv_increments(), imu_kf_gins(), imu_ubx(),
                                    imu_ulog()};
  return kLayouts;
}

ImuLogReader::ImuLogReader(const std::filesystem::path& path, const ImuLogOptions& options)
    : LogReader(is_phone_folder(path) ? phone_source(path, options)
                                                    : imu_source(LineReader(path), options)) {}

ImuLogWriter::ImuLogWriter(const std::filesystem::path& path)
    : csv_(path, {"t_s", "dt_s", "dtheta_x_rad", "dtheta_y_rad", "dtheta_z_rad", "dv_x_mps",
                  "dv_y_mps", "dv_z_mps"}) {}

void ImuLogWriter::write(const ImuIncrement& inc) {
  const Eigen::Vector3d& a = inc.dtheta_b_rad;
  const Eigen::Vector3d& v = inc.dv_b_mps;
  csv_.write(inc.time, std::array{inc.dt_s, a.x(), a.y(), a.z(), v.x(), v.y(), v.z()});
}

}  // namespace leeway
