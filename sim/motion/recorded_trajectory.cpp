#include "leeway/sim/motion/recorded_trajectory.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/logs/truth_log.hpp"
#include "lib/earth/field_walk.hpp"
#include "sim/motion/smoothing_spline.hpp"

namespace leeway::sim {
namespace {

constexpr std::size_t kFewestRows = 10;
constexpr std::size_t kMostRows = 5'000'000;
constexpr double kLongestS = 1e6;
constexpr double kMostKnots = 5e6;
constexpr double kFarthestM = 7e6;
constexpr double kSteepestRad = 80.0 * kRadPerDeg;

using Samples = SmoothingSpline::Samples;

/// The rows of a log, from time 0.
struct Recording {
  std::string file{};
  std::vector<double> t_s{};
  std::vector<NavStateNed> rows{};
  bool has_attitude{false};

  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(fmt::format("{}: {}", file, what));
  }
};

void check_row(const Recording& recording, const TruthRecord& record, std::int64_t line,
               double max_gap_s) {
  const auto at = [&] { return fmt::format("data line {}: ", line); };
  if (record.has_attitude != recording.has_attitude) {
    recording.refuse(at() +
                     "attitude is there in some rows and not in others: complete it or "
                     "leave its columns out");
  }
  if (std::abs(record.nav.attitude.pitch_rad) > kSteepestRad) {
    recording.refuse(at() + "pitch is beyond 80 deg: such a motion cannot be smoothed by angles");
  }
  if (recording.t_s.size() < 2) return;
  const double gap_s = recording.t_s.back() - recording.t_s[recording.t_s.size() - 2];
  if (gap_s > max_gap_s) {
    recording.refuse(at() + fmt::format("a hole of {:.9g} s before it, longer than max_gap_s = "
                                        "{:.9g}: cut the log or allow it",
                                        gap_s, max_gap_s));
  }
  if (recording.t_s.back() > kLongestS || recording.t_s.size() > kMostRows) {
    recording.refuse(at() + "the log is longer than 1e6 s or 5e6 rows: cut it");
  }
}

void add(Recording& recording, const TruthRecord& record, std::int64_t line, double max_gap_s) {
  if (recording.rows.empty()) recording.has_attitude = record.has_attitude;
  recording.rows.push_back(record.nav);
  recording.t_s.push_back(to_seconds(record.nav.time - recording.rows.front().time));
  check_row(recording, record, line, max_gap_s);
}

Recording read(const RecordedParameters& p) {
  if (!std::filesystem::is_regular_file(p.file)) {
    throw Error(p.file.string() + ": is no file to read a trajectory from");
  }
  Recording recording;
  recording.file = p.file.string();
  TruthLogReader reader(p.file);
  while (const auto record = reader.next()) {
    add(recording, *record, reader.summary().lines, p.max_gap_s);
  }
  const LogSummary& summary = reader.summary();
  if (!summary.messages.empty()) throw Error(summary.messages.front());
  if (!summary.incomplete.empty()) recording.refuse(summary.incomplete);
  return recording;
}

void check_length(const Recording& recording, const RecordedParameters& p) {
  if (recording.rows.size() < kFewestRows) {
    recording.refuse(fmt::format("{} rows are too few: at least {} make a trajectory",
                                 recording.rows.size(), kFewestRows));
  }
  const double duration_s = recording.t_s.back();
  if (duration_s < 2.0 * p.smoothing_s || duration_s > kMostKnots * p.smoothing_s) {
    recording.refuse(fmt::format("{:.9g} s of log do not go with smoothing_s = {:.9g}", duration_s,
                                 p.smoothing_s));
  }
}

Samples positions(const Recording& recording, const TangentPlane& plane) {
  Samples samples(static_cast<Eigen::Index>(recording.rows.size()), 3);
  for (std::size_t k = 0; k < recording.rows.size(); ++k) {
    const Eigen::Vector3d from_origin_e_m =
        ecef_from_geodetic(recording.rows[k].position) - plane.origin_e_m;
    if (from_origin_e_m.norm() > kFarthestM) {
      recording.refuse(fmt::format("goes further than 7000 km from its start {:.9g} s after it",
                                   recording.t_s[k]));
    }
    samples.row(static_cast<Eigen::Index>(k)) =
        (plane.C_el.transpose() * from_origin_e_m).transpose();
  }
  return samples;
}

/// Heading and pitch along the velocity, at the rows where it is fast enough.
std::vector<std::optional<EulerAngles>> courses(const Recording& recording,
                                                const TangentPlane& plane,
                                                const SmoothingSpline& position,
                                                double min_speed_mps) {
  std::vector<std::optional<EulerAngles>> courses(recording.rows.size());
  for (std::size_t k = 0; k < courses.size(); ++k) {
    const double t_s = recording.t_s[k];
    const Eigen::Vector3d v_l_mps(position.at(t_s, 0).first, position.at(t_s, 1).first,
                                  position.at(t_s, 2).first);
    const Eigen::Matrix3d C_en = ned_to_ecef(recording.rows[k].position);
    const Eigen::Vector3d v_n_mps = C_en.transpose() * plane.C_el * v_l_mps;
    const double ground_mps = v_n_mps.head<2>().norm();
    if (ground_mps < min_speed_mps) continue;
    courses[k] = EulerAngles{0.0, std::atan2(-v_n_mps.z(), ground_mps),
                             std::atan2(v_n_mps.y(), v_n_mps.x())};
  }
  return courses;
}

/// Angles at the rows between the known ones, going the shorter way; held before and after them.
void fill_between(const std::vector<double>& t_s,
                  const std::vector<std::optional<EulerAngles>>& known,
                  std::vector<EulerAngles>& all) {
  std::optional<std::size_t> last;
  const auto fill = [&](std::size_t to, auto angles_at) {
    for (std::size_t k = last ? *last + 1 : 0; k < to; ++k) all[k] = angles_at(k);
  };
  for (std::size_t k = 0; k < known.size(); ++k) {
    if (!known[k]) continue;
    const EulerAngles to = *known[k];
    const EulerAngles from = last ? *known[*last] : to;
    const double from_s = last ? t_s[*last] : t_s.front() - 1.0;
    fill(k, [&](std::size_t i) {
      const double fraction = (t_s[i] - from_s) / (t_s[k] - from_s);
      return EulerAngles{0.0, from.pitch_rad + fraction * (to.pitch_rad - from.pitch_rad),
                         from.yaw_rad + fraction * wrap_pi(to.yaw_rad - from.yaw_rad)};
    });
    all[k] = to;
    last = k;
  }
  fill(all.size(), [&](std::size_t) { return last ? *known[*last] : EulerAngles{}; });
}

std::vector<EulerAngles> attitudes(const Recording& recording, const TangentPlane& plane,
                                   const SmoothingSpline& position, double min_speed_mps) {
  std::vector<EulerAngles> attitudes(recording.rows.size());
  if (!recording.has_attitude) {
    fill_between(recording.t_s, courses(recording, plane, position, min_speed_mps), attitudes);
    return attitudes;
  }
  for (std::size_t k = 0; k < attitudes.size(); ++k) attitudes[k] = recording.rows[k].attitude;
  return attitudes;
}

/// The same attitudes in the axes of the plane, without jumps of a full turn.
Samples angles(const Recording& recording, const TangentPlane& plane,
               const std::vector<EulerAngles>& attitudes) {
  Samples samples(static_cast<Eigen::Index>(attitudes.size()), 3);
  Eigen::RowVector3d before = Eigen::RowVector3d::Zero();
  for (std::size_t k = 0; k < attitudes.size(); ++k) {
    const Eigen::Matrix3d C_lb = plane.C_el.transpose() * ned_to_ecef(recording.rows[k].position) *
                                 rotation_from_euler(attitudes[k]);
    const EulerAngles rpy = euler_from_rotation(C_lb);
    const Eigen::RowVector3d now(rpy.roll_rad, rpy.pitch_rad, rpy.yaw_rad);
    for (int i = 0; i < 3; ++i) before[i] += wrap_pi(now[i] - before[i]);
    samples.row(static_cast<Eigen::Index>(k)) = before;
  }
  return samples;
}

void check(const RecordedParameters& p) {
  require("recorded trajectory", "smoothing_s", p.smoothing_s, between(0.01, 100.0));
  require("recorded trajectory", "max_gap_s", p.max_gap_s, between(0.01, 1e4));
  require("recorded trajectory", "min_speed_mps", p.min_speed_mps, between(0.01, 100.0));
}

Trajectory smoothed(const Recording& recording, const RecordedParameters& p) {
  check_length(recording, p);
  Trajectory trajectory;
  trajectory.name = p.file.filename().string();
  trajectory.plane = TangentPlane(recording.rows.front().position);
  trajectory.duration_s = recording.t_s.back();
  const auto position = std::make_shared<const SmoothingSpline>(
      recording.t_s, positions(recording, trajectory.plane), p.smoothing_s);
  const auto attitude = std::make_shared<const SmoothingSpline>(
      recording.t_s,
      angles(recording, trajectory.plane,
             attitudes(recording, trajectory.plane, *position, p.min_speed_mps)),
      p.smoothing_s);
  trajectory.breaks_s = position->knots_s();
  trajectory.motion = [position, attitude](double t_s) {
    return LocalMotion{position->at(t_s, 0), position->at(t_s, 1), position->at(t_s, 2),
                       attitude->at(t_s, 0), attitude->at(t_s, 1), attitude->at(t_s, 2)};
  };
  return trajectory;
}

}  // namespace

Trajectory recorded_trajectory(const RecordedParameters& p) {
  check(p);
  return smoothed(read(p), p);
}

Trajectory recorded_trajectory(const std::vector<NavStateNed>& rows, const RecordedParameters& p) {
  check(p);
  Recording recording;
  recording.file = p.file.string();
  for (const NavStateNed& row : rows) {
    add(recording, {row, true, true}, static_cast<std::int64_t>(recording.rows.size()) + 1,
        p.max_gap_s);
  }
  return smoothed(recording, p);
}

}  // namespace leeway::sim
