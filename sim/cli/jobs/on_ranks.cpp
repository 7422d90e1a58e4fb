#include "sim/cli/jobs/on_ranks.hpp"

#include <cstdio>
#include <exception>

#include "leeway/earth/error.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/output.hpp"

namespace leeway::cli {
namespace {

int exit_code_of(const std::exception& error) {
  if (const auto* other = dynamic_cast<const sim::RankFailure*>(&error)) return other->exit_code;
  const bool is_unusable = dynamic_cast<const Error*>(&error) != nullptr;
  return is_unusable && dynamic_cast<const WriteFailure*>(&error) == nullptr ? kUnusable : kFailure;
}

}  // namespace

int on_ranks(const std::function<int(const sim::Ranks&)>& command) {
  const sim::Ranks ranks;
  try {
    return command(ranks);
  } catch (const std::exception& error) {
    if (ranks.count() == 1) throw;
    if (ranks.is_first()) {
      std::fflush(stdout);
      fmt::print(stderr, "leeway: {}\n", error.what());
    }
    ranks.stop(error.what(), exit_code_of(error));
  }
}

}  // namespace leeway::cli
