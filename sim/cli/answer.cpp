#include "sim/cli/answer.hpp"

#include "sim/cli/files/output_files.hpp"
#include "sim/cli/pages/report.hpp"

namespace leeway::cli {

void add_output_options(CLI::App& app, Output& output) {
  add_output_file(app, "--report", output.report,
                  "write the answer as an HTML page with charts, complete in one file", "FILE.html")
      ->check(CLI::Validator([](std::string&) { return why_no_report(); }, ""));
  add_json_option(app, output.json);
}

void add_json_option(CLI::App& app, bool& json) {
  app.add_flag("--json", json, "one JSON object on standard output instead of tables");
}

CLI::Option* add_file_option(CLI::App& app, const std::string& name, std::filesystem::path& file,
                             const std::string& meaning, const char* type) {
  return app.add_option(name, file, meaning)->type_name(type);
}

Json row_json(const Row& row) {
  Json json = Json::object();
  for (const Cell& cell : row) {
    if (!cell.key.empty()) json[cell.key] = cell.value;
  }
  return json;
}

Table table_of(const Row& any) {
  std::vector<std::string> headings;
  for (const Cell& cell : any) {
    if (!cell.heading.empty()) headings.push_back(cell.heading);
  }
  return Table(headings);
}

void add_row(Table& table, const Row& row, Tone tone) {
  std::vector<std::string> texts;
  for (const auto& [heading, key, value, decimals] : row) {
    if (heading.empty()) continue;
    texts.push_back(value.is_string()         ? value.get<std::string>()
                    : value.is_number_float() ? number(value.get<double>(), decimals)
                    : value.is_null()         ? "-"
                                              : value.dump());
  }
  table.add(std::move(texts), tone);
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
