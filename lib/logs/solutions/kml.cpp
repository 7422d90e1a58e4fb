#include "lib/logs/solutions/solution_formats.hpp"

namespace leeway {
namespace {

void put_kml_row(RowText& text, const SolutionRow& row) {
  text.add(row.lon_deg(), 10).add(",").add(row.lat_deg(), 10);
  text.add(",").add(row.nav.position.height_m, 3).add("\n");
}

}  // namespace

const SolutionFormat kKmlFormat{
    "kml",
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document><Placemark><name>leeway</name>\n"
    "<LineString><altitudeMode>clampToGround</altitudeMode><coordinates>\n",
    put_kml_row, "</coordinates></LineString></Placemark></Document></kml>\n"};

}  // namespace leeway
