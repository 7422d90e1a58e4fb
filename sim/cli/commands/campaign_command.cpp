#include <thread>

#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/sim/tools/parallel.hpp"
#include "leeway/sim/trials/campaign.hpp"
#include "leeway/sim/trials/trial_journal.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/jobs/on_ranks.hpp"
#include "sim/cli/options.hpp"
#include "sim/cli/pages/series_table.hpp"
#include "sim/cli/scene_options.hpp"

namespace leeway::cli {
namespace {

struct CampaignChoice {
  SceneChoice scene{};
  sim::CampaignOptions campaign{};
  std::vector<std::string> journals{};
  Output output{};
};

/// Pairs of the first and the last of seeds that follow each other.
Json seeds_json(const std::vector<sim::SeedRange>& ranges) {
  Json json = Json::array();
  for (const sim::SeedRange& r : ranges) json.push_back({r.first, r.first + r.count - 1});
  return json;
}

Json results_json(const sim::CampaignResult& r) {
  return {{"trials", r.trials},
          {"epochs", r.epochs},
          {"rms_horizontal_m", r.rms_horizontal_m},
          {"sigma_horizontal_m", r.sigma_horizontal_m},
          {"rms_over_sigma", r.rms_over_sigma},
          {"rms_ned_m", {r.rms_n_m[0], r.rms_n_m[1], r.rms_n_m[2]}},
          {"sigma_ned_m", {r.sigma_n_m[0], r.sigma_n_m[1], r.sigma_n_m[2]}},
          {"nees", r.mean_nees},
          {"nees_band", {r.nees_low, r.nees_high}},
          {"nis_over_dof", r.nis_over_dof},
          {"beyond_r95", r.beyond_r95},
          {"fixes_fused", r.fused},
          {"fixes_gated", r.gated},
          {"trials_diverged", r.diverged},
          {"trials_not_finite", r.not_finite},
          {"worst_horizontal_m", r.worst_horizontal_m},
          {"worst_seed", r.worst_seed},
          {"seeds_missing", seeds_json(r.missing)}};
}

/// Seeds as people write them: "3, 7 to 9", of many the first few.
std::string seeds_text(const std::vector<sim::SeedRange>& ranges) {
  constexpr std::size_t kMostShown = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(ranges.size(), kMostShown); ++i) {
    const auto& [first, count] = ranges[i];
    text += (i > 0 ? ", " : "") + std::to_string(first);
    if (count > 1) text += " to " + std::to_string(first + count - 1);
  }
  return ranges.size() > kMostShown ? text + ", .." : text;
}

void print_errors(const sim::CampaignResult& r) {
  Table table({"<error before a fix", "RMS, m", "claimed sigma, m", "RMS / sigma"});
  const auto add = [&table](const char* axis, double rms_m, double sigma_m) {
    table.add({axis, number(rms_m, 3), number(sigma_m, 3), number(rms_m / sigma_m, 3)});
  };
  add("horizontal", r.rms_horizontal_m, r.sigma_horizontal_m);
  add("north", r.rms_n_m[0], r.sigma_n_m[0]);
  add("east", r.rms_n_m[1], r.sigma_n_m[1]);
  add("down", r.rms_n_m[2], r.sigma_n_m[2]);
  table.print();
}

/// Scale factors, misalignments, g-sensitivity: what no filter here has states for.
bool errs_beyond_biases(const ImuErrorModel& imu) {
  const auto has_own = [](const TriadErrorModel& triad) {
    return triad.scale_sigma > 0.0 || triad.misalignment_sigma_rad > 0.0 ||
           !triad.M.isIdentity(0.0);
  };
  return has_own(imu.accelerometer) || has_own(imu.gyro) || imu.G_g_sigma_radps_per_mps2 > 0.0 ||
         !imu.G_g_radps_per_mps2.isZero(0.0);
}

void print_consistency(const sim::Scene& scene, const sim::CampaignResult& r) {
  Table table({"<consistency", "found", "<of an honest filter"});
  table.add({"NEES of 15 states", number(r.mean_nees, 2),
             fmt::format("{:.2f} to {:.2f} (95 %)", r.nees_low, r.nees_high)},
            r.mean_nees >= r.nees_low && r.mean_nees <= r.nees_high ? Tone::kGood : Tone::kBad);
  table.add({"NIS of fused fixes / degrees of freedom", number(r.nis_over_dof, 3), "1"});
  table.add({"errors beyond the claimed R95 radius, %", number(100.0 * r.beyond_r95, 2), "5"});
  table.print();
  if (!errs_beyond_biases(scene.imu)) return;
  fmt::print(
      "\nThe IMU has scale factors, misalignments or g-sensitivity. As far as they act like a\n"
      "bias the filter takes them for one; the NEES compares that with the bias alone, and is\n"
      "the larger for it.\n");
}

void print_tables(const sim::Scene& scene, const sim::CampaignResult& r) {
  fmt::print("Scene '{}': {} s, IMU {} at {} Hz, fixes every {} s\n", scene.name, scene.duration_s,
             scene.imu_name, scene.imu_rate_hz, scene.gnss.interval_s);
  fmt::print("{} trials, seeds {} to {}{}, {} scored epochs\n\n", r.trials, scene.first_seed,
             scene.first_seed + static_cast<std::uint64_t>(scene.trials) - 1,
             r.missing.empty() ? "" : " without " + seeds_text(r.missing), r.epochs);
  print_errors(r);
  fmt::print("\n");
  print_consistency(scene, r);
  fmt::print("\nFixes: {} fused, {} refused by the gate\n", r.fused, r.gated);
  fmt::print("Largest error: {} m, of seed {}\n", number(r.worst_horizontal_m, 2), r.worst_seed);
  fmt::print("Diverged: {} trials, of which {} not finite and left out of the figures\n",
             r.diverged, r.not_finite);
}

/// What was computed now, and how fast.
void print_speed(const sim::Scene& scene, const sim::CampaignResult& r, int cores,
                 double elapsed_s) {
  if (r.repeated > 0) fmt::print("Lines of journals that repeat a trial: {}\n", r.repeated);
  const std::int64_t run = r.trials - r.resumed;
  if (run == 0) {
    fmt::print("Computed: 0 trials, {} from the journal\n", r.resumed);
    return;
  }
  const auto steps = static_cast<double>(
      sim::increment_count(scene.trajectory, scene.imu_rate_hz, scene.duration_s));
  fmt::print(
      "Computed: {} trials in {:.1f} s, {} from the journal; {:.2f} million filter steps "
      "per second on each of {} cores\n",
      run, elapsed_s, r.resumed, 1e-6 * static_cast<double>(run) * steps / elapsed_s / cores,
      cores);
}

int cores_of(const CampaignChoice& options, const sim::Ranks& ranks) {
  if (options.campaign.threads > 0) return ranks.count() * options.campaign.threads;
  if (ranks.count() > 1) return ranks.count();
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

/// Of the scene's trials, the first 100 of them; one that is no longer finite ends early.
std::vector<std::vector<sim::TrialEpoch>> epochs_of(const sim::Scene& scene, int threads) {
  constexpr int kMostTrials = 100;
  const sim::TrialPlan plan(scene, {}, threads);
  std::vector<std::vector<sim::TrialEpoch>> epochs(
      static_cast<std::size_t>(std::min(scene.trials, kMostTrials)));
  Progress bar("fan");
  sim::parallel_for(
      epochs.size(),
      [&](std::size_t k) {
        sim::run_trial(plan, scene.first_seed + k,
                       [&epochs, k](const sim::TrialEpoch& e) { epochs[k].push_back(e); });
      },
      [&](std::size_t done) {
        bar.show(static_cast<double>(done) / static_cast<double>(epochs.size()));
      },
      threads);
  return epochs;
}

/// Between the neighbours in order.
double percentile_of(std::vector<double>& values, double fraction) {
  std::sort(values.begin(), values.end());
  const double at = fraction * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], at - static_cast<double>(below));
}

