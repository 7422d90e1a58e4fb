#include "sim/cli/command.hpp"

namespace leeway::cli {

std::map<std::string, AddCommand>& commands() {
  static std::map<std::string, AddCommand> all;
  return all;
}

}  // namespace leeway::cli
