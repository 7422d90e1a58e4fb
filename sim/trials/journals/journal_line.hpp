/// @file
/// A finished trial as text, in which every number is exact: a line of a journal, and how trials
/// travel between processes.
#pragma once

#include <string>

#include "leeway/sim/trials/trial.hpp"

namespace leeway::sim {

/// The text, without an end of line. Scores that are the same to the bit give the same.
std::string line_of(const TrialScore& score);

/// @returns whether the text is one of line_of(), undamaged; only then the score is whole.
bool parse_line(std::string line, TrialScore& score);

}  // namespace leeway::sim
