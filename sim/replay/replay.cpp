#include "leeway/sim/replay/replay.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <list>

#include "leeway/earth/error.hpp"
#include "leeway/logs/solution_writer.hpp"
#include "leeway/sim/inspect/log_inspector.hpp"
#include "lib/earth/field_walk.hpp"
#include "sim/replay/branch.hpp"
#include "sim/replay/reference.hpp"

namespace leeway::sim {
namespace {

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

  LogSummary summary() const { return reader_ ? reader_->summary() : LogSummary{}; }

 private:
  const Aiding& aiding_;
  std::optional<ScalarLogReader> reader_{};
  std::optional<ScalarRecord> next_{};
};

/// The look at logs on the way, and when it is certain that they are wrong.
class Looks {
 public:
  explicit Looks(const ReplayInput& input)
      : is_as_is_(input.is_as_is), taken_care_of_(input.taken_care_of) {}

  void add(const GnssFix& fix) { inspector_.add(fix); }

  void add(const Reading& reading) {
    if (const auto* speed = std::get_if<OdometerSpeed>(&reading)) inspector_.add(*speed);
  }

  /// Whether to stop, judged a minute after the begin and whenever the log has twice the length.
  bool add(const ImuIncrement& inc) {
    inspector_.add(inc);
    seconds_ += inc.dt_s;
    if (seconds_ < next_s_) return false;
    next_s_ = 2.0 * seconds_;
    return refuses(look());
  }

  bool refuses(const LogLook& look) const { return !is_as_is_ && look.is_certainly_wrong(); }

  LogLook look() const {
    LogLook look = inspector_.look();
    std::erase_if(look.findings, [this](const Finding& f) {
      return std::find(taken_care_of_.begin(), taken_care_of_.end(), f.about) !=
             taken_care_of_.end();
    });
    return look;
  }

 private:
  bool is_as_is_;
  std::vector<std::string> taken_care_of_;
  LogInspector inspector_{};
  double seconds_{0.0};
  double next_s_{60.0};
};

/// The pass over the logs.
class Replay {
 public:
  /// @param plans  of the branches of this pass, in the order of their starts
  Replay(const ReplayInput& input, const NavigatorConfig& config, const ReplayObserver& observer,
         const std::vector<BranchPlan>& plans)
      : observer_(observer),
        plans_(plans),
        imu_(input.imu, input.imu_options),
        gnss_(input.gnss, input.gnss_options),
        navigator_(config),
        start_heading_(input.start_heading),
        output_interval_(duration_from_seconds(1.0 / input.solution_rate_hz)),
        looks_(input) {
    if (!input.truth.empty()) reference_.emplace(input);
    if (!input.solution.empty()) writer_.emplace(input.solution, input.solution_form);
    if (input.start) navigator_.start(input.start->estimate, input.start->P);
    for (const Outage& outage : input.outages) result_.outages.push_back({outage});
    for (std::size_t a = 0; a < kAidings.size(); ++a) {
      aidings_.emplace_back(kAidings[a], input.aidings[a]);
    }
    next_fix_ = gnss_.next();
  }

