#include "apps/command_text.h"

#include <CLI/CLI.hpp>
#include <functional>
#include <sstream>

#include "apps/list.h"

namespace delray::apps {
namespace {

OptionText option_text(CLI::Option& option) {
  OptionText result;
  result.description = option.get_description();
  result.positional = option.get_positional();
  result.takes_value = option.get_items_expected_max() > 0;
  if (result.positional) {
    result.names = {option.get_name(true)};
  } else {
    for (const std::string& name : option.get_snames()) result.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) result.names.push_back("--" + name);
  }
  result.values = choices(option);
  return result;
}

std::vector<std::string> examples_in(const std::string& footer) {
  std::vector<std::string> examples;
  std::istringstream text(footer);
  for (std::string line; std::getline(text, line);)
    if (line.starts_with("  ")) examples.push_back(line.substr(2));
  return examples;
}

}  // namespace

CommandText command_text(CLI::App& command) {
  CommandText result{
      command.get_name(), command.get_description(), examples_in(command.get_footer()), {}, {}};
  for (CLI::Option* option : command.get_options(std::function<bool(CLI::Option*)>()))
    result.options.push_back(option_text(*option));
  for (CLI::App* below : command.get_subcommands(std::function<bool(CLI::App*)>()))
    result.commands.push_back(command_text(*below));
  return result;
}

}  // namespace delray::apps
