#include "leeway/logs/truth_log.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "leeway/earth/error.hpp"
#include "lib/logs/csv_header.hpp"
#include "lib/logs/log_columns.hpp"
#include "lib/logs/log_source.hpp"

namespace leeway {

static Time time_of(const TruthRecord& record) { return record.nav.time; }

namespace {

constexpr double kMaxAngleDeg = 720.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

constexpr Column angle(int slot) { return {slot, -kMaxAngleDeg, kMaxAngleDeg, true}; }

constexpr std::array kTruthPosition{NamedColumn{"t_s", kTimeColumn},
                                    NamedColumn{"lat_deg", {0, -90.0, 90.0}},
                                    NamedColumn{"lon_deg", {1, -360.0, 360.0}},
                                    NamedColumn{"height_m", {2, -kMaxHeightM, kMaxHeightM}}};
constexpr std::array kTruthVelocity{NamedColumn{"vn_mps", velocity_column(3)},
                                    NamedColumn{"ve_mps", velocity_column(4)},
                                    NamedColumn{"vd_mps", velocity_column(5)}};
constexpr std::array kTruthAttitude{NamedColumn{"roll_deg", angle(6)},
                                    NamedColumn{"pitch_deg", angle(7)},
                                    NamedColumn{"yaw_deg", angle(8)}};

struct TruthRowParser {
  LineParser fields{};

  std::optional<Fault> operator()(std::string_view line, TruthRecord& record) const {
    std::array<double, 9> values{};
    std::fill(values.begin() + 3, values.end(), kNan);
    record = TruthRecord{};
    NavStateNed& nav = record.nav;
    if (auto fault = fields.parse(line, nav.time, values)) return fault;
    nav.position = {values[0] * kRadPerDeg, values[1] * kRadPerDeg, values[2]};
    const Eigen::Map<const Eigen::Vector3d> v_n_mps(values.data() + 3);
    const Eigen::Map<const Eigen::Vector3d> rpy_deg(values.data() + 6);
    record.has_velocity = v_n_mps.allFinite();
    record.has_attitude = rpy_deg.allFinite();
    if (record.has_velocity) nav.v_n_mps = v_n_mps;
    if (record.has_attitude) {
      nav.attitude = {rpy_deg.x() * kRadPerDeg, rpy_deg.y() * kRadPerDeg, rpy_deg.z() * kRadPerDeg};
    }
    return std::nullopt;
  }
};

std::unique_ptr<RecordSource<TruthRecord>> truth_source(LineReader lines) {
  const std::string expected = "a CSV header with " + join(kTruthPosition) + " (and " +
                               join(kTruthVelocity) + ", " + join(kTruthAttitude) + ")";
  const LogFormat format;
  std::vector<std::string> notes;
  LogOpening log{{}, lines, format, notes};
  CsvHeader header = take_csv_header(log, kTruthPosition, expected);
  header.use_group(kTruthVelocity);
  header.use_group(kTruthAttitude);
  return std::make_unique<LogSource<TruthRecord>>(std::move(lines), TruthRowParser{header.parser()},
                                                  "CSV", std::move(notes));
}

double mix(double a, double b, double fraction) { return a + fraction * (b - a); }
double mix_angle(double a_rad, double b_rad, double fraction) {
  return a_rad + fraction * wrap_pi(b_rad - a_rad);
}

TruthRecord mix(const TruthRecord& a, const TruthRecord& b, Time t) {
  const double s = to_seconds(t - a.nav.time) / to_seconds(b.nav.time - a.nav.time);
  const EulerAngles& from = a.nav.attitude;
  const EulerAngles& to = b.nav.attitude;
  TruthRecord record;
  record.has_velocity = a.has_velocity && b.has_velocity;
  record.has_attitude = a.has_attitude && b.has_attitude;
  record.nav.time = t;
  record.nav.position = {mix(a.nav.position.lat_rad, b.nav.position.lat_rad, s),
                         mix_angle(a.nav.position.lon_rad, b.nav.position.lon_rad, s),
                         mix(a.nav.position.height_m, b.nav.position.height_m, s)};
  if (record.has_velocity) {
    record.nav.v_n_mps = a.nav.v_n_mps + s * (b.nav.v_n_mps - a.nav.v_n_mps);
  }
  if (record.has_attitude) {
    record.nav.attitude = {mix_angle(from.roll_rad, to.roll_rad, s),
                           mix_angle(from.pitch_rad, to.pitch_rad, s),
                           mix_angle(from.yaw_rad, to.yaw_rad, s)};
  }
  return record;
}

}  // namespace

TruthLogReader::TruthLogReader(const std::filesystem::path& path)
    : LogReader(truth_source(LineReader(path))) {}

TruthTrack::TruthTrack(TruthLogReader reader) : reader_(std::move(reader)) {
  after_ = reader_.next();
}

std::optional<TruthRecord> TruthTrack::interpolate(Time t) {
  if (t < last_t_) throw Error("TruthTrack::interpolate: times must not go back");
  last_t_ = t;
  while (after_ && after_->nav.time <= t) {
    before_ = after_;
    after_ = reader_.next();
  }
  if (before_ && before_->nav.time == t) return before_;
  if (!before_ || !after_ || after_->nav.time - before_->nav.time > kMaxGap) return std::nullopt;
  return mix(*before_, *after_, t);
}

TruthLogWriter::TruthLogWriter(const std::filesystem::path& path)
    : csv_(path, {"t_s", "lat_deg", "lon_deg", "height_m", "vn_mps", "ve_mps", "vd_mps", "roll_deg",
                  "pitch_deg", "yaw_deg"}) {}

void TruthLogWriter::write(const TruthRecord& record) {
  const NavStateNed& nav = record.nav;
  const EulerAngles& rpy = nav.attitude;
  const double velocity_or_nan = record.has_velocity ? 1.0 : kNan;
  const double attitude_or_nan = record.has_attitude ? 1.0 / kRadPerDeg : kNan;
  const Eigen::Vector3d v = velocity_or_nan * nav.v_n_mps;
  csv_.write(nav.time,
             std::array{nav.position.lat_rad / kRadPerDeg, nav.position.lon_rad / kRadPerDeg,
                        nav.position.height_m, v.x(), v.y(), v.z(), attitude_or_nan * rpy.roll_rad,
                        attitude_or_nan * rpy.pitch_rad, attitude_or_nan * rpy.yaw_rad});
}

}  // namespace leeway
