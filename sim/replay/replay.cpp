#include "leeway/sim/replay/replay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/logs/solution_writer.hpp"
#include "leeway/model/gnss_measurement.hpp"

namespace leeway::sim {
namespace {

/// Horizontal and vertical distance of two points a short way apart.
struct Miss {
  double horizontal_m;
  double vertical_m;
};

Miss miss(const Eigen::Vector3d& a_e_m, const Eigen::Vector3d& b_e_m) {
  const Eigen::Vector3d d_n = ned_to_ecef(geodetic_from_ecef(b_e_m)).transpose() * (a_e_m - b_e_m);
  return {d_n.head<2>().norm(), std::abs(d_n.z())};
}

/// Carries the estimate back by less than an IMU interval, at its velocity.
Eigen::Vector3d moved_to(Time t, const NavState& nav, const Eigen::Vector3d& r_e_m) {
  return r_e_m + to_seconds(t - nav.time) * nav.v_e_mps;
}

/// The truth log within its window of use.
class Reference {
 public:
  explicit Reference(const ReplayInput& input)
      : track_(TruthLogReader(input.truth)),
        from_(clamped(input.truth_from_s)),
        to_(clamped(input.truth_to_s)) {}

  std::optional<TruthRecord> at(Time t) {
    if (t < from_ || t > to_) return std::nullopt;
    return track_.interpolate(t);
  }

  const LogSummary& report() const { return track_.report(); }

 private:
  static Time clamped(double t_s) { return time_from_seconds(std::clamp(t_s, -9e9, 9e9)); }

  TruthTrack track_;
  Time from_;
  Time to_;
};

/// The readings of a sensor whose log may be missing, in the order of time.
class Readings {
 public:
  Readings(const Aiding& aiding, const std::filesystem::path& path) : aiding_(aiding) {
    if (path.empty()) return;
    reader_.emplace(path, columns_of(aiding));
    next_ = reader_->next();
  }

  /// Calls f with every reading up to t that has not been taken.
  template <class F>
  void take_until(Time t, F&& f) {
    for (; next_ && next_->time <= t; next_ = reader_->next()) {
      f(aiding_.reading(next_->time, next_->value,
                        std::isfinite(next_->sigma) ? next_->sigma : aiding_.default_sigma));
    }
  }

  LogSummary report() const { return reader_ ? reader_->report() : LogSummary{}; }

 private:
  const Aiding& aiding_;
  std::optional<ScalarLogReader> reader_{};
  std::optional<ScalarRecord> next_{};
};

/// One outage: a copy of the navigator that goes on without fixes.
class Branch {
 public:
  Branch(std::size_t index, const Outage& outage, const ReplayObserver& observer)
      : index_(index),
        observer_(observer),
        start_(time_from_seconds(outage.start_s)),
        end_(start_ + duration_from_seconds(outage.duration_s)) {
    result_.outage = outage;
  }

  std::size_t index() const { return index_; }
  Time start() const { return start_; }
  bool over() const { return over_; }
  bool is_running() const { return navigator_.has_value(); }
  const OutageResult& result() const { return result_; }

  void begin(const Navigator& aided) {
    if (!navigator_) navigator_ = aided;
  }

  bool withholds(Time t) const { return navigator_ && !over_ && t > start_ && t <= end_; }

  void withhold(const GnssFix& fix) { withheld_ = fix; }

  /// Aiding goes on through an outage. @pre begin() has been called.
  void push(const Reading& reading) { navigator_->push(reading); }

  /// @pre begin() has been called.
  void push(const ImuIncrement& inc, Reference* reference) {
    navigator_->push(inc);
    if (withheld_ && withheld_->time <= inc.time) {
      compare(withheld_->time, reference);
      withheld_.reset();
    }
    if (inc.time >= end_) finish(reference);
  }

 private:
  /// Error at t, against the reference or, without one, the withheld fix of that time.
  void compare(Time t, Reference* reference) {
    if (!navigator_->aligned()) return;
    const Estimate& estimate = navigator_->filter().estimate();
    Miss m{};
    if (reference) {
      const auto truth = reference->at(t);
      if (!truth) return;
      m = miss(moved_to(t, estimate.nav, estimate.nav.r_e_m),
               ecef_from_geodetic(truth->nav.position));
    } else {
      if (!withheld_->position) return;
      const Eigen::Vector3d& lever = navigator_->filter().inertial().config().lever_arm_b_m;
      m = miss(moved_to(t, estimate.nav, antenna_position_e(estimate, lever)),
               withheld_->position->r_e_m);
    }
    result_.end_error_h_m = m.horizontal_m;
    result_.end_error_v_m = m.vertical_m;
    result_.max_error_h_m = std::max(result_.max_error_h_m, m.horizontal_m);
    last_compared_ = t;
    if (!observer_.outage) return;
    observer_.outage({index_, to_seconds(t - start_), m.horizontal_m, sigma_h_m()});
  }

