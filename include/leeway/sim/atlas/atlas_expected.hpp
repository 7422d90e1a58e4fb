/// @file
/// What the atlas is expected to find: committed, so that a change of any verdict is seen.
#pragma once

#include <string>
#include <vector>

#include "leeway/sim/atlas/atlas.hpp"

namespace leeway::sim {

/// A cell that is not as expected: what was found and what should have been, in words.
struct AtlasSurprise {
  std::string scene{};
  std::string variant{};
  std::string condition{};
  std::string expected{};  ///< "fails, 8.1e+03 m, reported: NIS high"; "no such cell"
  std::string found{};
};

/// Greatest factor between a figure and the expected one. Other compilers and processors round
/// otherwise; that moves a figure where rounding is what a scene shows.
inline constexpr double kAtlasFigureFactor = 1.25;

/// Cells of which verdict or detectors differ from the committed ones, or figures by more than the
/// factor. Figures far below what survives and far above what fails count as such, not by value:
/// the first are rounding, and the second chaos. Expected cells of these scenes that are missing,
/// too.
std::vector<AtlasSurprise> atlas_surprises(const std::vector<AtlasResult>& results,
                                           const AtlasOptions& options);

/// The cells as rows of sim/atlas/expected.csv, with its header:
/// form,scene,variant,condition,verdict,figure,reported. Form: whole or short.
std::string atlas_csv(const std::vector<AtlasResult>& results, const AtlasOptions& options,
                      bool with_header = true);

}  // namespace leeway::sim
