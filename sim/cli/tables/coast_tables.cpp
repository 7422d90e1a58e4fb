#include "sim/cli/tables/coast_tables.hpp"

#include <cmath>

#include "sim/cli/limit_options.hpp"
#include "sim/cli/output.hpp"

namespace leeway::cli {

void print_coasts(const std::vector<NamedCoasts>& of_imus) {
  Table table({"<IMU", "outage at, s", "for, s", "error at its end, m", "limit, m", "<keeps it",
               "coast time, s"});
  for (const NamedCoasts& of_imu : of_imus) {
    for (const sim::Coast& c : of_imu.coasts) {
      table.add({of_imu.imu, number(c.outage.start_s, 1), number(c.outage.duration_s, 1),
                 number(c.end_error_m, 2), number(c.end_allowed_m, 2),
                 c.keeps_limit() ? "yes" : fmt::format("no, at {:.1f} s", c.end_s),
                 std::isnan(c.coast_s) ? "to the scene's end" : seconds(c.coast_s)},
                c.keeps_limit() ? Tone::kGood : Tone::kBad);
    }
  }
  table.print();
  fmt::print("  Coast time: how long without fixes until the limit, from the outage's start.\n");
}

Json coast_json(const sim::Coast& c) {
  Json json{{"start_s", c.outage.start_s},
            {"duration_s", c.outage.duration_s},
            {"end_s", c.end_s},
            {"end_error_m", c.end_error_m}};
  json.update(limit_json(sim::AllowedError(c.limit_m, c.share)));
  json.update({{"end_allowed_m", c.end_allowed_m},
               {"keeps_limit", c.keeps_limit()},
               {"coast_s", c.coast_s}});
  return json;
}

}  // namespace leeway::cli
