#include "sim/cli/jobs/need.hpp"

#include "sim/cli/command.hpp"
#include "sim/cli/quantity.hpp"
#include "sim/cli/tables/need_tables.hpp"

namespace leeway::cli {
namespace {

void check_need(const sim::Scene& scene, double need_s) {
  const double longest_s = sim::longest_interval_s(scene);
  if (need_s > longest_s) {
    throw Error(fmt::format(
        "--need {:g} s: must be at most {:g} s, the longest that this scene can be asked for; one "
        "that goes on holds it with --at {:g}",
        need_s, longest_s, scene.gnss.settle_s + 2.0 * need_s));
  }
}

void check_limit(const sim::AllowedError& limit) {
  if (limit.share == 0.0) return;
  throw Error(fmt::format("--limit {}: --need takes a limit that does not grow: give {:g}m",
                          text_of(limit), limit.limit_m));
}

AnsweredNeed answer(const sim::Scene& scene, double need_s, sim::BiasModel class_bias) {
  sim::InverseConfig config;
  config.class_bias = class_bias;
  return {scene, sim::invert(scene, need_s, scene.limit.limit_m, config),
          sim::elasticities(scene, sim::error_track(scene), need_s)};
}

}  // namespace

CLI::Option* add_need_option(CLI::App& app, std::optional<double>& need_s) {
  return app
      .add_option(
          "--need", need_s,
          "the inverse: what of the IMU must be better, and which IMUs keep the limit, when "
          "fixes are this far apart: 60s, 5min")
      ->transform(seconds_quantity("a time between fixes, such as 60s"))
      ->type_name("TIME");
}

int answer_need(const SceneChoice& choice, double need_s, const Output& output) {
  std::vector<AnsweredNeed> answers;
  const std::vector<sim::Scene> scenes = scenes_of(choice);
  for (const sim::Scene& scene : scenes) check_need(scene, need_s);
  Progress bar("inverse");
  for (sim::Scene scene : scenes) {
    std::vector<sim::AllowedError> limits = limits_of(choice.limit.limits);
    if (limits.empty()) limits = {scene.limit.allowed()};
    for (const sim::AllowedError& limit : limits) {
      check_limit(limit);
      scene.limit.allow(limit);
      answers.push_back(answer(scene, need_s, choice.bias.value_or(sim::BiasModel::kConstant)));
      bar.show(static_cast<double>(answers.size()) /
               static_cast<double>(scenes.size() * limits.size()));
    }
  }
  show(output, need_json(answers), [&] { print_need_tables(answers); });
  return kSuccess;
}

}  // namespace leeway::cli
