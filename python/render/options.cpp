// The option table parses a command line that is made of the keywords.
#include "python/render/options.h"

#include <algorithm>
#include <stdexcept>

#include "apps/options/usage.h"

namespace delray::python {

void parse_options(CLI::App& command, const std::vector<std::string>& arguments) {
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());  // as CLI11 takes them
  try {
    command.parse(std::move(reversed));
  } catch (const CLI::ParseError& error) {
    throw std::invalid_argument(apps::usage_message(command, arguments, error));
  }
}

void refuse_options(const CLI::App& command, const std::vector<std::string>& refused,
                    const std::string& why) {
  for (const std::string& name : refused) {
    const CLI::Option* const option = command.get_option_no_throw(name);
    if (option != nullptr && option->count() > 0) throw std::invalid_argument(name + ": " + why);
  }
}

}  // namespace delray::python
