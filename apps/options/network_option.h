// --network: which networks times are predicted for.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "comm/network.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace delray::apps {

// What pages and replays call the machine that they run, or ran, on.
inline constexpr const char* kThisMachine = "this-machine";

// Names of the table and files that describe a network, as given.
struct NetworkChoice {
  std::vector<std::string> given;
};

// Adds --network NAME|FILE,... ; `help` says of the default. With `has_machine` kThisMachine is one
// of the names.
CLI::Option* add_network_option(CLI::App& command, NetworkChoice& choice, const std::string& help,
                                bool has_machine = false);

// The networks in the order given, `otherwise` where none is; kThisMachine is that of `otherwise`.
// Throws files::FileError (input) of a file that describes none, UsageError where two have one name
// or one has no place for so many ranks.
std::vector<comm::NamedNetwork> networks_of(
    const NetworkChoice& choice, std::span<const int> ranks,
    std::span<const comm::NamedNetwork> otherwise = comm::default_networks());

}  // namespace delray::apps
