#include "leeway/logs/gnss_log.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "lib/logs/layouts/gnss_layouts.hpp"

namespace leeway {
namespace {

/// A layout's parser, and what the options make of its fixes.
struct ScaledFix {
  RowParser<GnssFix> parse;
  GnssLogOptions options;

  std::optional<Fault> operator()(std::string_view line, GnssFix& fix) const {
    if (auto fault = parse(line, fix)) return fault;
    const auto squared = [](double x) { return x * x; };
    fix.time += options.time_offset;
    fix.position->R_e_m2 *= squared(options.position_sigma_scale);
    if (fix.velocity) fix.velocity->R_e_m2ps2 *= squared(options.velocity_sigma_scale);
    if (is_usable(fix)) return std::nullopt;
    return Fault{LineDamage::kOutOfRange, line};
  }
};

void validate_scale(const char* field, double scale) {
  if (scale > 0.0 && std::isfinite(scale)) return;
  throw Error(std::string("GnssLogOptions::") + field + " of " + std::to_string(scale) +
              ": must be finite and > 0");
}

std::unique_ptr<RecordSource<GnssFix>> gnss_source(LineReader lines,
                                                   const GnssLogOptions& options) {
  validate_scale("position_sigma_scale", options.position_sigma_scale);
  validate_scale("velocity_sigma_scale", options.velocity_sigma_scale);
  const LogHead head = read_head(lines);
  const GnssLayout& layout = layout_of(head, gnss_layouts());
  ScaledFix parser{layout.parser(head, lines), options};
  return std::make_unique<LogSource<GnssFix>>(std::move(lines), std::move(parser), layout.name);
}

}  // namespace

const std::vector<GnssLayout>& gnss_layouts() {
  static const std::vector kLayouts{gnss_csv(), gnss_kf_gins(), rtklib_pos()};
  return kLayouts;
}

GnssLogReader::GnssLogReader(const std::filesystem::path& path, const GnssLogOptions& options)
    : LogReader(gnss_source(LineReader(path), options)) {}

GnssLogWriter::GnssLogWriter(const std::filesystem::path& path)
    : csv_(path,
           {"t_s", "lat_deg", "lon_deg", "height_m", "vn_mps", "ve_mps", "vd_mps", "pos_std_n_m",
            "pos_std_e_m", "pos_std_d_m", "vel_std_n_mps", "vel_std_e_mps", "vel_std_d_mps"}) {}

void GnssLogWriter::write(const GnssFix& fix) {
  if (!fix.position) throw Error("GnssLogWriter: the layout needs a position in every fix");
  const Geodetic place = geodetic_from_ecef(fix.position->r_e_m);
  const Eigen::Matrix3d C_en = ned_to_ecef(place);
  const auto sigma_n = [&](const Eigen::Matrix3d& R_e) -> Eigen::Vector3d {
    return (C_en.transpose() * R_e * C_en).diagonal().cwiseSqrt();
  };
  const Eigen::Vector3d p = sigma_n(fix.position->R_e_m2);
  Eigen::Vector3d v = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Vector3d s = v;
  if (fix.velocity) {
    v = C_en.transpose() * fix.velocity->v_e_mps;
    s = sigma_n(fix.velocity->R_e_m2ps2);
  }
  csv_.write(fix.time,
             std::array{place.lat_rad / kRadPerDeg, place.lon_rad / kRadPerDeg, place.height_m,
                        v.x(), v.y(), v.z(), p.x(), p.y(), p.z(), s.x(), s.y(), s.z()});
}

}  // namespace leeway
