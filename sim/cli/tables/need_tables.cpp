#include "sim/cli/tables/need_tables.hpp"

#include <algorithm>
#include <cmath>

#include "sim/cli/scene_options.hpp"
#include "sim/cli/tables/elasticity_tables.hpp"

namespace leeway::cli {
namespace {

using Outcome = sim::NeededFactor::Outcome;

std::string how_much(const sim::NeededFactor& needed) {
  if (needed.outcome == Outcome::kNotAlone) return "not alone";
  if (needed.outcome == Outcome::kAnything) return "may be anything";
  return needed.factor < 1.0 ? fmt::format("{:.3g} times better", 1.0 / needed.factor)
                             : fmt::format("may be {:.3g} times worse", needed.factor);
}

void print_factors(const sim::Inverse& inverse) {
  Table table({"<of the IMU in the scene", "<must be", "error then, m"});
  for (const sim::NeededFactor& needed : inverse.factors) {
    const bool is_hopeless = needed.outcome == Outcome::kNotAlone;
    const bool is_together = needed.what.size() > 1;
    table.add({needed.name + (is_together ? ", all of it" : ""), how_much(needed),
               number(needed.error_m, 2)},
              is_hopeless ? Tone::kDoubtful : Tone::kPlain);
  }
  table.print();
}

const sim::NeededFactor* factor_named(const sim::Inverse& inverse, const char* name) {
  const auto found = std::ranges::find(inverse.factors, name, &sim::NeededFactor::name);
  return found == inverse.factors.end() ? nullptr : &*found;
}

void print_candidates(const sim::Inverse& inverse) {
  const auto keeping = std::ranges::count_if(inverse.candidates, &sim::ImuCandidate::keeps_limit);
  fmt::print("\n{} of {} parts and classes keep the limit\n", keeping, inverse.candidates.size());
  if (keeping == 0) {
    const sim::NeededFactor* imu = factor_named(inverse, "imu");
    const double left_m =
        imu != nullptr && imu->outcome == Outcome::kNotAlone ? imu->error_m : inverse.limit_m;
    fmt::print(
        "The best of them, {}, leaves {:.3g} m; this IMU a thousand times better, {:.3g} m. "
        "Take a better receiver, a shorter interval or a larger limit.\n",
        inverse.candidates.front().name, inverse.candidates.front().error_m, left_m);
    return;
  }
  Table table({"<IMU", "<kind", "error, m"});
  for (const sim::ImuCandidate& candidate : inverse.candidates) {
    if (!candidate.keeps_limit) continue;
    table.add({candidate.name, candidate.is_class ? "class" : "part", number(candidate.error_m, 2)},
              Tone::kGood);
  }
  table.print();
}

void print_need(const AnsweredNeed& answer) {
  const sim::Scene& scene = answer.scene;
  const sim::Inverse& inverse = answer.inverse;
  fmt::print("Scene '{}' ({}), {}: a fix every {:g} s within {:g} m ({}), after {:g} s\n",
             scene.name, scene.trajectory.name, scene.imu_name, inverse.interval_s, inverse.limit_m,
             name(scene.limit.metric), scene.duration_s);
  fmt::print("This IMU's error before a fix is {:.3g} m: {}.\n\n", inverse.error_m,
             inverse.error_m <= inverse.limit_m ? "good enough" : "too much");
  print_factors(inverse);
  print_candidates(inverse);
  fmt::print("\nWhat the error depends on with this IMU at {:g} s\n", inverse.interval_s);
  print_elasticities(answer.elasticities);
}

Json factors_json(const sim::Inverse& inverse) {
  Json rows = Json::array();
  for (const sim::NeededFactor& needed : inverse.factors) {
    rows.push_back({{"specification", needed.name},
                    {"outcome", name(needed.outcome)},
                    {"factor", needed.factor},
                    {"error_m", needed.error_m},
                    {"predicted_factor", needed.predicted_factor}});
  }
  return rows;
}

Json candidates_json(const sim::Inverse& inverse) {
  Json rows = Json::array();
  for (const sim::ImuCandidate& candidate : inverse.candidates) {
    rows.push_back({{"imu", candidate.name},
                    {"kind", candidate.is_class ? "class" : "part"},
                    {"error_m", candidate.error_m},
                    {"keeps_limit", candidate.keeps_limit}});
  }
  return rows;
}

}  // namespace

void print_need_tables(const std::vector<AnsweredNeed>& answers) {
  for (const AnsweredNeed& answer : answers) {
    if (&answer != &answers.front()) fmt::print("\n");
    print_need(answer);
  }
}

Json need_json(const std::vector<AnsweredNeed>& answers) {
  Json results = Json::array();
  for (const AnsweredNeed& answer : answers) {
    const sim::Inverse& inverse = answer.inverse;
    results.push_back({{"imu", answer.scene.imu_name},
                       {"motion", answer.scene.trajectory.name},
                       {"metric", name(answer.scene.limit.metric)},
                       {"need_s", inverse.interval_s},
                       {"limit_m", inverse.limit_m},
                       {"error_m", inverse.error_m},
                       {"keeps_limit", inverse.error_m <= inverse.limit_m},
                       {"factors", factors_json(inverse)},
                       {"candidates", candidates_json(inverse)},
                       {"growth", answer.elasticities.growth},
                       {"elasticities", elasticities_json(answer.elasticities)}});
  }
  Json input = scene_json(answers.front().scene);
  for (const char* varies : {"imu_model", "bias_model", "limit_m"}) input.erase(varies);
  return answer_json("interval", std::move(input), std::move(results));
}

}  // namespace leeway::cli
