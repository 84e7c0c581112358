// Costs of messages and work on a machine: the models that drive the simulated one.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "comm/communicator.h"
#include "comm/topology.h"

namespace delray::comm {

// Seconds: LogGP (Alexandrov, Ionescu, Schauser and Scheiman 1995) with contention: each link of
// the topology carries one message at a time, first come, first served. Of a crossbar these are the
// sender's and the receiver's; elsewhere a message takes the links of its route, its first byte
// being on the next one while the last is on the one before (cut-through). Messages of a rank to
// itself are free.
struct Network {
  double latency = 20e-6;
  double overhead = 1e-6;  // of the processor, for each send and each receive
  double seconds_per_byte = 1 / 1.25e9;
  // Of the processor, for each send and each receive: where it moves the bytes itself.
  double copy_seconds_per_byte = 0;
  double hop_seconds = 0;  // for each link of a route after the first
  Topology topology;
  // Ranks take turns on so many cores, a few milliseconds at a time, first come, first served; 0:
  // each has a core of its own.
  int shared_cores = 0;
  // Indexed by Work. The caller calibrates all but the first, which is the unit itself.
  std::array<double, kWorkKinds> seconds_per_work = {1e-9, 1e-9, 50e-9, 2e-9, 200e-9, 1e-6, 1e-9};
  // Each message is late by a random time of up to this, of any order of magnitude.
  double jitter = 0;

  // All ranks share its links and hear what they carry: a multicast is one message.
  bool is_bus() const { return topology.shape == Shape::bus; }
};

// A network with its name, from the table or from a file (comm/network_file.h).
struct NamedNetwork {
  std::string name;
  std::string description;
  Network network;
  bool by_default = false;  // predicted where nobody says which
};

// The table: predictions, command line and documentation iterate over it.
std::span<const NamedNetwork> networks();
// The rows that are predicted by default; they come first.
std::span<const NamedNetwork> default_networks();

// nullptr when there is no such network.
const NamedNetwork* find_network(std::string_view name);

}  // namespace delray::comm
