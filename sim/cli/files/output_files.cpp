#include "sim/cli/files/output_files.hpp"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <set>
#include <vector>

#include "leeway/sim/tools/ranks.hpp"
#include "sim/cli/output.hpp"

namespace leeway::cli {
namespace {

std::set<const CLI::Option*>& output_options() {
  static std::set<const CLI::Option*> all;
  return all;
}

/// Parts of claimed files. A signal handler reads it: reserved once, so that none moves.
std::vector<std::string>& partial_files() {
  static std::vector<std::string> all;
  return all;
}

extern "C" void remove_parts(int signal) {
  for (const std::string& part : partial_files()) unlink(part.c_str());
  ::signal(signal, SIG_DFL);
  raise(signal);
}

std::filesystem::path part_of(const std::filesystem::path& file) {
  std::filesystem::path part = file;
  part += ".partial";
  return part;
}

bool are_same(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(a, ignored) ==
             std::filesystem::weakly_canonical(b, ignored) ||
         std::filesystem::equivalent(a, b, ignored);
}

/// @throws Error when another option names the file, to read or to write.
void refuse_shared(const CLI::App& app, const CLI::Option& output,
                   const std::filesystem::path& file) {
  for (const CLI::Option* other : app.get_options()) {
    if (other == &output) continue;
    for (const std::string& value : other->results()) {
      const bool names_file = output_options().contains(other) || std::filesystem::exists(value);
      if (!names_file || !are_same(value, file)) continue;
      throw Error(fmt::format("{} {}: {} names the same file; choose another", output.get_name(),
                              file.string(), other->get_name()));
    }
  }
}

}  // namespace

CLI::Option* add_output_file(CLI::App& app, const std::string& name, std::filesystem::path& file,
                             const std::string& meaning, const char* type) {
  CLI::Option* option = app.add_option(name, file, meaning)->type_name(type);
  output_options().insert(option);
  return option;
}

void claim_output_file(const std::filesystem::path& file) {
  constexpr std::size_t kMost = 64;
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw Error(file.string() + ": is no regular file, and would be replaced; choose another");
  }
  if (!sim::Ranks::launched_first() || partial_files().size() == kMost) return;
  const std::filesystem::path part = part_of(file);
  errno = 0;
  if (!std::ofstream(part)) {
    const std::error_code error(errno, std::generic_category());
    throw WriteFailure(fmt::format("{}: cannot be written: {}", file.string(), error.message()));
  }
  std::filesystem::remove(part, ignored);
  partial_files().reserve(kMost);
  partial_files().push_back(part.string());
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::signal(signal, remove_parts);
}

void claim_output_files(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    if (!output_options().contains(option)) continue;
    for (const std::string& value : option->results()) {
      refuse_shared(app, *option, value);
      claim_output_file(value);
    }
  }
}

}  // namespace leeway::cli
