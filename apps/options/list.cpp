// Choosing from a table's names, and what is said of a name that is not among them.
#include "apps/options/list.h"

#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <sstream>

#include "apps/terminal/terminal.h"
#include "files/similar_name.h"

namespace delray::apps {
namespace {

// A validator has a name for who looks for it: here, which values it lets pass.
const std::string kNamed = "choices: ", kNamedOrFile = "choices or file: ";

CLI::Validator choice(const std::vector<std::string>& names, const OtherValues& others) {
  const auto check = [names, others](const std::string& text) -> std::string {
    if (std::ranges::find(names, text) != names.end()) return {};
    if (others.fit != nullptr && others.fit(text)) return {};
    std::vector<std::string> legal = names;
    if (!others.shape.empty()) legal.push_back(others.shape);
    return is_not_one_of(text, legal);
  };
  const std::string& kind = others.shape == OtherValues::kFile ? kNamedOrFile : kNamed;
  return {check, "", kind + fmt::format("{}", fmt::join(names, " "))};
}

// Calls f(name) with what follows the kind in the names of the option's validators.
template <class F>
void for_each_choice(const CLI::Option& given, const std::string& kind, F&& f) {
  auto& option = const_cast<CLI::Option&>(given);  // only asked, by what CLI11 has not made const
  try {
    for (int i = 0;; ++i) {
      const std::string& name = option.get_validator(i)->get_name();
      if (name.starts_with(kind)) f(name.substr(kind.size()));
    }
  } catch (const CLI::OptionNotFound&) {  // no more validators
  }
}

}  // namespace

void print_list(const std::string& heading, const std::vector<NameAndDescription>& entries) {
  const std::size_t width = line_width(STDOUT_FILENO);
  if (width != kUnlimited) {
    fmt::print("{}", list_text(heading, entries, width));
    return;
  }
  for (const auto& [name, description] : entries) fmt::print("{}\t{}\n", name, description);
}

std::string list_text(const std::string& heading, const std::vector<NameAndDescription>& entries,
                      std::size_t width) {
  constexpr std::size_t kIndent = 2, kGap = 2, kNarrowest = 20;
  std::size_t longest = 0;
  for (const NameAndDescription& entry : entries) longest = std::max(longest, entry.name.size());
  const std::size_t begin = kIndent + longest + kGap;
  const std::size_t room = std::max(kNarrowest, width - std::min(width, begin));
  std::string text;
  for (const std::string& line : wrapped(heading + ":", width)) text += line + "\n";
  for (const auto& [name, description] : entries) {
    std::string before = fmt::format("{:{}}{:<{}}", "", kIndent, name, longest + kGap);
    for (const std::string& line : wrapped(description, room)) {
      text += before + line + "\n";
      before = std::string(begin, ' ');
    }
  }
  return text + "\n";
}

std::string is_not_one_of(std::string_view name, const std::vector<std::string>& names) {
  return fmt::format("'{}' is not one of {}{}", name, fmt::join(names, ", "),
                     files::did_you_mean(name, names));
}

CLI::Validator one_of(const std::vector<std::string>& names) {
  return choice(names, {}).description(fmt::format("{{{}}}", fmt::join(names, ",")));
}

void choose_from(CLI::App& command, const std::string& option,
                 const std::vector<std::string>& names, const OtherValues& others) {
  command.get_option(option)->check(choice(names, others));
}

std::vector<std::string> choices(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& kind : {kNamed, kNamedOrFile}) {
    for_each_choice(option, kind, [&](const std::string& text) {
      std::istringstream words(text);
      for (std::string one; words >> one;) {
        if (std::ranges::find(names, one) == names.end()) names.push_back(one);
      }
    });
  }
  return names;
}

bool takes_files(const CLI::Option& option) {
  bool files = false;
  for_each_choice(option, kNamedOrFile, [&](const std::string&) { files = true; });
  return files;
}

}  // namespace delray::apps
