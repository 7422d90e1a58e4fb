/// @file
/// What the JSON library says of an error, without its own number.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace leeway::sim {

/// "[json.exception.parse_error.101] parse error at .." from "parse error" on.
inline std::string in_words(const nlohmann::json::exception& error) {
  const std::string_view what = error.what();
  return std::string(what.substr(what.find("] ") + 2));
}

}  // namespace leeway::sim
