#include "sim/cli/command.hpp"

namespace leeway::cli {
namespace {

struct OldName {
  std::string_view command;  ///< whose option it is; empty: it is a command
  std::string_view name;
  std::string_view new_name;
};

constexpr OldName kOldNames[]{
    {"", "budget", "reduce"},
    {"analyze", "--budget", "--error-budget"},
};

/// Whether the word is this option, or this option and its value: "--budget=b.csv".
bool is_option(std::string_view word, std::string_view option) {
  return word.starts_with(option) && (word.size() == option.size() || word[option.size()] == '=');
}

}  // namespace

std::vector<std::string> with_new_names(std::vector<std::string> words) {
  for (const OldName& old : kOldNames) {
    for (std::size_t i = 0; i < words.size(); ++i) {
      const bool is_old = i == 0 ? old.command.empty() && words[i] == old.name
                                 : old.command == words[0] && is_option(words[i], old.name);
      if (!is_old) continue;
      words[i].replace(0, old.name.size(), old.new_name);
      note(fmt::format("{} is now called {}", old.name, old.new_name));
    }
  }
  return words;
}

}  // namespace leeway::cli
