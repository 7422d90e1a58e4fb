#include "lib/logs/solutions/solution_formats.hpp"

namespace leeway {
namespace {

/// Time, position in east, north, up, and the quaternion from body axes to them: x, y, z, w.
void put_tum_row(RowText& text, const SolutionRow& row) {
  const Eigen::Quaterniond q_ub(row.local.C_ue * row.solution.nav.q_eb.toRotationMatrix());
  text.add(row.nav.time).add(" ", row.local.position_m(row.solution.nav), 5);
  text.add(" ", q_ub.vec(), 9).add(" ").add(q_ub.w(), 9).add("\n");
}

}  // namespace

const SolutionFormat kTumFormat{"tum", "", put_tum_row, ""};

}  // namespace leeway
