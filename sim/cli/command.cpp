#include "sim/cli/command.hpp"

#include <CLI/CLI.hpp>
#include <utility>

#include "sim/cli/files/output_files.hpp"

namespace leeway::cli {

std::map<std::string, AddCommand>& commands() {
  static std::map<std::string, AddCommand> all;
  return all;
}

// Here and not in the template: CLI::App would be compiled into every command.
void define_command(const char* name, const char* about, const char* footer,
                    std::function<std::function<int()>(CLI::App&)> prepare) {
  commands()[name] = [=, prepare = std::move(prepare)](CLI::App& program, int& exit_code) {
    CLI::App* app = program.add_subcommand(name, about);
    app->footer(footer);
    app->callback([app, run = prepare(*app), &exit_code] {
      claim_output_files(*app);
      exit_code = run();
    });
  };
}

}  // namespace leeway::cli