  ReplayResult run() {
    constexpr int kProgressEvery = 4096;
    int until_progress = kProgressEvery;
    while (const auto inc = imu_.next()) {
      if (!imu_started_) push_start_heading(*inc);
      push_fixes(inc->time);
      if (looks_.add(*inc)) break;
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

  void push_start_heading(const ImuIncrement& first) {
    if (!start_heading_) return;
    start_heading_->time = first.time - duration_from_seconds(first.dt_s);
    navigator_.push(*start_heading_);
  }

  /// Fixes up to t go to the navigator, and to the branches that do not withhold them.
  void push_fixes(Time t) {
    for (; next_fix_ && next_fix_->time <= t; next_fix_ = gnss_.next()) {
      begin_branches(next_fix_->time - Duration{1});
      for (Branch& branch : branches_) branch.push(*next_fix_);
      navigator_.push(*next_fix_);
      looks_.add(*next_fix_);
      if (imu_started_) ++result_.fixes_in_span;
    }
    imu_started_ = true;
    begin_branches(t);
    const auto push_to_all = [this](const Reading& reading) {
      for (Branch& branch : branches_) branch.push(reading);
      navigator_.push(reading);
      looks_.add(reading);
    };
    for (Readings& readings : aidings_) readings.take_until(t, push_to_all);
  }

  void begin_branches(Time t) {
    for (; begun_ < plans_.size() && plans_[begun_].start <= t; ++begun_) {
      branches_.emplace_back(plans_[begun_], navigator_, observer_);
    }
  }

  void end_branches() {
    branches_.remove_if([this](const Branch& branch) {
      if (branch.over()) keep(branch);
      return branch.over();
    });
  }

  void keep(const Branch& branch) {
    if (branch.plan().interval) return;
    OutageResult& result = result_.outages[branch.plan().index];
    const Outage outage = result.outage;
    result = branch.result();
    result.outage = outage;
  }

  void push(const ImuIncrement& inc) {
    for (Branch& branch : branches_) branch.push(inc, reference());
    end_branches();
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
    next_output_ = Time{(t.time_since_epoch() / output_interval_ + 1) * output_interval_};
    const Estimate& estimate = navigator_.filter().estimate();
    // After a long hole in the data the solution is that of before it.
    const Time at = estimate.nav.time;
    if (result_.has_solution && at <= last_output_) return;
    last_output_ = at;
    if (!result_.has_solution) result_.first_solution_s = to_seconds(at);
    result_.has_solution = true;
    result_.last_solution_s = to_seconds(at);
    const std::optional<TruthRecord> truth = reference_ ? reference_->at(at) : std::nullopt;
    if (truth) rms_.add(estimate.nav, *truth);
    if (observer_.health) observer_.health(navigator_.health());
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
    if (next_fix_ && result_.fixes_in_span == 0) looks_.add(*next_fix_);
    result_.look = looks_.look();
    result_.is_refused = looks_.refuses(result_.look);
    if (result_.is_refused) result_.has_solution = false;
    if (writer_ && !result_.is_refused) writer_->close();
    for (const Branch& branch : branches_) keep(branch);
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
    result_.imu_summary = imu_.summary();
    result_.gnss_summary = gnss_.summary();
    for (std::size_t a = 0; a < kAidings.size(); ++a) {
      result_.aiding_summaries[a] = aidings_[a].summary();
    }
    if (reference_) result_.truth_summary = reference_->summary();
    return result_;
  }

  const ReplayObserver& observer_;
  const std::vector<BranchPlan>& plans_;
  std::size_t begun_{0};
  ImuLogReader imu_;
  GnssLogReader gnss_;
  std::vector<Readings> aidings_{};
  Navigator navigator_;
  std::optional<MeasuredHeading> start_heading_;
  Duration output_interval_;
  Looks looks_;
  std::optional<Reference> reference_{};
  std::optional<SolutionWriter> writer_{};
  std::list<Branch> branches_{};
  std::optional<GnssFix> next_fix_{};
  bool imu_started_{false};
  Time next_output_{Time::min()};
  Time last_output_{Time::min()};
  double latest_nis_{0.0};
  int latest_dof_{0};
  std::array<std::uint64_t, kVerdicts> told_{};
  std::int64_t fused_{0};
  RmsSum rms_{};
  ReplayResult result_{};
};

std::vector<BranchPlan> plans_of(const ReplayInput& input) {
  std::vector<BranchPlan> plans;
  for (std::size_t k = 0; k < input.outages.size(); ++k) {
    plans.push_back(BranchPlan::of(k, input.outages[k]));
  }
  for (std::size_t k = 0; k < input.thinnings.size(); ++k) {
    plans.push_back(BranchPlan::of(k, input.thinnings[k]));
  }
  return plans;
}

void require_files(const ReplayInput& input, std::size_t passes) {
  const auto require_file = [&](const std::filesystem::path& path) {
    if (path.empty() || std::filesystem::is_regular_file(path)) return;
    throw Error(
        fmt::format("{}: is no file, and so many outages overlap that the logs have to be "
                    "read {} times: put the log into a file, or ask for fewer at once",
                    path.string(), passes));
  };
  for (const auto& path : {input.imu, input.gnss, input.truth}) require_file(path);
  for (const auto& path : input.aidings) require_file(path);
}

/// The passes after the first: nothing but their branches is wanted of them.
void replay_further(ReplayInput input, const NavigatorConfig& config,
                    const ReplayObserver& observer,
                    const std::vector<std::vector<BranchPlan>>& passes, ReplayResult& result) {
  require_files(input, passes.size());
  input.solution.clear();
  ReplayObserver of_branches;
  of_branches.outage = observer.outage;
  of_branches.thinned = observer.thinned;
  for (std::size_t k = 1; k < passes.size(); ++k) {
    const ReplayResult further = Replay(input, config, of_branches, passes[k]).run();
    for (const BranchPlan& plan : passes[k]) {
      if (!plan.interval) result.outages[plan.index] = further.outages[plan.index];
    }
  }
}

}  // namespace

ScalarColumns columns_of(const Aiding& aiding) {
  return {aiding.value_column, aiding.sigma_column, aiding.largest};
}

ReplayResult replay(const ReplayInput& input, const NavigatorConfig& config,
                    const ReplayObserver& observer) {
  require("replay", "solution_rate_hz", input.solution_rate_hz, positive_to(1e4));
  const auto passes = passes_of(plans_of(input), kMostBranches);
  ReplayResult result = Replay(input, config, observer, passes.front()).run();
  if (passes.size() > 1 && !result.is_refused)
    replay_further(input, config, observer, passes, result);
  return result;
}

}  // namespace leeway::sim
