// --help: options under headings, in two columns that fit the terminal.
#include "apps/options/help.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "apps/options/command_text.h"
#include "apps/terminal/terminal.h"

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

// "-o, --output FILE"
std::string entry_name(const OptionText& option) {
  if (option.positional) return option.names[0] + (option.takes_several ? " ..." : "");
  return names_text(option) + (option.takes_value ? " " + option.placeholder : "");
}

// In order of appearance, but the general one last.
std::vector<std::string> headings_of(const CommandText& command) {
  std::vector<std::string> headings;
  for (const OptionText& option : command.options) {
    const bool known = std::ranges::find(headings, option.heading) != headings.end();
    if (!known && option.heading != group::kGeneral) headings.push_back(option.heading);
  }
  headings.emplace_back(group::kGeneral);
  return headings;
}

std::string usage(const CommandText& command, const std::string& name) {
  std::string text = "Usage: " + name;
  for (const OptionText& option : command.options)
    if (option.positional) text += " " + entry_name(option);
  return text + (command.commands.empty() ? "" : " COMMAND") + " [OPTION]...\n";
}

std::string commands(const CommandText& command) {
  if (command.commands.empty()) return "";
  std::string text = "\nCommands:\n";
  for (const CommandText& below : command.commands) text += entry(below.name, below.description);
  return text;
}

std::string option_groups(const CommandText& command) {
  std::string text;
  for (const std::string& heading : headings_of(command)) {
    text += "\n" + heading + ":\n";
    for (const OptionText& option : command.options)
      if (option.heading == heading) text += entry(entry_name(option), full_description(option));
  }
  return text;
}

}  // namespace

std::string HelpFormatter::make_help(const CLI::App* command, std::string name,
                                     CLI::AppFormatMode) const {
  const CommandText described = command_text(*command);
  std::string text;
  for (const std::string& line : wrapped(described.description, page_width())) text += line + "\n";
  text += "\n" + usage(described, name) + commands(described) + option_groups(described);
  if (!command->get_footer().empty()) text += "\n" + command->get_footer();
  return text;
}

}  // namespace delray::apps
