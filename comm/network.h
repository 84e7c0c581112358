// Costs of messages and work on a machine: the models that drive the simulated one.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "comm/communicator.h"

namespace delray::comm {

// Seconds: LogGP (Alexandrov, Ionescu, Schauser and Scheiman 1995), the gap per byte charged on the
// sender's and on the receiver's link. A link carries one message at a time, the network between
// them any number. Messages of a rank to itself are free.
struct Network {
  double latency = 20e-6;
  double overhead = 1e-6;  // of the processor, for each send and each receive
  double seconds_per_byte = 1 / 1.25e9;
  // Of the processor, for each send and each receive: where it moves the bytes itself.
  double copy_seconds_per_byte = 0;
  // All ranks share one link, a bus: one message at a time, first come, first served; a multicast
  // is one message.
  bool is_bus = false;
  // Ranks take turns on so many cores, first come, first served; 0: each has a core of its own.
  int shared_cores = 0;
  // Indexed by Work. The caller calibrates all but the first, which is the unit itself.
  std::array<double, kWorkKinds> seconds_per_work = {1e-9, 1e-9, 50e-9, 2e-9, 200e-9, 1e-6};
  // Each message is late by a random time of up to this, of any order of magnitude.
  double jitter = 0;
};

// A network of the table of presets.
struct NamedNetwork {
  const char* name;
  const char* description;
  Network network;
};

// The table: predictions, command line and documentation iterate over it.
std::span<const NamedNetwork> networks();

// nullptr when there is no such network.
const NamedNetwork* find_network(std::string_view name);

}  // namespace delray::comm
