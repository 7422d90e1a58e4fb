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

/// As a shell reads it as one word.
std::string as_word(const std::string& text) {
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("-_./,:=+@%").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (plain) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// JSON that cannot end the element it stands in.
std::string as_element_text(const Json& json) {
  std::string safe;
  for (const char c : text_of(json)) safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return safe;
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
  page += as_element_text(answer);
  page += kReportTemplate.substr(mark + kDataMark.size());
  write_file(path, page);
}

}  // namespace leeway::cli
