#include "leeway/sim/scene/outage.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "leeway/earth/error.hpp"
#include "sim/tools/json_error.hpp"

namespace leeway::sim {

namespace {

constexpr const char* kWanted = "; wanted: [{\"start_s\": 60.5, \"duration_s\": 10}, ..]";

struct MissingNumber {
  const char* key;
};

double number_of(const nlohmann::json& entry, const char* key) {
  if (!entry.is_object() || !entry.contains(key) || !entry[key].is_number()) {
    throw MissingNumber{key};
  }
  return entry[key].get<double>();
}

}  // namespace

std::vector<Outage> read_outages(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw Error(path.string() + ": cannot be opened; it should hold the outages as JSON");
  std::vector<Outage> outages;
  try {
    for (const auto& entry : nlohmann::json::parse(file)) {
      const Outage outage{number_of(entry, "start_s"), number_of(entry, "duration_s")};
      if (!std::isfinite(outage.start_s) || !(outage.duration_s > 0.0 && outage.duration_s < 1e6)) {
        throw Error(path.string() + ": outage " + std::to_string(outages.size() + 1) +
                    ": start_s must be finite and duration_s between 0 and 1e6 s");
      }
      outages.push_back(outage);
    }
  } catch (const nlohmann::json::exception& error) {
    throw Error(path.string() + ": " + in_words(error) + kWanted);
  } catch (const MissingNumber& missing) {
    throw Error(path.string() + ": outage " + std::to_string(outages.size() + 1) +
                " has no number '" + missing.key + "'" + kWanted);
  }
  return outages;
}

std::vector<OutageSummary> summarize(const std::vector<OutageResult>& outages) {
  std::vector<double> durations;
  for (const OutageResult& r : outages) durations.push_back(r.outage.duration_s);
  std::sort(durations.begin(), durations.end());
  durations.erase(std::unique(durations.begin(), durations.end()), durations.end());

  std::vector<OutageSummary> summaries;
  for (const double duration_s : durations) {
    OutageSummary s;
    s.duration_s = duration_s;
    std::vector<double> end_h_m;
    for (const OutageResult& r : outages) {
      if (r.outage.duration_s != duration_s) continue;
      if (r.against == Against::kNothing) {
        ++s.unscored;
        continue;
      }
      end_h_m.push_back(r.end_error_h_m);
      s.rms_end_h_m += r.end_error_h_m * r.end_error_h_m;
      s.rms_end_v_m += r.end_error_v_m * r.end_error_v_m;
      s.rms_over_sigma_h += std::pow(r.end_error_h_m / r.end_sigma_h_m, 2);
    }
    s.count = static_cast<std::int64_t>(end_h_m.size());
    if (s.count > 0) {
      const double n = static_cast<double>(s.count);
      s.rms_end_h_m = std::sqrt(s.rms_end_h_m / n);
      s.rms_end_v_m = std::sqrt(s.rms_end_v_m / n);
      s.rms_over_sigma_h = std::sqrt(s.rms_over_sigma_h / n);
      std::sort(end_h_m.begin(), end_h_m.end());
      s.median_end_h_m = end_h_m[end_h_m.size() / 2];
      s.max_end_h_m = end_h_m.back();
    }
    summaries.push_back(s);
  }
  return summaries;
}

}  // namespace leeway::sim
