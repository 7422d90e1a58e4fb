#include "sim/cli/json.hpp"

namespace leeway::cli {

std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace leeway::cli
