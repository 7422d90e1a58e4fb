/// @file
/// What leeway atlas writes.
#pragma once

#include "leeway/sim/atlas/atlas_expected.hpp"
#include "sim/cli/answer.hpp"

namespace leeway::cli {

/// Key, title and figure of every scene.
void print_atlas_list();

/// A table for each scene, variants by conditions; then the offered variants that fail without a
/// word, and the cells that are not as expected.
void print_atlas(const std::vector<sim::AtlasResult>& results,
                 const std::vector<sim::AtlasSurprise>& surprises);

/// @returns whether an offered variant fails without a word
bool any_silent(const std::vector<sim::AtlasResult>& results);

Json atlas_json(const std::vector<sim::AtlasResult>& results,
                const std::vector<sim::AtlasSurprise>& surprises);

/// docs/atlas.md: the matrix of scenes by groups of variants, then every scene's cells.
std::string atlas_markdown(const std::vector<sim::AtlasResult>& results);

}  // namespace leeway::cli
