// Reads options, names to choose from, ranges and examples out of CLI11's objects, for help, man
// page and completion.
#include "apps/options/command_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <utility>

#include "apps/options/help.h"
#include "apps/options/list.h"

namespace delray::apps {
namespace {

// The parts before and behind the colon of "INT:1 to 64" or "TEXT:{raster,raytrace}".
std::pair<std::string, std::string> type_parts(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t colon = std::min(type.find(':'), type.size());
  return {type.substr(0, colon), type.substr(std::min(colon + 1, type.size()))};
}

std::string placeholder_of(const CLI::Option& option) {
  std::string value = type_parts(option).first;
  if (value == "INT" || value == "UINT") value = "N";
  if (value == "FLOAT") value = "X";
  if (value == "TEXT") value = "NAME";
  if (option.get_items_expected_max() > 1)
    value += option.get_delimiter() != '\0' ? ",..." : " ...";
  return value;
}

// Whether all names stand in the text already, as words.
bool tells_all(const std::string& text, const std::vector<std::string>& names) {
  constexpr const char* kLetters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-.";
  std::vector<std::string> words;
  for (std::size_t begin = text.find_first_of(kLetters); begin != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_not_of(kLetters, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    if (words.back().ends_with('.')) words.back().pop_back();
    begin = text.find_first_of(kLetters, end);
  }
  return std::ranges::all_of(names, [&](const std::string& name) {
    return std::ranges::find(words, name) != words.end();
  });
}

OptionText option_text(const CLI::App& command, const CLI::Option& option) {
  OptionText result;
  const bool general = &option == command.get_help_ptr() || option.check_lname("version");
  result.heading = general ? group::kGeneral : option.get_group();
  result.description = option.get_description();
  result.positional = option.get_positional();
  result.takes_value = option.get_items_expected_max() > 0;
  result.takes_several = option.get_items_expected_max() > 1;
  if (result.positional) {
    result.names = {option.get_name(true)};
  } else {
    for (const std::string& name : option.get_snames()) result.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) result.names.push_back("--" + name);
  }
  if (!result.takes_value) return result;
  result.values = choices(option);
  result.files = takes_files(option);
  result.placeholder = placeholder_of(option);
  if (result.values.empty()) result.range = type_parts(option).second;
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

std::string names_text(const OptionText& option) {
  return fmt::format("{}", fmt::join(option.names, ", "));
}

std::string full_description(const OptionText& option) {
  std::string text = option.description;
  if (!tells_all(text, option.values))
    text += fmt::format("; one of {}", fmt::join(option.values, ", "));
  if (!option.range.empty()) text += fmt::format(" [{}]", option.range);
  return text;
}

CommandText command_text(const CLI::App& command) {
  CommandText result{
      command.get_name(), command.get_description(), examples_in(command.get_footer()), {}, {}};
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;  // older names, which nobody need learn
    result.options.push_back(option_text(command, *option));
  }
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; }))
    result.commands.push_back(command_text(*below));
  return result;
}

}  // namespace delray::apps
