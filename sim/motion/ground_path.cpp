#include "leeway/sim/motion/ground_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/model/error_metric.hpp"

namespace leeway::sim {
namespace {

constexpr double kLongestPieceS = 0.5;

Eigen::Vector3d velocity_n_mps(const NavState& nav) {
  return ned_to_ecef(geodetic_from_ecef(nav.r_e_m)).transpose() * nav.v_e_mps;
}

/// None where the vehicle stands.
std::optional<double> course_of(const Eigen::Vector3d& v_n_mps) {
  if (v_n_mps.head<2>().norm() < kStandingMps) return {};
  return std::atan2(v_n_mps.y(), v_n_mps.x());
}

}  // namespace

struct GroundPath::Table {
  /// A time as whole laps and pieces, and a part of a piece.
  struct Place {
    double laps{};
    std::size_t piece{};
    double part{};
  };

  void make() {
    const auto pieces = static_cast<std::size_t>(std::ceil(span_s / kLongestPieceS));
    piece_s = span_s / static_cast<double>(pieces);
    std::optional<double> course_rad;
    for (std::size_t k = 0; k < pieces; ++k) {
      const double middle_s = (static_cast<double>(k) + 0.5) * piece_s;
      const Eigen::Vector3d v_n_mps = velocity_n_mps(truth_at(trajectory, middle_s).nav);
      gone_m.push_back(gone_m.back() + v_n_mps.norm() * piece_s);
      if (const auto now_rad = course_of(v_n_mps)) course_rad = now_rad;
      last_course_rad.push_back(course_rad);
    }
    start_rad = course_over_ground_rad(truth_at(trajectory, 0.0).nav);
  }

  Place place_of(double t_s) const {
    const double pieces = t_s / piece_s;
    const auto count = static_cast<double>(last_course_rad.size());
    Place place{std::floor(pieces / count)};
    const double into = std::max(pieces - place.laps * count, 0.0);
    place.piece = std::min(static_cast<std::size_t>(into), last_course_rad.size() - 1);
    place.part = into - static_cast<double>(place.piece);
    return place;
  }

  double gone_at_m(double t_s) const {
    const auto [laps, k, part] = place_of(t_s);
    return laps * gone_m.back() + std::lerp(gone_m[k], gone_m[k + 1], part);
  }

  Trajectory trajectory{};
  double span_s{};
  std::once_flag is_made{};
  double piece_s{};
  double start_rad{};
  std::vector<double> gone_m{0.0};                       // at the ends of the pieces
  std::vector<std::optional<double>> last_course_rad{};  // none before any motion
};

GroundPath::GroundPath(const Trajectory& trajectory, double duration_s)
    : table_(std::make_shared<Table>()) {
  table_->trajectory = trajectory;
  table_->span_s = std::min(trajectory.period_s.value_or(duration_s), duration_s);
}

const GroundPath::Table& GroundPath::table() const {
  std::call_once(table_->is_made, [this] { table_->make(); });
  return *table_;
}

double GroundPath::distance_m(double from_s, double to_s) const {
  return std::max(table().gone_at_m(to_s) - table().gone_at_m(from_s), 0.0);
}

double GroundPath::course_rad(double t_s) const {
  const Table& table = this->table();
  const auto now_rad = course_of(velocity_n_mps(truth_at(table.trajectory, t_s).nav));
  if (now_rad) return *now_rad;
  const Table::Place place = table.place_of(t_s);
  // Of a piece that has not moved yet in this lap, what the lap before ended with.
  const auto last_rad = table.last_course_rad[place.piece];
  if (!last_rad && place.laps > 0.0) return table.last_course_rad.back().value_or(table.start_rad);
  return last_rad.value_or(table.start_rad);
}

}  // namespace leeway::sim
