/// @file
/// JSON as the program writes it.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace leeway::cli {

/// Keys stay in the order they are added.
using Json = nlohmann::ordered_json;

/// Three numbers, or null.
inline Json json_of(const std::optional<Eigen::Vector3d>& v) {
  return v ? Json{v->x(), v->y(), v->z()} : Json();
}

/// Numbers that are not finite become null; what is not UTF-8, as paths may be, is replaced.
std::string text_of(const Json& json, int indent = -1);

}  // namespace leeway::cli
