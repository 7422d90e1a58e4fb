#include "leeway/sim/replay/log_study.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/error.hpp"
#include "leeway/sim/tools/parallel.hpp"
#include "lib/earth/field_walk.hpp"
#include "sim/replay/branch.hpp"
#include "sim/replay/expected_errors.hpp"
#include "sim/replay/log_survey.hpp"

namespace leeway::sim {
namespace {

/// Branches of one job: few enough that several jobs at once fit into memory, and enough that the
/// pass of the navigator they branch from hardly counts.
constexpr std::size_t kBranchesOfJob = 16;
/// GNSS epochs may miss the end of an outage by one.
constexpr double kEpochSlackS = 1.5;
constexpr double kSettledShare = 0.5;  // of the solution at most

/// The times of a study, by the clock of the log.
struct StudySpan {
  double first_s{};
  double settled_s{};
  double last_s{};
};

StudySpan span_of(const LogSurvey& survey, const LogStudyConfig& study) {
  const double first_s = survey.result.first_solution_s;
  const double last_s = survey.result.last_solution_s;
  const double settle_s = std::min(study.settle_s, kSettledShare * (last_s - first_s));
  return {first_s, first_s + settle_s, last_s};
}

/// Beginnings at fixes, while the vehicle moves and the shortest outage fits.
std::vector<Outage> outages_of(const LogSurvey& survey, const StudySpan& span,
                               const LogStudyConfig& study) {
  std::vector<Outage> outages;
  double next_s = span.settled_s;
  for (const double t_s : survey.fixes_s) {
    if (t_s < next_s || t_s + study.durations_s.front() > span.last_s) continue;
    if (speed_at(survey, t_s) < study.min_speed_mps) continue;
    outages.push_back({t_s, study.durations_s.back()});
    next_s = t_s + study.every_s;
  }
  return outages;
}

/// A row of thinned fixes, and which of the studied intervals it is of.
struct StudiedThinning {
  Thinning thinning{};
  std::size_t interval{};
};

/// Beginnings spread evenly over each interval, on fixes: all of them, or as many as there may be,
/// or one each two seconds.
std::vector<StudiedThinning> thinnings_of(const LogSurvey& survey, const StudySpan& span,
                                          const LogStudyConfig& study) {
  constexpr double kPhaseS = 2.0;
  std::vector<StudiedThinning> all;
  const double own_s = survey.receiver.interval_s;
  const auto first_fix =
      std::lower_bound(survey.fixes_s.begin(), survey.fixes_s.end(), span.settled_s);
  if (first_fix == survey.fixes_s.end()) return all;
  for (std::size_t k = 0; k < kStudiedIntervalsS.size(); ++k) {
    const double interval_s = kStudiedIntervalsS[k];
    if (interval_s < 0.99 * own_s || *first_fix + interval_s > span.last_s) continue;
    const int phases =
        std::clamp(static_cast<int>(interval_s / std::max(own_s, kPhaseS)), 1, study.most_phases);
    for (int phase = 0; phase < phases; ++phase) {
      const double shift_s = std::floor(phase * interval_s / phases / own_s) * own_s;
      if (*first_fix + shift_s + interval_s > span.last_s) break;
      all.push_back({{*first_fix + shift_s, interval_s}, k});
    }
  }
  return all;
}

/// The withheld epochs of one outage.
struct OutageCourse {
  std::vector<double> since_s{};
  std::vector<double> error_h_m{};
};

/// The outage as long as each duration that fits before the end of the solution.
void add_outages(const Outage& outage, const OutageCourse& course,
                 const std::vector<double>& durations_s, double last_s,
                 std::vector<OutageError>& all) {
  for (const double duration_s : durations_s) {
    if (outage.start_s + duration_s > last_s) break;
    OutageError error{outage.start_s, duration_s};
    double end_s = -kEpochSlackS;
    for (std::size_t k = 0; k < course.since_s.size(); ++k) {
      if (course.since_s[k] > duration_s + 1e-6) break;
      end_s = course.since_s[k];
      error.end_h_m = course.error_h_m[k];
      error.largest_h_m = std::max(error.largest_h_m, course.error_h_m[k]);
    }
    if (duration_s - end_s < kEpochSlackS) all.push_back(error);
  }
}

class Study {
 public:
  Study(const ReplayInput& input, const NavigatorConfig& config, const LogStudyConfig& study,
        const std::function<void(const ReplayResult&)>& surveyed)
      : input_(input), config_(config), study_(study), surveyed_(surveyed) {}

  LogStudy run() {
    survey_ = survey_log(input_, config_);
    if (surveyed_) surveyed_(survey_.result);
    answer_.has_solution = survey_.result.has_solution;
    if (!answer_.has_solution || survey_.fixes_s.size() < 2) return answer_;
    span_ = span_of(survey_, study_);
    answer_.against = input_.truth.empty() ? Against::kGnss : Against::kReference;
    answer_.first_s = span_.first_s;
    answer_.settled_s = span_.settled_s;
    answer_.last_s = span_.last_s;
    answer_.receiver = survey_.receiver;
    answer_.imu_sigma_scale = survey_.imu_sigma_scale;
    outages_ = outages_of(survey_, span_, study_);
    thinnings_ = thinnings_of(survey_, span_, study_);
    measure();
    expect();
    return answer_;
  }