/// A table fan: percentiles of the horizontal error before each fix, and the median of what the
/// trials claim.
Json fan_json(const sim::Scene& scene, int threads) {
  const std::vector<std::vector<sim::TrialEpoch>> trials = epochs_of(scene, threads);
  SeriesTable fan(
      {"t_s", "p2_5_m", "p25_m", "p50_m", "p75_m", "p95_m", "p97_5_m", "claimed_r95_m"});
  for (std::size_t i = 0;; ++i) {
    std::vector<double> row(1);
    std::vector<double> errors_m;
    std::vector<double> claims_m;
    for (const auto& trial : trials) {
      if (i >= trial.size()) continue;
      row[0] = trial[i].t_s;
      errors_m.push_back(trial[i].error_h_m);
      claims_m.push_back(trial[i].claimed_r95_m);
    }
    if (errors_m.empty()) return {{"fan", fan.json()}};
    for (const double fraction : {0.025, 0.25, 0.5, 0.75, 0.95, 0.975}) {
      row.push_back(percentile_of(errors_m, fraction));
    }
    row.push_back(percentile_of(claims_m, 0.5));
    fan.add(row);
  }
}

sim::CampaignResult result_of(const sim::Scene& scene, const CampaignChoice& choice,
                              const sim::Ranks& ranks) {
  sim::CampaignOptions options = choice.campaign;
  options.journals.assign(choice.journals.begin(), choice.journals.end());
  Progress bar("campaign");
  options.progress = [&bar](const auto& done) { bar.show(done.fraction, done.remaining_s); };
  try {
    return sim::campaign(scene, options, ranks);
  } catch (const sim::JournalFailure& error) {
    throw WriteFailure(error.what());
  }
}

