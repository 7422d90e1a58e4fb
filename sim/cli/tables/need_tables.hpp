/// @file
/// What `leeway interval --need` says.
#pragma once

#include <vector>

#include "leeway/sim/analysis/elasticity.hpp"
#include "leeway/sim/analysis/inverse.hpp"
#include "sim/cli/answer.hpp"

namespace leeway::cli {

/// The inverse for one IMU and one limit.
struct AnsweredNeed {
  sim::Scene scene{};
  sim::Inverse inverse{};
  sim::Elasticities elasticities{};
};

/// @pre there is an answer.
void print_need_tables(const std::vector<AnsweredNeed>& answers);

/// By the contract of --json. @pre there is an answer.
Json need_json(const std::vector<AnsweredNeed>& answers);

}  // namespace leeway::cli
