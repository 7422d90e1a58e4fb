/// @file
/// GNSS outages: where they are, what they cost, and what many of them cost together.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "leeway/earth/fields.hpp"

namespace leeway::sim {

/// A GNSS outage: fixes with start < t <= start + duration are withheld, in s of the log or scene.
struct Outage {
  double start_s{};
  double duration_s{};

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"start_s", c.start_s}, Field{"duration_s", c.duration_s, kPositive});
  }
};

/// Outages of a JSON file, [{"start_s": .., "duration_s": ..}, ..], in s.
/// @throws Error naming file, entry and what is wrong.
std::vector<Outage> read_outages(const std::filesystem::path& path);

/// What the error at the end of an outage was measured against.
enum class Against { kNothing, kReference, kGnss };

/// What an outage cost.
struct OutageResult {
  Outage outage{};
  Against against{Against::kNothing};  ///< kNothing: no solution, or nothing to compare with
  double end_error_h_m{};
  double end_error_v_m{};
  double max_error_h_m{};  ///< over the withheld epochs and the end
  double end_sigma_h_m{};  ///< the filter's own sqrt(P_NN + P_EE) at the end
};

/// Errors of all outages of one duration.
struct OutageSummary {
  double duration_s{};
  std::int64_t count{0};     ///< with something to compare with
  std::int64_t unscored{0};  ///< without
  double rms_end_h_m{};
  double median_end_h_m{};
  double max_end_h_m{};
  double rms_end_v_m{};
  double rms_over_sigma_h{};  ///< RMS of error / sigma per horizontal axis pair: 1 when honest
};

/// Summaries by duration, shortest first.
std::vector<OutageSummary> summarize(const std::vector<OutageResult>& outages);

}  // namespace leeway::sim
