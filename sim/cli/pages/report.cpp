#include "sim/cli/pages/report.hpp"

#include <algorithm>
#include <cctype>

#include "sim/cli/output.hpp"
#include "sim/report/report_template.hpp"

namespace leeway::cli {
namespace {

constexpr std::string_view kDataMark = "/* report */";

std::string& command_line() {
  static std::string line;
  return line;
}

std::string with(std::string_view text, char replaced, std::string_view by) {
  std::string changed;
  for (const char c : text) changed += c == replaced ? by : std::string_view(&c, 1);
  return changed;
}

/// As a shell reads it as one word.
std::string as_word(const std::string& text) {
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("-_./,:=+@%").find(static_cast<char>(c)) != std::string_view::npos;
  });
  return plain ? text : "'" + with(text, '\'', "'\\''") + "'";
}

}  // namespace

std::string why_no_report() {
  if (!kReportTemplate.empty()) return {};
  return "this program was built without its report page: install Node.js 18 or newer with npm "
         "(apt-get install npm), then configure and build it again, with access to the npm "
         "registry";
}

void remember_command_line(const std::vector<std::string>& words) {
  command_line() = "leeway";
  for (const std::string& word : words) command_line() += " " + as_word(word);
}

void write_report(const std::filesystem::path& path, Json answer, Json series) {
  answer["command_line"] = command_line();
  answer["series"] = std::move(series);
  const std::size_t mark = kReportTemplate.find(kDataMark);
  std::string page(kReportTemplate.substr(0, mark));
  page += with(text_of(answer), '<', "\\u003c");  // cannot end the element
  page += kReportTemplate.substr(mark + kDataMark.size());
  write_file(path, page);
}

}  // namespace leeway::cli