  double sigma_h_m() const { return navigator_->solution().sigma_position_n_m.head<2>().norm(); }

  void finish(Reference* reference) {
    // The reference must reach the very end; GNSS epochs may miss it by one.
    constexpr Duration kEpochSlack = std::chrono::milliseconds{1500};
    if (reference && last_compared_ < end_) compare(end_, reference);
    if (last_compared_ >= (reference ? end_ : end_ - kEpochSlack)) {
      result_.against = reference ? Against::kReference : Against::kGnss;
    }
    if (navigator_->aligned()) {
      result_.end_sigma_h_m = sigma_h_m();
    }
    over_ = true;
    navigator_.reset();
  }

  std::size_t index_;
  const ReplayObserver& observer_;
  Time start_;
  Time end_;
  std::optional<Navigator> navigator_{};
  std::optional<GnssFix> withheld_{};
  Time last_compared_{Time::min()};
  bool over_{false};
  OutageResult result_{};
};

/// Sums of squares towards RmsErrors.
class RmsSum {
 public:
  void add(const NavState& nav, const TruthRecord& truth) {
    const NavState true_nav = nav_state_from_ned(truth.nav);
    const Miss m = miss(nav.r_e_m, true_nav.r_e_m);
    ++epochs_;
    horizontal_ += m.horizontal_m * m.horizontal_m;
    vertical_ += m.vertical_m * m.vertical_m;
    if (truth.has_velocity) {
      velocity_ += (nav.v_e_mps - true_nav.v_e_mps).squaredNorm();
      ++velocity_epochs_;
    }
    if (truth.has_attitude) {
      attitude_ += log_quaternion(nav.q_eb * true_nav.q_eb.conjugate()).squaredNorm();
      ++attitude_epochs_;
    }
  }

  RmsErrors rms() const {
    const auto root = [](double sum, std::int64_t n) {
      return n > 0 ? std::sqrt(sum / static_cast<double>(n))
                   : std::numeric_limits<double>::quiet_NaN();
    };
    return {epochs_, root(horizontal_, epochs_), root(vertical_, epochs_),
            root(velocity_, velocity_epochs_), root(attitude_, attitude_epochs_) / kRadPerDeg};
  }

 private:
  std::int64_t epochs_{0};
  std::int64_t velocity_epochs_{0};
  std::int64_t attitude_epochs_{0};
  double horizontal_{0.0};
  double vertical_{0.0};
  double velocity_{0.0};
  double attitude_{0.0};
};

/// The pass over the logs.
class Replay {
 public:
  Replay(const ReplayInput& input, const NavigatorConfig& config, const ReplayObserver& observer)
      : observer_(observer),
        imu_(input.imu, input.imu_options),
        gnss_(input.gnss, input.gnss_options),
        navigator_(config),
        output_interval_(duration_from_seconds(1.0 / input.solution_rate_hz)) {
    if (!input.truth.empty()) reference_.emplace(input);
    if (!input.solution.empty()) writer_.emplace(input.solution);
    if (input.start) navigator_.start(input.start->estimate, input.start->P);
    for (const Outage& outage : input.outages) {
      branches_.emplace_back(branches_.size(), outage, observer_);
    }
    for (std::size_t a = 0; a < kAidings.size(); ++a) {
      aidings_.emplace_back(kAidings[a], input.aidings[a]);
    }
    next_fix_ = gnss_.next();
  }

  ReplayResult run() {
    constexpr int kProgressEvery = 4096;
    int until_progress = kProgressEvery;
    while (const auto inc = imu_.next()) {
      push_fixes(inc->time);
      push(*inc);
      if (observer_.verdict) tell_verdicts(inc->time);
      if (observer_.progress && --until_progress == 0) {
        until_progress = kProgressEvery;
        observer_.progress(inc->time);
      }
    }
    return result();
  }

 private:
  Reference* reference() { return reference_ ? &*reference_ : nullptr; }

  /// Fixes up to t go to the navigator, and to the branches that do not withhold them.
  void push_fixes(Time t) {
    for (; next_fix_ && next_fix_->time <= t; next_fix_ = gnss_.next()) {
      begin_branches(next_fix_->time - Duration{1});
      for (Branch& branch : branches_) {
        if (branch.withholds(next_fix_->time)) branch.withhold(*next_fix_);
      }
      navigator_.push(*next_fix_);
      if (imu_started_) ++result_.fixes_in_span;
    }
    imu_started_ = true;
    begin_branches(t);
    const auto push_to_all = [this](const Reading& reading) {
      for (Branch& branch : branches_) {
        if (branch.is_running()) branch.push(reading);
      }
      navigator_.push(reading);
    };
    for (Readings& readings : aidings_) readings.take_until(t, push_to_all);
  }

  void begin_branches(Time t) {
    for (Branch& branch : branches_) {
      if (!branch.over() && branch.start() <= t) branch.begin(navigator_);
    }
  }

