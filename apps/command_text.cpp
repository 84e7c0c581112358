#include "apps/command_text.h"

#include <CLI/CLI.hpp>
#include <sstream>
#include <utility>

#include "apps/colour_by.h"
#include "apps/list.h"
#include "composite/codec.h"
#include "composite/scheme.h"
#include "delaunay/methods.h"
#include "loadbalance/partition.h"
#include "loadbalance/schedule.h"
#include "raster/strategies.h"
#include "raytrace/integrator.h"

namespace delray::apps {
namespace {

// The names in the table that the option chooses from; empty if it chooses from none.
std::vector<std::string> table_of(const std::string& option) {
  if (option == "--method") return names_in(delaunay::methods());
  if (option == "--location") return names_in(delaunay::locations());
  if (option == "--split") return names_in(delaunay::splits());
  if (option == "--order") return names_in(delaunay::orders());
  if (option == "--deadlocks") return names_in(delaunay::deadlock_strategies());
  if (option == "--strategy") return names_in(raster::strategies());
  if (option == "--partition") return names_in(loadbalance::partitioners());
  if (option == "--schedule") return names_in(loadbalance::schedules());
  if (option == "--compose") return names_in(composite::schemes());
  if (option == "--codec") return names_in(composite::codecs());
  if (option == "--integrator") return names_in(raytrace::integrators());
  if (option == "--color-by") return names_in(colour_bys());
  return {};
}

// What stands in the braces of "TEXT:{raster,raytrace}".
std::vector<std::string> members_in(const std::string& type) {
  const std::size_t begin = type.find('{'), end = type.find('}');
  std::vector<std::string> members;
  if (begin == std::string::npos || end == std::string::npos) return members;
  std::istringstream text(type.substr(begin + 1, end - begin - 1));
  for (std::string member; std::getline(text, member, ',');) members.push_back(member);
  return members;
}

OptionText option_text(const CLI::Option& option) {
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
  if (!result.takes_value) return result;
  result.values = members_in(option.get_type_name());
  if (result.values.empty()) result.values = table_of(result.names.back());
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

CommandText command_text(const CLI::App& command) {
  CommandText result{
      command.get_name(), command.get_description(), examples_in(command.get_footer()), {}, {}};
  for (const CLI::Option* option : command.get_options())
    result.options.push_back(option_text(*option));
  for (const CLI::App* below : command.get_subcommands(nullptr))
    result.commands.push_back(command_text(*below));
  return result;
}

}  // namespace delray::apps