 private:
  /// Passes over the log, each with some of the branches.
  void measure() {
    std::vector<BranchesOfJob> jobs = jobs_of_study();
    parallel_for(
        jobs.size(), [&](std::size_t k) { run_job(jobs[k]); }, {}, study_.threads);
    for (const BranchesOfJob& job : jobs) {
      for (std::size_t k = 0; k < job.outages.size(); ++k) {
        add_outages(job.outages[k], job.courses[k], study_.durations_s, span_.last_s,
                    answer_.outages);
      }
      answer_.errors.insert(answer_.errors.end(), job.errors.begin(), job.errors.end());
    }
  }

  struct BranchesOfJob {
    std::vector<Outage> outages{};
    std::vector<StudiedThinning> thinnings{};
    std::vector<OutageCourse> courses{};
    std::vector<FixError> errors{};
  };

  std::vector<BranchesOfJob> jobs_of_study() const {
    std::vector<BranchesOfJob> jobs;
    for (std::size_t k = 0; k < thinnings_.size(); ++k) {
      if (k % kBranchesOfJob == 0) jobs.emplace_back();
      jobs.back().thinnings.push_back(thinnings_[k]);
    }
    std::vector<BranchPlan> plans;
    for (const Outage& outage : outages_) plans.push_back(BranchPlan::of(plans.size(), outage));
    for (const auto& pass : passes_of(plans, kBranchesOfJob)) {
      if (pass.empty()) continue;
      jobs.emplace_back();
      for (const BranchPlan& plan : pass) jobs.back().outages.push_back(outages_[plan.index]);
    }
    return jobs;
  }

  void run_job(BranchesOfJob& job) const {
    ReplayInput input = input_;
    input.solution.clear();
    input.outages = job.outages;
    input.thinnings.clear();
    for (const StudiedThinning& t : job.thinnings) input.thinnings.push_back(t.thinning);
    job.courses.resize(job.outages.size());
    ReplayObserver observer;
    observer.outage = [&job](const OutageEpoch& e) {
      job.courses[e.outage].since_s.push_back(e.since_s);
      job.courses[e.outage].error_h_m.push_back(e.error_h_m);
    };
    observer.thinned = [&](const ThinnedEpoch& e) {
      job.errors.push_back({e.t_s, job.thinnings[e.thinning].interval, size_m(e)});
    };
    replay(input, config_, observer);
  }

  double size_m(const ThinnedEpoch& e) const {
    if (study_.metric == ErrorMetric::k3d) return e.error_n_m.norm();
    return size_of_error_m(study_.metric, e.error_n_m, e.course_rad);
  }

  void expect() {
    if (thinnings_.empty()) return;
    try {
      const ExpectedErrors expected(input_, survey_, config_, study_.metric);
      std::vector<std::vector<Eigen::Vector2d>> variances(thinnings_.size());
      const bool against_fixes = answer_.against == Against::kGnss;
      const auto wanted = [this](double t_s) {
        return input_.truth.empty() || (t_s >= input_.truth_from_s && t_s <= input_.truth_to_s);
      };
      parallel_for(
          thinnings_.size(),
          [&](std::size_t k) {
            variances[k] = expected.variances_m2(thinnings_[k].thinning, against_fixes, wanted);
          },
          {}, study_.threads);
      for (std::size_t k = 0; k < thinnings_.size(); ++k) {
        for (const Eigen::Vector2d& v : variances[k]) {
          answer_.expected.push_back({thinnings_[k].interval, {v.x(), v.y()}});
        }
      }
    } catch (const Error& error) {
      answer_.not_expected = error.what();
    }
  }

  const ReplayInput& input_;
  const NavigatorConfig& config_;
  const LogStudyConfig& study_;
  const std::function<void(const ReplayResult&)>& surveyed_;
  LogSurvey survey_{};
  StudySpan span_{};
  std::vector<Outage> outages_{};
  std::vector<StudiedThinning> thinnings_{};
  LogStudy answer_{};
};

void check(const ReplayInput& input, const LogStudyConfig& study) {
  require("replay", "every_s", study.every_s, positive_to(1e6));
  require("replay", "settle_s", study.settle_s, between(0.0, 1e6));
  require("replay", "most_phases", study.most_phases, between(1.0, 1000.0));
  require("replay", "min_speed_mps", study.min_speed_mps, between(0.0, 1e3));
  if (study.durations_s.empty()) throw Error("replay: no duration of an outage is given");
  for (const double duration_s : study.durations_s) {
    require("replay", "duration_s", duration_s, positive_to(1e5));
  }
  for (const auto& path : {input.imu, input.gnss}) {
    if (std::filesystem::is_regular_file(path)) continue;
    throw Error(path.string() + ": is no file, and a study reads a log several times");
  }
}

}  // namespace

LogStudy study_log(const ReplayInput& input, const NavigatorConfig& config,
                   const LogStudyConfig& study,
                   const std::function<void(const ReplayResult&)>& surveyed) {
  check(input, study);
  return Study(input, config, study, surveyed).run();
}

}  // namespace leeway::sim
