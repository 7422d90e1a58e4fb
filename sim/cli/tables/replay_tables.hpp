/// @file
/// What `leeway replay` says of logs: as tables, as JSON, as the series of a page.
#pragma once

#include "leeway/sim/replay/study_answer.hpp"
#include "sim/cli/answer.hpp"

namespace leeway::cli {

/// A log, and what came of it.
struct NamedStudy {
  std::string name{};
  std::filesystem::path imu{};
  std::filesystem::path gnss{};
  sim::LogStudy study{};
  sim::StudyAnswer answer{};
};

struct ReplayAnswer {
  std::vector<NamedStudy> logs{};
  sim::StudyAnswer pooled{};
};

/// On stdout.
void print_tables(const ReplayAnswer& answer, const sim::LogStudyConfig& study);

/// {logs: [..], pooled: {..}, intervals_over_logs: [..]}
Json replay_json(const ReplayAnswer& answer, const sim::LogStudyConfig& study);

}  // namespace leeway::cli
