#include "leeway/logs/gnss_log.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "lib/logs/layouts/gnss_layouts.hpp"
#include "lib/logs/layouts/phone_folder.hpp"

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
    if (!options.format.gnss_sigma.empty()) set_sigmas(fix);
    fix.position->R_e_m2 *= squared(options.position_sigma_scale);
    if (fix.velocity) fix.velocity->R_e_m2ps2 *= squared(options.velocity_sigma_scale);
    if (is_usable(fix)) return std::nullopt;
    return Fault{LineDamage::kOutOfRange, line};
  }

  void set_sigmas(GnssFix& fix) const {
    const std::vector<double>& sigma = options.format.gnss_sigma;
    const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(fix.position->r_e_m));
    const auto R_e = [&](double horizontal, double vertical) -> Eigen::Matrix3d {
      const Eigen::Vector3d of_axis(horizontal, horizontal, vertical);
      return C_en * of_axis.cwiseAbs2().asDiagonal() * C_en.transpose();
    };
    fix.position->R_e_m2 = R_e(sigma[0], sigma[1]);
    if (fix.velocity && sigma.size() == 4) fix.velocity->R_e_m2ps2 = R_e(sigma[2], sigma[3]);
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
  const std::size_t sigmas = options.format.gnss_sigma.size();
  if (sigmas != 0 && sigmas != 2 && sigmas != 4) {
    throw Error("LogFormat::gnss_sigma: give two numbers or four");
  }
  std::vector<std::string> notes;
  LogOpening log{read_head(lines), lines, options.format, notes, {}};
  const GnssLayout& layout = layout_of(log, gnss_layouts());
  ScaledFix parser{layout.parser(log), options};
  if (log.framing) {
    return std::make_unique<LogSource<GnssFix, MessageReader>>(
        MessageReader(std::move(lines).take_bytes(), std::move(log.framing)), std::move(parser),
        layout.name, std::move(notes));
  }
  return std::make_unique<LogSource<GnssFix>>(std::move(lines), std::move(parser), layout.name,
                                              std::move(notes));
}

}  // namespace

const std::vector<GnssLayout>& gnss_layouts() {
  static const std::vector kLayouts{gnss_csv(), gnss_phone(), gnss_kf_gins(), rtklib_pos(),
                                    nmea(),     gnss_ubx(),   gnss_ulog()};
  return kLayouts;
}

GnssLogReader::GnssLogReader(const std::filesystem::path& path, const GnssLogOptions& options)
    : LogReader(gnss_source(LineReader(location_of_phone(path)), options)) {}

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