  void push(const ImuIncrement& inc) {
    for (Branch& branch : branches_) {
      if (!branch.over() && branch.start() <= inc.time) branch.push(inc, reference());
    }
    const Time judged = navigator_.last_update().time;
    navigator_.push(inc);
    if (!navigator_.aligned()) return;
    const UpdateOutcome& update = navigator_.last_update();
    if (update.time != judged && update.dof > 0) note(update);
    if (inc.time >= next_output_) output(inc.time);
  }

  /// What has been counted since the call before.
  void tell_verdicts(Time t) {
    for (std::size_t v = 0; v < kVerdicts; ++v) {
      const auto verdict = static_cast<Verdict>(v);
      const std::uint64_t count = navigator_.count(verdict);
      const bool is_news = verdict != Verdict::kAccepted && verdict != Verdict::kAligning;
      if (is_news && count > told_[v]) observer_.verdict(t, verdict);
      told_[v] = count;
    }
  }

  void note(const UpdateOutcome& update) {
    if (observer_.fix) observer_.fix(update);
    ++result_.fixes;
    latest_nis_ = update.nis;
    latest_dof_ = update.dof;
    if (update.outcome != UpdateOutcome::Outcome::kFused) return;
    ++fused_;
    result_.nis_mean += update.nis;
    result_.nis_dof_mean += update.dof;
  }

  void output(Time t) {
    if (!result_.has_solution) result_.first_solution_s = to_seconds(t);
    result_.has_solution = true;
    result_.last_solution_s = to_seconds(t);
    next_output_ = Time{(t.time_since_epoch() / output_interval_ + 1) * output_interval_};
    const Estimate& estimate = navigator_.filter().estimate();
    const std::optional<TruthRecord> truth = reference_ ? reference_->at(t) : std::nullopt;
    if (truth) rms_.add(estimate.nav, *truth);
    if (!writer_ && !observer_.epoch) return;
    Solution s = navigator_.solution();
    if (latest_dof_ > 0) {
      s.nis = latest_nis_;
      s.nis_dof = latest_dof_;
      latest_dof_ = 0;
    }
    if (writer_) writer_->write(s);
    if (observer_.epoch) observer_.epoch(s, truth);
  }

  ReplayResult result() {
    if (writer_) writer_->close();
    for (const Branch& branch : branches_) result_.outages.push_back(branch.result());
    result_.rms = rms_.rms();
    for (std::size_t v = 0; v < kVerdicts; ++v) {
      result_.verdicts[v] = navigator_.count(static_cast<Verdict>(v));
    }
    const double fused = static_cast<double>(std::max<std::int64_t>(fused_, 1));
    result_.nis_mean /= fused;
    result_.nis_dof_mean /= fused;
    result_.health = navigator_.health();
    if (navigator_.C_bs()) {
      const EulerAngles mount = euler_from_rotation(*navigator_.C_bs());
      result_.mount_rpy_deg =
          Eigen::Vector3d(mount.roll_rad, mount.pitch_rad, mount.yaw_rad) / kRadPerDeg;
      // As --mount takes it: a yaw of -90 deg is not one of 270.
      result_.mount_rpy_deg->z() = std::remainder(result_.mount_rpy_deg->z(), 360.0);
    }
    if (navigator_.aligned()) {
      result_.final_roll_deg =
          ned_from_nav_state(navigator_.filter().estimate().nav).attitude.roll_rad / kRadPerDeg;
    }
    result_.imu_report = imu_.report();
    result_.gnss_report = gnss_.report();
    for (std::size_t a = 0; a < kAidings.size(); ++a) {
      result_.aiding_reports[a] = aidings_[a].report();
    }
    if (reference_) result_.truth_report = reference_->report();
    return result_;
  }

  const ReplayObserver& observer_;
  ImuLogReader imu_;
  GnssLogReader gnss_;
  std::vector<Readings> aidings_{};
  Navigator navigator_;
  Duration output_interval_;
  std::optional<Reference> reference_{};
  std::optional<SolutionWriter> writer_{};
  std::vector<Branch> branches_{};
  std::optional<GnssFix> next_fix_{};
  bool imu_started_{false};
  Time next_output_{Time::min()};
  double latest_nis_{0.0};
  int latest_dof_{0};
  std::array<std::uint64_t, kVerdicts> told_{};
  std::int64_t fused_{0};
  RmsSum rms_{};
  ReplayResult result_{};
};

}  // namespace

ScalarColumns columns_of(const Aiding& aiding) {
  return {aiding.value_column, aiding.sigma_column, aiding.largest};
}

ReplayResult replay(const ReplayInput& input, const NavigatorConfig& config,
                    const ReplayObserver& observer) {
  if (!(input.solution_rate_hz > 0.0 && input.solution_rate_hz <= 1e4)) {
    throw Error("solution rate is " + std::to_string(input.solution_rate_hz) +
                " Hz, must be above 0 and at most 10000 Hz");
  }
  return Replay(input, config, observer).run();
}

}  // namespace leeway::sim
