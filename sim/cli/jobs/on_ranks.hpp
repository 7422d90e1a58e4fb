/// @file
/// How a command runs on all processes that mpirun or srun started.
#pragma once

#include <functional>

#include "leeway/sim/tools/ranks.hpp"

namespace leeway::cli {

/// The exit code of a command that all ranks run together; the first alone shows the answer. Where
/// there are several ranks, all end with the first error, and the first rank says why.
/// @throws what the command throws, for a process alone
int on_ranks(const std::function<int(const sim::Ranks&)>& command);

}  // namespace leeway::cli
