#include "sim/report/report_template.hpp"

namespace leeway::cli {

const std::string_view kReportTemplate{};

}  // namespace leeway::cli
