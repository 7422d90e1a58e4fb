#include "sim/cli/command.hpp"
#include "sim/cli/files/output_files.hpp"
#include "sim/cli/options.hpp"
#include "sim/cli/tables/atlas_tables.hpp"
#include "sim/cli/tables/fault_tables.hpp"
#include "sim/cli/tables/mismatch_tables.hpp"

namespace leeway::cli {
namespace {

struct AtlasChoice {
  std::vector<std::string> scenes{};
  bool list{false};
  bool faults{false};
  bool mismatch{false};
  int mismatch_trials{0};
  sim::AtlasOptions atlas{};
  int threads{0};
  std::filesystem::path csv{};
  std::filesystem::path markdown{};
  std::filesystem::path expected{};
  std::filesystem::path page{};
  Output output{};
};

std::vector<sim::AtlasResult> run_scenes(const AtlasChoice& options,
                                         const sim::AtlasOptions& atlas) {
  Progress progress("atlas");
  return sim::run_atlas(sim::atlas_scenes(options.scenes), atlas, options.threads,
                        std::ref(progress));
}

/// Both forms anew: what later runs are compared with, after the next build.
int write_expected(const AtlasChoice& options) {
  std::string csv;
  for (const bool brief : {false, true}) {
    const sim::AtlasOptions atlas{.brief = brief};
    csv += sim::atlas_csv(run_scenes(options, atlas), atlas, !brief);
  }
  write_file(options.expected, csv);
  return kSuccess;
}

/// The matrix of faults in place of the scenes.
int run_faults(const AtlasChoice& options) {
  constexpr double kBearableShare = 0.02;
  const sim::FaultMatrix matrix = [&options] {
    Progress progress("faults");
    return sim::run_fault_matrix(options.atlas.brief, options.threads, std::ref(progress));
  }();
  show(
      options.output,
      answer_json("atlas", {{"faults", true}, {"short", options.atlas.brief}}, faults_json(matrix)),
      [&] { print_faults(matrix); });
  if (!options.page.empty()) write_file(options.page, faults_markdown(matrix));
  return summary_of(matrix).silent_share() > kBearableShare ? kNoAnswer : kSuccess;
}

/// The default navigator with IMUs that it does not know, in place of the scenes.
int run_mismatch(const AtlasChoice& options) {
  const bool brief = options.atlas.brief;
  sim::MismatchOptions mismatch{.brief = brief, .threads = options.threads};
  if (brief) mismatch.trials = 2;
  if (options.mismatch_trials > 0) mismatch.trials = options.mismatch_trials;
  const sim::MismatchCampaign campaign = [&mismatch] {
    Progress progress("mismatch");
    return sim::run_mismatch(mismatch, std::ref(progress));
  }();
  show(options.output,
       answer_json("atlas", {{"mismatch", true}, {"short", brief}, {"trials", mismatch.trials}},
                   mismatch_json(campaign)),
       [&] { print_mismatch(campaign); });
  if (!options.page.empty()) write_file(options.page, mismatch_markdown(campaign));
  const sim::MismatchSummary summary = summary_of(campaign);
  return summary.lost + summary.outside > 0 ? kNoAnswer : kSuccess;
}

int run(const AtlasChoice& options) {
  if (options.list) {
    print_atlas_list();
    return kSuccess;
  }
  if (!options.page.empty() && !options.faults && !options.mismatch) {
    throw Error("--write: a page of --faults or of --mismatch: add one of them");
  }
  if (options.faults) return run_faults(options);
  if (options.mismatch) return run_mismatch(options);
  if (!options.expected.empty()) return write_expected(options);
  const auto results = run_scenes(options, options.atlas);
  const auto surprises = sim::atlas_surprises(results, options.atlas);
  const Json answer =
      answer_json("atlas", {{"scenes", options.scenes}, {"short", options.atlas.brief}},
                  atlas_json(results, surprises));
  show(options.output, answer, [&] { print_atlas(results, surprises); });
  if (!options.csv.empty()) write_file(options.csv, sim::atlas_csv(results, options.atlas));
  if (!options.markdown.empty()) write_file(options.markdown, atlas_markdown(results));
  return surprises.empty() && !any_silent(results) ? kSuccess : kNoAnswer;
}

void add_options(CLI::App& app, AtlasChoice& options) {
  CLI::Option* scene =
      app.add_option("--scene", options.scenes, "only these scenes; --list names all")
          ->type_name("KEY")
          ->delimiter(',');
  app.add_flag("--list", options.list, "name the scenes and run nothing");
  CLI::Option* brief =
      app.add_flag("--short", options.atlas.brief, "fewer trials and shorter drives, for tests");
  CLI::Option* faults = app.add_flag("--faults", options.faults,
                                     "the matrix of faults by vehicles in place of the scenes");
  faults->excludes(scene);
  CLI::Option* mismatch =
      app.add_flag("--mismatch", options.mismatch,
                   "the default navigator with IMUs that it does not know in place of the scenes");
  mismatch->excludes(scene)->excludes(faults);
  app.add_option("--trials", options.mismatch_trials, "of each cell of --mismatch")
      ->check(in_range(1, 1000000))
      ->type_name("N")
      ->needs(mismatch);
  add_output_file(app, "--write", options.page, "write what --faults or --mismatch finds as a page")
      ->excludes(scene);
  add_threads_option(app, options.threads);
  add_output_options(app, options.output);
  add_output_file(app, "--csv", options.csv, "write a row for each cell as CSV");
  add_output_file(app, "--markdown", options.markdown,
                  "write matrix and cells as docs/atlas.md has them");
  add_output_file(app, "--write-expected", options.expected,
                  "run both forms of all scenes and write what is found: sim/atlas/expected.csv")
      ->excludes(scene)
      ->excludes(brief);
}

const Command<AtlasChoice> kAtlas{
    "atlas", "Scenes in which methods break, run against every variant, with expected verdicts",
    "Exits with 2 when a cell is not as expected, or a variant of the library fails and no\n"
    "detector says so; with --faults, when more than 2 % of the cells are silent; with\n"
    "--mismatch, when a trial is lost, or a claim is off and health does not name the factor.\n"
    "Examples:\n"
    "  leeway atlas --scene parked-rtk,wrong-heading --csv cells.csv\n"
    "  leeway atlas --faults --short\n"
    "  leeway atlas --mismatch --short --trials 3",
    add_options, run};

}  // namespace
}  // namespace leeway::cli
