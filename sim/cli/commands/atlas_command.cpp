#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "leeway/sim/atlas/atlas.hpp"
#include "leeway/sim/atlas/atlas_expected.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/output.hpp"
#include "sim/cli/pages/atlas_report.hpp"
#include "sim/cli/pages/report.hpp"

namespace leeway::cli {
namespace {

struct AtlasCommand {
  std::vector<std::string> scenes{};
  bool list{false};
  sim::AtlasOptions atlas{};
  int threads{0};
  bool json{false};
  std::filesystem::path csv{};
  std::filesystem::path markdown{};
  std::filesystem::path expected{};
  std::filesystem::path report{};
};

std::vector<sim::AtlasResult> run_scenes(const AtlasCommand& options,
                                         const sim::AtlasOptions& atlas) {
  Progress progress("atlas");
  return sim::run_atlas(sim::atlas_scenes(options.scenes), atlas, options.threads,
                        [&progress](double fraction) { progress.show(fraction); });
}

/// Both forms anew: what later runs are compared with, after the next build.
int write_expected(const AtlasCommand& options) {
  std::string csv;
  for (const bool brief : {false, true}) {
    const sim::AtlasOptions atlas{.brief = brief};
    csv += sim::atlas_csv(run_scenes(options, atlas), atlas, !brief);
  }
  write_file(options.expected, csv);
  return kSuccess;
}

int run(const AtlasCommand& options) {
  if (options.list) {
    print_atlas_list();
    return kSuccess;
  }
  if (!options.expected.empty()) return write_expected(options);
  const auto results = run_scenes(options, options.atlas);
  const auto surprises = sim::atlas_surprises(results, options.atlas);
  const Json answer =
      answer_json("atlas", {{"scenes", options.scenes}, {"short", options.atlas.brief}},
                  atlas_json(results, surprises));
  if (options.json) {
    print_json(answer);
  } else {
    print_atlas(results);
    print_atlas_findings(results, surprises);
  }
  if (!options.csv.empty()) write_file(options.csv, sim::atlas_csv(results, options.atlas));
  if (!options.markdown.empty()) write_file(options.markdown, atlas_markdown(results));
  write_report(options.report, answer);
  return surprises.empty() && !any_silent(results) ? kSuccess : kNoAnswer;
}

}  // namespace

void add_atlas_command(CLI::App& program, int& exit_code) {
  CLI::App* app = program.add_subcommand(
      "atlas", "Scenes in which methods break, run against every variant, with expected verdicts");
  const auto options = std::make_shared<AtlasCommand>();
  CLI::Option* scene =
      app->add_option("--scene", options->scenes, "only these scenes; --list names all")
          ->type_name("KEY")
          ->delimiter(',');
  app->add_flag("--list", options->list, "name the scenes and run nothing");
  CLI::Option* brief =
      app->add_flag("--short", options->atlas.brief, "fewer trials and shorter drives, for tests");
  app->add_option("--threads", options->threads, "0: all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app->add_flag("--json", options->json, "one JSON object on standard output instead of tables");
  add_report_option(*app, options->report);
  app->add_option("--csv", options->csv, "write a row for each cell as CSV")->type_name("FILE");
  app->add_option("--markdown", options->markdown,
                  "write matrix and cells as docs/atlas.md has them")
      ->type_name("FILE");
  app->add_option("--write-expected", options->expected,
                  "run both forms of all scenes and write what is found: sim/atlas/expected.csv")
      ->type_name("FILE")
      ->excludes(scene)
      ->excludes(brief);
  app->footer(
      "Exits with 2 when a cell is not as expected, or a variant of the library fails and no\n"
      "detector says so.\n"
      "Example:\n"
      "  leeway atlas --scene parked-rtk,wrong-heading --csv cells.csv");
  app->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace leeway::cli
