#include "sim/cli/limit_options.hpp"

#include <spdlog/fmt/ranges.h>

#include "sim/cli/options.hpp"

namespace leeway::cli {
namespace {

std::string preset_list() {
  std::string list;
  for (const sim::LimitPreset& preset : sim::limit_presets()) {
    list += fmt::format("{:<14}{:<9}{:<12}{}\n", preset.name, name(preset.metric),
                        sim::text_of(preset.allowed), preset.source);
  }
  list.pop_back();
  return list;
}

/// Refuses what the function throws at.
template <class F>
CLI::Validator accepted_by(F&& f) {
  return {[f](std::string& text) {
            try {
              f(text);
            } catch (const Error& error) {
              return std::string(error.what());
            }
            return std::string();
          },
          ""};
}

}  // namespace

void add_limit_options(CLI::App& app, LimitChoice& choice) {
  CLI::Option* metric = app.add_option("--metric", choice.metric, "how an error is measured")
                            ->transform(named<ErrorMetric>());
  CLI::Option* limit =
      app.add_option("--limit", choice.limits,
                     "largest error, m, and what it may grow by with the distance since the last "
                     "fix: 10, 10m, 5m+5%; several with commas")
          ->check(accepted_by([](const std::string& text) { sim::allowed_error(text); }))
          ->type_name("LIMIT")
          ->delimiter(',');
  const auto set_preset = [&choice](const std::string& wanted) {
    if (wanted == "list") throw CLI::CallForVersion(preset_list(), 0);
    try {
      choice.preset = sim::limit_preset(wanted).name;
    } catch (const Error& error) {
      throw CLI::ValidationError("--preset", error.what());
    }
  };
  app.add_option_function<std::string>("--preset", set_preset,
                                       "metric and limit of a published document; list: which "
                                       "there are")
      ->type_name("NAME")
      ->excludes(metric)
      ->excludes(limit);
}

std::vector<sim::AllowedError> limits_of(const std::vector<std::string>& texts) {
  std::vector<sim::AllowedError> limits;
  for (const std::string& text : texts) limits.push_back(sim::allowed_error(text));
  return limits;
}

void change_limit(const LimitChoice& choice, sim::ErrorLimit& limit) {
  if (!choice.preset.empty()) return sim::apply_preset(limit, choice.preset);
  if (choice.metric || !choice.limits.empty()) limit.preset.clear();
  limit.metric = choice.metric.value_or(limit.metric);
  if (!choice.limits.empty()) limit.allow(sim::allowed_error(choice.limits.front()));
}

std::string words_of(const sim::AllowedError& allowed) {
  const std::string metres = fmt::format("{:g} m", allowed.limit_m);
  return allowed.share == 0.0 ? metres : fmt::format("{} + {:g} %", metres, 100.0 * allowed.share);
}

std::string words_of(ErrorMetric metric) {
  const char* what = metric == ErrorMetric::kVertical95 ? "error of the height"
                     : metric == ErrorMetric::kCross95  ? "error across the track"
                     : metric == ErrorMetric::kAlong95  ? "error along the track"
                     : metric == ErrorMetric::k3d       ? "error in space"
                                                        : "horizontal error";
  return fmt::format("{} ({})", what, name(metric));
}

std::string preset_line(const sim::ErrorLimit& limit) {
  if (limit.preset.empty()) return {};
  return fmt::format("Limit {}: {}\n", limit.preset, sim::limit_preset(limit.preset).source);
}

Json limit_json(const sim::AllowedError& allowed) {
  return {{"limit", sim::text_of(allowed)}, {"limit_m", allowed.limit_m}, {"share", allowed.share}};
}

Json limit_json(const sim::ErrorLimit& limit) {
  Json json = limit_json(limit.allowed());
  const bool has_preset = !limit.preset.empty();
  json["metric"] = name(limit.metric);
  json["preset"] = has_preset ? Json(limit.preset) : Json();
  json["limit_source"] = has_preset ? Json(sim::limit_preset(limit.preset).source) : Json();
  return json;
}

}  // namespace leeway::cli
