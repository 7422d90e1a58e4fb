/// @file
/// What the outages of a scene cost, as commands say it.
#pragma once

#include <span>
#include <string>

#include "leeway/sim/analysis/coast.hpp"
#include "sim/cli/json.hpp"

namespace leeway::cli {

struct NamedCoasts {
  std::string imu{};
  std::span<const sim::Coast> coasts{};
};

void print_coasts(const std::vector<NamedCoasts>& of_imus);

Json coast_json(const sim::Coast& coast);

}  // namespace leeway::cli
