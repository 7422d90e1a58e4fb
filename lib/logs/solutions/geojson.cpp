#include "lib/logs/solutions/solution_formats.hpp"

namespace leeway {
namespace {

void put_geojson_row(RowText& text, const SolutionRow& row) {
  text.add(row.is_first ? "[" : ",\n[").add(row.lon_deg(), 10).add(",").add(row.lat_deg(), 10);
  text.add(",").add(row.nav.position.height_m, 3).add("]");
}

}  // namespace

/// Source: RFC 7946.
const SolutionFormat kGeojsonFormat{"geojson",
                                    "{\"type\":\"FeatureCollection\",\"features\":[\n"
                                    "{\"type\":\"Feature\",\"properties\":{\"name\":\"leeway\"},"
                                    "\"geometry\":{\"type\":\"LineString\",\"coordinates\":[\n",
                                    put_geojson_row, "\n]}}]}\n"};

}  // namespace leeway
