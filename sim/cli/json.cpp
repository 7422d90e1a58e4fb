#include "sim/cli/json.hpp"

namespace leeway::cli {

Json json_of(const std::optional<Eigen::Vector3d>& v) {
  return v ? Json{v->x(), v->y(), v->z()} : Json();
}

std::string text_of(const Json& json, int indent) {
  // Paths need not be UTF-8.
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace leeway::cli
