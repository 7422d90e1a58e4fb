/// @file
/// Names that commands and options had in earlier versions, which scripts still use.
#pragma once

#include <string>
#include <vector>

namespace leeway::cli {

/// The words of a command line, with the names of today. A note on stderr tells of each old one.
std::vector<std::string> with_new_names(std::vector<std::string> words);

}  // namespace leeway::cli
