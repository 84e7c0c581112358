// --help: options under headings, in two columns that fit the terminal.
#include "apps/help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>

#include "apps/terminal.h"

namespace delray::apps {
namespace {

constexpr std::size_t kNameColumn = 26;  // indent and names; longer ones have own lines
constexpr std::size_t kUsualWidth = 80, kWidest = 100;  // of a page; the first where nobody looks

std::size_t page_width() {
  const std::size_t width = line_width(STDOUT_FILENO);
  return width == kUnlimited ? kUsualWidth : std::clamp(width, kNameColumn + 20, kWidest);
}

// A name, and beside or below it what it is.
std::string entry(const std::string& name, const std::string& description) {
  std::string before = "  " + name;
  std::string text;
  if (before.size() + 2 > kNameColumn) {
    text = before + "\n";
    before.clear();
  }
  for (const std::string& line : wrapped(description, page_width() - kNameColumn)) {
    text += fmt::format("{:<{}}{}\n", before, kNameColumn, line);
    before.clear();
  }
  return text;
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0 && option.get_type_size() > 0;
}

// Of "TEXT:{raster,raytrace}" or "INT:1 to 64": what comes before and after the colon.
struct TypeName {
  std::string base, legal;
};
TypeName type_name(const CLI::Option& option) {
  const std::string whole = option.get_type_name();
  const std::size_t colon = std::min(whole.find(':'), whole.size());
  return {whole.substr(0, colon), whole.substr(std::min(colon + 1, whole.size()))};
}

// What stands for the value: "N", "FILE", "N,...".
std::string placeholder(const CLI::Option& option) {
  std::string value = type_name(option).base;
  if (value == "INT" || value == "UINT") value = "N";
  if (value == "FLOAT") value = "X";
  if (value == "TEXT") value = "NAME";
  const bool several = option.get_items_expected_max() > 1;
  if (several) value += option.get_delimiter() != '\0' ? ",..." : " ...";
  return value;
}

// "-o, --output FILE"
std::string names_of(const CLI::Option& option) {
  if (option.get_positional()) {
    const bool several = option.get_items_expected_max() > 1;
    return option.get_name(true) + (several ? " ..." : "");
  }
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  const std::string value = takes_value(option) ? " " + placeholder(option) : "";
  return fmt::format("{}{}", fmt::join(names, ", "), value);
}

// Choices and ranges that the description does not name itself.
std::string legal_values(const CLI::Option& option) {
  std::string legal = type_name(option).legal;
  if (!takes_value(option) || legal.empty()) return "";
  if (!legal.starts_with('{')) return fmt::format(" [{}]", legal);
  legal = legal.substr(1, legal.find('}') - 1);
  const std::vector<std::string> choices = CLI::detail::split(legal, ',');
  const std::string description = option.get_description();
  const bool all_named = std::ranges::all_of(choices, [&](const std::string& choice) {
    return description.find(choice) != std::string::npos;
  });
  return all_named ? "" : fmt::format(": {}", fmt::join(choices, ", "));
}

std::string heading_of(const CLI::App& command, const CLI::Option& option) {
  const bool general = &option == command.get_help_ptr() || option.check_lname("version");
  return general ? group::kGeneral : option.get_group();
}

// In order of appearance, but the general one last.
std::vector<std::string> headings_of(const CLI::App& command) {
  std::vector<std::string> headings;
  for (const CLI::Option* option : command.get_options()) {
    const std::string heading = heading_of(command, *option);
    const bool known = std::ranges::find(headings, heading) != headings.end();
    if (!known && heading != group::kGeneral && !heading.empty()) headings.push_back(heading);
  }
  headings.emplace_back(group::kGeneral);
  return headings;
}

std::string usage(const CLI::App& command, const std::string& name) {
  std::string text = "Usage: " + name;
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional()) text += " " + names_of(*option);
  const bool has_commands = !command.get_subcommands([](const CLI::App*) { return true; }).empty();
  return text + (has_commands ? " COMMAND" : "") + " [OPTION]...\n";
}

std::string option_groups(const CLI::App& command) {
  std::string text;
  for (const std::string& heading : headings_of(command)) {
    text += "\n" + heading + ":\n";
    for (const CLI::Option* option : command.get_options()) {
      if (heading_of(command, *option) != heading) continue;
      text += entry(names_of(*option), option->get_description() + legal_values(*option));
    }
  }
  return text;
}

std::string commands(const CLI::App& command) {
  const auto below = command.get_subcommands([](const CLI::App*) { return true; });
  if (below.empty()) return "";
  std::string text = "\nCommands:\n";
  for (const CLI::App* one : below) text += entry(one->get_name(), one->get_description());
  return text;
}

}  // namespace

std::string HelpFormatter::make_help(const CLI::App* command, std::string name,
                                     CLI::AppFormatMode) const {
  std::string text;
  for (const std::string& line : wrapped(command->get_description(), page_width()))
    text += line + "\n";
  text += "\n" + usage(*command, name) + commands(*command) + option_groups(*command);
  if (!command->get_footer().empty()) text += "\n" + command->get_footer();
  return text;
}

}  // namespace delray::apps
