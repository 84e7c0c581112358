// Looks names up in the table of networks and reads the others as files, before anything runs.
#include "apps/options/network_option.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/usage.h"
#include "comm/network_file.h"
#include "files/find_named.h"

namespace delray::apps {
namespace {

bool is_network_file(const std::string& text) {
  return text.ends_with(".json") || text.find('/') != std::string::npos;
}

void check_places(const comm::NamedNetwork& named, std::span<const int> ranks) {
  const comm::Topology& topology = named.network.topology;
  if (ranks.empty() || !comm::kind_of(topology.shape).has_routes) return;
  try {
    (void)comm::Routes(topology, *std::ranges::max_element(ranks));
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("--network {}: {}", named.name, error.what()));
  }
}

}  // namespace

CLI::Option* add_network_option(CLI::App& command, NetworkChoice& choice, const std::string& help,
                                bool has_machine) {
  std::vector<std::string> names = names_in(comm::networks());
  if (has_machine) names.insert(names.begin(), kThisMachine);
  CLI::Option* option =
      command
          .add_option("--network", choice.given,
                      "Networks to predict times for, separated by commas: names, or JSON files "
                      "that describe one (docs/networks.md) " +
                          help)
          ->group(group::kSharing)
          ->type_name("NAME|FILE")
          ->delimiter(',')
          ->allow_extra_args(false);
  choose_from(command, "--network", names, {OtherValues::kFile, is_network_file});
  return option;
}

std::vector<comm::NamedNetwork> networks_of(const NetworkChoice& choice, std::span<const int> ranks,
                                            std::span<const comm::NamedNetwork> otherwise) {
  std::vector<comm::NamedNetwork> networks(otherwise.begin(), otherwise.end());
  if (!choice.given.empty()) networks.clear();
  for (const std::string& given : choice.given) {
    const comm::NamedNetwork* own = files::find_named(otherwise, given);
    comm::NamedNetwork named = own != nullptr ? *own : comm::network_of(given);
    const bool is_there = std::ranges::any_of(
        networks, [&](const comm::NamedNetwork& other) { return other.name == named.name; });
    if (own == nullptr && named.name == kThisMachine)
      throw UsageError(
          fmt::format("--network: {} is what the machine itself is called", named.name));
    if (is_there) throw UsageError(fmt::format("--network: two are called '{}'", named.name));
    check_places(named, ranks);
    networks.push_back(std::move(named));
  }
  return networks;
}

}  // namespace delray::apps
