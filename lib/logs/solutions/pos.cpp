#include "lib/logs/solutions/solution_formats.hpp"

namespace leeway {
namespace {

/// Source: RTKLIB ver. 2.4.2 Manual, appendix B.1. Covariances between axes are not known: zero.
void put_pos_row(RowText& text, const SolutionRow& row) {
  const auto week = std::chrono::floor<std::chrono::weeks>(row.nav.time.time_since_epoch());
  const Solution& s = row.solution;
  text.add(static_cast<double>(week.count()), 0).add(" ").add(row.nav.time - week);
  text.add(" ").add(row.lat_deg(), 10).add(" ").add(row.lon_deg(), 10);
  text.add(" ").add(row.nav.position.height_m, 5).add(" 5 0");
  text.add(" ", s.sigma_position_n_m, 5).add(" 0 0 0 0 0");
  text.add(" ").add(row.nav.v_n_mps.x(), 5).add(" ").add(row.nav.v_n_mps.y(), 5);
  text.add(" ").add(-row.nav.v_n_mps.z(), 5);
  text.add(" ", s.sigma_velocity_n_mps, 5).add(" 0 0 0\n");
}

}  // namespace

const SolutionFormat kPosFormat{
    "pos",
    "% program   : leeway\n"
    "% (lat/lon/height=WGS84/ellipsoidal,Q=1:fix,2:float,3:sbas,4:dgps,5:single,6:ppp)\n"
    "%  GPST latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m) sdu(m) sdne(m) sdeu(m) "
    "sdun(m) age(s) ratio vn(m/s) ve(m/s) vu(m/s) sdvn sdve sdvu sdvne sdveu sdvun\n",
    put_pos_row, ""};

}  // namespace leeway
