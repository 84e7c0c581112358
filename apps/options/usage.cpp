// Errors of a command line: names are looked up before values are judged, since one that
// is mistyped makes nonsense of what follows it.
#include "apps/options/usage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <utility>

#include "files/similar_name.h"

namespace delray::apps {
namespace {

std::vector<const CLI::App*> commands_below(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App*) { return true; });
}

const CLI::App* find_command(const CLI::App& above, const std::string& name) {
  for (const CLI::App* below : commands_below(above)) {
    if (below->get_name() == name) return below;
  }
  return nullptr;
}

std::vector<std::string> names_of_commands(const CLI::App& above) {
  std::vector<std::string> names;
  for (const CLI::App* below : commands_below(above)) names.push_back(below->get_name());
  return names;
}

// "delray compare compose".
std::string full_name(const CLI::App& command) {
  const CLI::App* above = command.get_parent();
  return above == nullptr ? command.get_name() : full_name(*above) + " " + command.get_name();
}

std::vector<std::string> names_of_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// "--size=3x3" -> "--size"; of "-ofile" what CLI11 takes for a name: "-o".
std::string option_name(const std::string& argument) {
  if (argument.starts_with("--")) return argument.substr(0, argument.find('='));
  return argument.substr(0, 2);
}

bool is_option(const std::string& argument) {
  const bool is_number = argument.size() > 1 && argument[1] >= '0' && argument[1] <= '9';
  return argument.size() > 1 && argument[0] == '-' && argument != "--" && !is_number;
}

std::string unknown_option(const CLI::App& command, const std::string& argument) {
  const bool has_two_dashes = argument.starts_with("--");
  // "-size" was meant to be "--size".
  const std::string meant = has_two_dashes ? option_name(argument) : "-" + argument;
  const std::vector<std::string> names = names_of_options(command);
  const bool lacks_a_dash = std::ranges::find(names, meant) != names.end();
  return fmt::format("'{}' is not an option of {}{}", has_two_dashes ? meant : argument,
                     full_name(command),
                     lacks_a_dash ? fmt::format("; did you mean '{}'?", meant)
                                  : files::did_you_mean(meant, names));
}

std::string unknown_command(const CLI::App& above, const std::string& name) {
  const std::vector<std::string> names = names_of_commands(above);
  const std::string similar = files::did_you_mean(name, names);
  return fmt::format(
      "'{}' is not a command of {}{}", name, full_name(above),
      similar.empty() ? fmt::format(", which has {}", fmt::join(names, ", ")) : similar);
}

// Whether the argument after `argument`, which is the option's, is its value, whatever it looks
// like.
bool has_value_next(const CLI::Option& option, const std::string& argument) {
  if (option.get_items_expected_min() < 1 || option.get_type_size() < 1) return false;
  return argument.starts_with("--") ? argument.find('=') == std::string::npos
                                    : argument.size() == 2;
}

// The message of CLI11 in the words of all other messages.
std::string plain_text(const CLI::App& command, const CLI::ParseError& error) {
  const std::string text = error.what();
  const auto around = [&text](const std::string& middle) {
    const std::size_t at = text.find(middle);
    const bool found = at != std::string::npos;
    return found ? std::optional(std::pair(text.substr(0, at), text.substr(at + middle.size())))
                 : std::nullopt;
  };
  if (around(" not expected: "))
    return fmt::format("unexpected arguments: {}", fmt::join(command.remaining(), " "));
  if (const auto parts = around(" excludes ")) {
    return parts->first + " has no effect with " + parts->second;
  }
  if (const auto parts = around("Could not convert: ")) {
    return "not a value of this option: " + parts->second;
  }
  if (const auto parts = around(": At Most 1 ")) return parts->first + ": given more than once";
  if (text.ends_with(" missing")) return text.substr(0, text.find(": ")) + ": a value is missing";
  return text;
}

}  // namespace

std::string unknown_name(const CLI::App& program, const std::vector<std::string>& arguments) {
  const CLI::App* command = &program;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument == "--") break;
    if (argument == "--help" || argument == "-h" || argument == "--version") return "";
    if (is_option(argument)) {
      const CLI::Option* option = command->get_option_no_throw(option_name(argument));
      if (option == nullptr) return unknown_option(*command, argument);
      if (has_value_next(*option, argument)) ++i;
    } else if (!commands_below(*command).empty()) {
      const CLI::App* below = find_command(*command, argument);
      if (below == nullptr) return unknown_command(*command, argument);
      command = below;
    }
  }
  const std::vector<std::string> names = names_of_commands(*command);
  if (names.empty()) return "";
  return fmt::format("{}: a command is missing: {}", full_name(*command), fmt::join(names, ", "));
}

std::string usage_message(const CLI::App& program, const std::vector<std::string>& arguments,
                          const CLI::ParseError& error) {
  const CLI::App& command = command_of(program, arguments);
  std::string what = unknown_name(program, arguments);
  if (what.empty()) what = plain_text(command, error);
  return fmt::format("{} ({} --help tells more)", what, full_name(command));
}

const CLI::App& command_of(const CLI::App& program, const std::vector<std::string>& arguments) {
  const CLI::App* command = &program;
  for (const std::string& argument : arguments) {
    if (const CLI::App* below = find_command(*command, argument)) command = below;
  }
  return *command;
}

}  // namespace delray::apps