/// What is odd about the journals, and what to do.
void note_journals(const sim::Scene& scene, const CampaignChoice& choice,
                   const sim::CampaignResult& r) {
  const bool merges_only = choice.campaign.merge_only;
  for (const sim::JournalDamage& d : r.damaged) {
    note(fmt::format("{}:{}: damaged{}; its trial {}", d.path.string(), d.first_line,
                     d.lines > 1 ? fmt::format(", and {} more lines", d.lines - 1) : "",
                     merges_only ? "is missing, unless another line has it"
                                 : "was run again, unless another line has it"));
  }
  if (r.missing.empty()) return;
  note(
      fmt::format("{} of {} trials are missing, seeds {}: run their jobs again, or this command "
                  "without --merge-only",
                  scene.trials - r.trials, scene.trials, seeds_text(r.missing)));
}

int run_on(const CampaignChoice& options, const sim::Ranks& ranks) {
  using Clock = std::chrono::steady_clock;
  const sim::Scene scene = scene_of(options.scene);
  const auto start = Clock::now();
  const sim::CampaignResult result = result_of(scene, options, ranks);
  const int exit_code = result.epochs > 0 && result.missing.empty() ? kSuccess : kNoAnswer;
  if (!ranks.is_first()) return exit_code;
  note_journals(scene, options, result);
  Json input = scene_json(scene);
  if (options.campaign.score_last_s) input["score_last_s"] = *options.campaign.score_last_s;
  const auto print = [&] {
    print_tables(scene, result);
    print_speed(scene, result, cores_of(options, ranks),
                std::chrono::duration<double>(Clock::now() - start).count());
  };
  show(options.output, answer_json("campaign", std::move(input), results_json(result)), print, [&] {
    return options.campaign.merge_only ? Json::object() : fan_json(scene, options.campaign.threads);
  });
  return exit_code;
}

int run(const CampaignChoice& options) {
  return on_ranks([&options](const sim::Ranks& ranks) { return run_on(options, ranks); });
}

void add_options(CLI::App& app, CampaignChoice& options) {
  add_scene_options(app, options.scene);
  add_trial_options(app, options.scene, 10'000'000, "in place of the scene's");
  sim::CampaignOptions& c = options.campaign;
  add_threads_option(app, c.threads, "of this process, or of each rank under mpirun or srun; ");
  CLI::Option* journals =
      app.add_option("--journal", options.journals,
                     "keep finished trials here, and do not run again those that are; several, "
                     "with commas or spaces, are of separate jobs: new trials go to the first")
          ->type_name("FILE")
          ->delimiter(',');
  app.add_flag("--merge-only", c.merge_only,
               "run nothing: answer from the trials in the journals, and name the missing seeds")
      ->needs(journals);
  app.add_option("--score-last-s", c.score_last_s,
                 "score fixes this close to the scene's end, s (default: as the scene's limit)")
      ->check(positive());
  add_output_options(app, options.output);
}

const Command<CampaignChoice> kCampaign{
    "campaign", "Whether the filter errs as much as it claims: Monte Carlo trials of a scene",
    "Results are the same to the bit on any number of threads and ranks.\n"
    "Examples:\n"
    "  leeway campaign --scene car.toml --trials 1000 --journal car.journal\n"
    "  mpirun -n 4 leeway campaign --scene car.toml --trials 1000 --journal car.journal\n"
    "  leeway campaign --scene car.toml --trials 1000 --journal job-*.journal --merge-only",
    add_options, run};

}  // namespace
}  // namespace leeway::cli
