#include <chrono>

#include "lib/earth/calendar.hpp"
#include "lib/logs/solutions/solution_formats.hpp"

namespace leeway {
namespace {

void add_padded(RowText& text, unsigned value) { text.add(value < 10 ? "0" : "").add(value, 0); }

/// "2026-12-01T15:04:05.250Z" of a time on the scale of GPS, to the millisecond.
void add_utc(RowText& text, Time time) {
  using namespace std::chrono;
  const Duration gps = time.time_since_epoch();
  const auto utc = round<milliseconds>(gps - gps_minus_utc(gps - gps_minus_utc(gps)));
  const auto day = floor<days>(utc);
  const year_month_day date{sys_days{year{1980} / 1 / 6} + day};
  const hh_mm_ss clock{utc - day};
  text.add(static_cast<int>(date.year()), 0).add("-");
  add_padded(text, static_cast<unsigned>(date.month()));
  text.add("-");
  add_padded(text, static_cast<unsigned>(date.day()));
  text.add("T");
  add_padded(text, static_cast<unsigned>(clock.hours().count()));
  text.add(":");
  add_padded(text, static_cast<unsigned>(clock.minutes().count()));
  text.add(":");
  add_padded(text, static_cast<unsigned>(clock.seconds().count()));
  const auto ms = static_cast<unsigned>(clock.subseconds().count());
  text.add(ms < 10 ? ".00" : ms < 100 ? ".0" : ".").add(ms, 0).add("Z");
}

/// Without a date in the log, a point has no time.
void put_gpx_row(RowText& text, const SolutionRow& row) {
  text.add("<trkpt lat=\"").add(row.lat_deg(), 10).add("\" lon=\"").add(row.lon_deg(), 10);
  text.add("\"><ele>").add(row.nav.position.height_m, 3).add("</ele>");
  if (row.nav.time.time_since_epoch() >= std::chrono::weeks{1}) {
    text.add("<time>");
    add_utc(text, row.nav.time);
    text.add("</time>");
  }
  text.add("</trkpt>\n");
}

}  // namespace

const SolutionFormat kGpxFormat{
    "gpx",
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<gpx version=\"1.1\" creator=\"leeway\" xmlns=\"http://www.topografix.com/GPX/1/1\">\n"
    "<trk><name>leeway</name><trkseg>\n",
    put_gpx_row, "</trkseg></trk></gpx>\n"};

}  // namespace leeway
