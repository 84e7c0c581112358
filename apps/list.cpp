// Choosing from a table's names, and what is said of a name that is not among them.
#include "apps/list.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "files/similar_name.h"

namespace delray::apps {
namespace {

// A validator has a name for who looks for it: here, which values it lets pass.
const std::string kNamed = "choices ";

CLI::Validator choice(const std::vector<std::string>& names, const OtherValues& others) {
  const auto check = [names, others](const std::string& text) -> std::string {
    if (std::ranges::find(names, text) != names.end()) return {};
    if (others.fit != nullptr && others.fit(text)) return {};
    std::vector<std::string> legal = names;
    if (!others.shape.empty()) legal.push_back(others.shape);
    return is_not_one_of(text, legal);
  };
  return {check, "", kNamed + fmt::format("{}", fmt::join(names, " "))};
}

}  // namespace

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

std::vector<std::string> choices(CLI::Option& option) {
  std::vector<std::string> names;
  try {
    for (int i = 0;; ++i) {
      const std::string& name = option.get_validator(i)->get_name();
      if (!name.starts_with(kNamed)) continue;
      std::istringstream text(name.substr(kNamed.size()));
      for (std::string one; text >> one;) names.push_back(one);
    }
  } catch (const CLI::OptionNotFound&) {  // no more validators
  }
  return names;
}

}  // namespace delray::apps
