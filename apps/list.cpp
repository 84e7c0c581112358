// Choosing from a table's names, and what is said of a name that is not among them.
#include "apps/list.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "files/similar_name.h"

namespace delray::apps {

std::string is_not_one_of(std::string_view name, const std::vector<std::string>& names) {
  return fmt::format("'{}' is not one of {}{}", name, fmt::join(names, ", "),
                     files::did_you_mean(name, names));
}

CLI::Validator one_of(const std::vector<std::string>& names) {
  const auto check = [names](const std::string& text) {
    const bool known = std::ranges::find(names, text) != names.end();
    return known ? std::string() : is_not_one_of(text, names);
  };
  return CLI::Validator(check, fmt::format("{{{}}}", fmt::join(names, ",")));
}

}  // namespace delray::apps
