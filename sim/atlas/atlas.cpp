#include "leeway/sim/atlas/atlas.hpp"

#include <algorithm>

#include "leeway/earth/error.hpp"
#include "leeway/sim/tools/parallel.hpp"
#include "sim/atlas/scenes.hpp"
#include "sim/tools/closest_name.hpp"

namespace leeway::sim {
namespace {

void require_known(const std::string& key) {
  std::vector<std::string_view> known;
  for (const AtlasScene& scene : atlas_scenes()) known.push_back(scene.key);
  if (std::find(known.begin(), known.end(), key) != known.end()) return;
  throw Error("atlas: no scene '" + key + "': " + did_you_mean(key, known));
}

std::vector<AtlasScene> in_order(std::vector<AtlasScene> scenes) {
  std::sort(scenes.begin(), scenes.end(),
            [](const AtlasScene& a, const AtlasScene& b) { return a.place < b.place; });
  return scenes;
}

}  // namespace

AtlasVerdict verdict_of(const AtlasLimits& limits, double figure) {
  // Not a number is in no range.
  if (figure <= limits.survives) return AtlasVerdict::kSurvives;
  return figure <= limits.degrades ? AtlasVerdict::kDegrades : AtlasVerdict::kFails;
}

bool fails_silently(const AtlasLimits& limits, const AtlasCell& cell) {
  return cell.group != AtlasGroup::kNotOffered && cell.reported.empty() &&
         verdict_of(limits, cell.figure) == AtlasVerdict::kFails;
}

const std::vector<AtlasScene>& atlas_scenes() {
  static const std::vector<AtlasScene> kScenes = in_order(scenes::all());
  return kScenes;
}

std::vector<AtlasScene> atlas_scenes(const std::vector<std::string>& keys) {
  for (const std::string& key : keys) require_known(key);
  std::vector<AtlasScene> chosen;
  for (const AtlasScene& scene : atlas_scenes()) {
    const bool is_named = std::find(keys.begin(), keys.end(), scene.key) != keys.end();
    if (is_named || keys.empty()) chosen.push_back(scene);
  }
  return chosen;
}

std::vector<AtlasResult> run_atlas(const std::vector<AtlasScene>& scenes,
                                   const AtlasOptions& options, int threads,
                                   const std::function<void(double)>& progress) {
  std::vector<AtlasResult> results;
  for (const AtlasScene& scene : scenes) results.push_back({scene, {}});
  parallel_for(
      scenes.size(), [&](std::size_t k) { results[k].cells = scenes[k].run(options); },
      [&](std::size_t done) {
        if (progress) progress(static_cast<double>(done) / static_cast<double>(scenes.size()));
      },
      threads);
  return results;
}

}  // namespace leeway::sim
