#include "sim/cli/answer.hpp"

#include <spdlog/fmt/fmt.h>

#include <utility>

#include "sim/cli/pages/report.hpp"

namespace leeway::cli {

void add_output_options(CLI::App& app, Output& output) {
  app.add_option("--report", output.report,
                 "write the answer as an HTML page with charts, complete in one file")
      ->type_name("FILE.html")
      ->check(CLI::Validator([](std::string&) { return why_no_report(); }, ""));
  add_json_option(app, output.json);
}

void add_json_option(CLI::App& app, bool& json) {
  app.add_flag("--json", json, "one JSON object on standard output instead of tables");
}

Json answer_json(std::string_view command, Json input, Json results) {
  return {{"leeway", LEEWAY_VERSION},
          {"command", command},
          {"input", std::move(input)},
          {"results", std::move(results)}};
}

void show(const Output& output, const Json& answer, const std::function<void()>& print_tables,
          const std::function<Json()>& series) {
  if (output.json) {
    fmt::print("{}\n", text_of(answer, 2));
  } else {
    print_tables();
  }
  if (!output.report.empty()) write_report(output.report, answer, series());
}

}  // namespace leeway::cli
