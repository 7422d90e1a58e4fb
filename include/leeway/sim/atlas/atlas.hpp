/// @file
/// The failure atlas: scenes that are each built to break a method, run against every way of
/// running the filter, and what became of it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "leeway/earth/names.hpp"

namespace leeway::sim {

/// Verdict on a figure.
enum class AtlasVerdict { kSurvives, kDegrades, kFails };
constexpr auto names(AtlasVerdict) { return std::array{"survives", "degrades", "fails"}; }

/// Groups of variants: the columns of the matrix of all scenes.
enum class AtlasGroup {
  kNavigator,
  kEkf,
  kDoubleKernel,  ///< BasicEkf in double precision
  kFloatKernel,   ///< and in single
  kInvariant,
  kReset,
  kStrapdown,   ///< mechanizations, without a filter
  kInput,       ///< what stands before any filter: configuration, readers, time
  kNotOffered,  ///< a method that the library does not have: what the scene shows failing
};
constexpr auto names(AtlasGroup) {
  return std::array{"Navigator", "Ekf",       "kernels, double", "kernels, float", "invariant EKF",
                    "reset",     "strapdown", "input",           "not offered"};
}

/// One variant under one condition of a scene.
struct AtlasCell {
  AtlasGroup group{};
  std::string variant{};    ///< "symmetric/joseph/float". No comma, no quote; as condition
  std::string condition{};  ///< "60 s"; empty where the scene has but one
  double figure{};          ///< in the scene's unit; not finite: there is none, a failure
  std::string reported{};   ///< which detectors of the library say so; empty: nobody says anything
};

/// Limits of a figure, which is the larger the worse.
struct AtlasLimits {
  double survives{};     ///< up to here
  double degrades{};     ///< up to here; beyond, it fails
  std::string reason{};  ///< of both, in a sentence
};

/// Options of a run.
struct AtlasOptions {
  bool brief{false};  ///< fewer trials, shorter drives: for tests
};

/// A scene that is built to break a method.
struct AtlasScene {
  int place{};           ///< scenes and their pages are in the order of this number
  std::string key{};     ///< "parked-rtk": of the command line, and the page docs/atlas/KEY.md
  std::string title{};   ///< "Parked with RTK fixes"
  std::string figure{};  ///< what the figure is: "horizontal error over the claimed sigma"
  std::string unit{};    ///< "m"; "" for ratios
  AtlasLimits limits{};
  /// Same options, same cells. Seeds 1 to N. Safe to call from any thread.
  std::function<std::vector<AtlasCell>(const AtlasOptions&)> run{};
};

/// The verdict on a figure; kFails for one that is not a number.
AtlasVerdict verdict_of(const AtlasLimits& limits, double figure);

/// Whether a variant that the library offers fails, and no detector says so.
bool fails_silently(const AtlasLimits& limits, const AtlasCell& cell);

/// All scenes, in the order of their places.
const std::vector<AtlasScene>& atlas_scenes();

/// The scenes of these keys, in the order of atlas_scenes(); all for none.
/// @throws Error for an unknown key: the nearest one, and all there are.
std::vector<AtlasScene> atlas_scenes(const std::vector<std::string>& keys);

/// The cells of a scene.
struct AtlasResult {
  AtlasScene scene{};
  std::vector<AtlasCell> cells{};
};

/// The results of the scenes, in their order. The same bits on any number of threads.
/// @param threads  0: as many as there are processors
std::vector<AtlasResult> run_atlas(const std::vector<AtlasScene>& scenes,
                                   const AtlasOptions& options, int threads = 0,
                                   const std::function<void(double fraction)>& progress = {});

}  // namespace leeway::sim
