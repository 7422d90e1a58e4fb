// The doors of the installed tree, each enough for what it is for.
#include <leeway/logs.hpp>
#include <leeway/navigator.hpp>
#include <optional>

/// What the first fix of a log is answered with.
leeway::Verdict verdict_of_first_fix(const char* gnss_csv) {
  leeway::GnssLogReader fixes(gnss_csv);
  leeway::Navigator navigator{leeway::NavigatorConfig{}};
  const std::optional<leeway::GnssFix> fix = fixes.next();
  return fix ? navigator.push(*fix) : leeway::Verdict::kUnused;
}
