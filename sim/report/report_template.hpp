/// @file
/// The page that reports are written into.
#pragma once

#include <string_view>

namespace leeway::cli {

/// Made of the TypeScript here. Empty where the program was built without Node.js.
extern const std::string_view kReportTemplate;

}  // namespace leeway::cli
