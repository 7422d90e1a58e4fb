#include <algorithm>

#include "leeway/sim/inspect/inspect_logs.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/log_options.hpp"
#include "sim/cli/tables/look_tables.hpp"

namespace leeway::cli {
namespace {

struct InfoOptions {
  std::vector<std::filesystem::path> files{};
  LogForm form{};
  Output output{};
};

/// What opens, or what it says when it does not.
template <class Open>
std::string refusal(const Open& open) {
  try {
    open();
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

/// Puts a file where it belongs: it may be of both sensors. @throws Error when it is of none.
void place(const std::filesystem::path& file, sim::LogsToInspect& logs) {
  if (!std::filesystem::is_regular_file(file) && !std::filesystem::is_directory(file)) {
    throw Error(file.string() + ": is no file and no folder; info looks at logs more than once");
  }
  // A binary log opens as one of either sensor: a record tells.
  const auto require_record = [&file](auto reader) {
    if (!reader.next()) throw Error(file.string() + ": has no record of such a sensor");
  };
  const std::string not_imu =
      refusal([&] { require_record(ImuLogReader(file, logs.imu_options)); });
  const std::string not_gnss =
      refusal([&] { require_record(GnssLogReader(file, logs.gnss_options)); });
  const auto set = [&file](std::filesystem::path& path, const char* what) {
    if (path == file) return;
    if (!path.empty())
      throw Error(fmt::format("{}: a second {} log beside {}", file.string(), what, path.string()));
    path = file;
  };
  if (not_imu.empty()) set(logs.imu, "IMU");
  if (not_gnss.empty()) set(logs.gnss, "GNSS");
  if (not_imu.empty() || not_gnss.empty()) return;
  if (refusal([&] { ScalarLogReader(file, sim::odometer_columns()); }).empty()) {
    return set(logs.odometer, "odometer");
  }
  const bool is_imu = not_imu.find("missing column") == std::string::npos;
  throw Error(is_imu || not_gnss.find("missing column") != std::string::npos ? not_imu : not_gnss);
}

/// Of a log that is there: what was read of it.
void add_log(Table& table, const char* title, const std::filesystem::path& path,
             const std::string& layout, const LogSummary& summary) {
  if (path.empty()) return;
  table.add({title, layout, std::to_string(summary.lines), std::to_string(summary.records),
             std::to_string(summary.damaged_lines()), path.string()});
}

void print_notes(const LogSummary& summary) {
  for (const std::string& text : summary.notes) fmt::print("  {}\n", text);
  for (const std::string& text : summary.messages) fmt::print("  {}\n", text);
}

/// The logs, and the options that mend what was found in them, as `fuse` and `replay` take them.
std::string mended(const sim::LogsToInspect& logs, const sim::LogLook& look) {
  std::string words = fmt::format("--imu {} --gnss {}", logs.imu.string(), logs.gnss.string());
  for (const sim::Finding& finding : look.findings) {
    const bool is_option = finding.remedy.starts_with("--") &&
                           finding.remedy.find_first_of("<,") == std::string::npos &&
                           std::count(finding.remedy.begin(), finding.remedy.end(), ' ') == 1;
    if (is_option && finding.certainty != sim::Certainty::kNote) words += " " + finding.remedy;
  }
  return words;
}

void print_info(const sim::LogsToInspect& logs, const sim::InspectedLogs& found) {
  const bool is_wrong = found.look.is_certainly_wrong();
  fmt::print("{}\n\n", is_wrong ? "These logs are not what they say: see the findings."
                       : found.look.findings.empty()
                           ? "Nothing is wrong with these logs that shows."
                           : "Nothing is certainly wrong with these logs.");
  print_findings(found.look.findings);
  Table table({"<log", "<layout", "lines", "records", "damaged", "<file"});
  add_log(table, "IMU", logs.imu, found.imu_layout, found.imu_summary);
  add_log(table, "GNSS", logs.gnss, found.gnss_layout, found.gnss_summary);
  table.print();
  print_notes(found.imu_summary);
  print_notes(found.gnss_summary);
  print_figures(found.look);
  if (!logs.imu.empty() && !logs.gnss.empty()) {
    fmt::print(
        "\nNext: how often a fix has to come, and the solution\n  leeway replay {0}\n"
        "  leeway fuse {0} --out solution.csv\n",
        mended(logs, found.look));
  }
}

Json summary_json(const std::filesystem::path& path, const std::string& layout,
                  const LogSummary& summary) {
  if (path.empty()) return nullptr;
  return {{"path", path.string()},
          {"layout", layout},
          {"lines", summary.lines},
          {"records", summary.records},
          {"damaged_lines", summary.damaged_lines()},
          {"notes", summary.notes},
          {"messages", summary.messages}};
}

int run(const InfoOptions& options) {
  sim::LogsToInspect logs;
  LogForms forms = log_forms(options.form);
  logs.imu_options.format = std::move(forms.imu);
  logs.gnss_options.format = std::move(forms.gnss);
  logs.gnss_options.time_offset = duration_from_seconds(forms.gnss_time_offset_s);
  for (const auto& file : options.files) place(file, logs);
  const sim::InspectedLogs found = sim::inspect(logs);
  show(options.output,
       answer_json("info",
                   {{"imu", summary_json(logs.imu, found.imu_layout, found.imu_summary)},
                    {"gnss", summary_json(logs.gnss, found.gnss_layout, found.gnss_summary)},
                    {"odometer", logs.odometer.empty() ? Json() : Json(logs.odometer.string())}},
                   look_json(found.look)),
       [&] { print_info(logs, found); });
  return kSuccess;
}

void add_options(CLI::App& app, InfoOptions& options) {
  app.add_option("files", options.files, "logs of an IMU, a receiver, an odometer, in any order")
      ->required()
      ->type_name("FILE");
  add_log_form_options(app, options.form);
  add_json_option(app, options.output.json);
}

const Command<InfoOptions> kInfo{
    "info", "What is in logs, what is wrong with them, and the option that mends it",
    "Examples:\n  leeway info imu.csv gnss.csv\n  leeway info imu.csv gnss.csv odometer.csv --json",
    add_options, run};

}  // namespace
}  // namespace leeway::cli
