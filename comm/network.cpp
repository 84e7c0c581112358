// The table of networks: latency, processor overhead and bandwidth of common links, derived beside
// the figures.
#include "comm/network.h"

#include "files/find_named.h"

namespace delray::comm {
namespace {

struct Link {
  double latency, overhead, bytes_per_second, copy_bytes_per_second;
};

Network network_of(const Link& link, bool is_bus = false) {
  Network network;
  network.latency = link.latency;
  network.overhead = link.overhead;
  network.seconds_per_byte = 1 / link.bytes_per_second;
  network.copy_seconds_per_byte =
      link.copy_bytes_per_second > 0 ? 1 / link.copy_bytes_per_second : 0;
  network.is_bus = is_bus;
  return network;
}

// Ethernet: a frame of 1538 bytes on the wire carries 1448 of TCP's payload, 0.9415 of the raw
// speed; kernel and processor move each byte once more on either side. InfiniBand HDR: 200 Gbit/s
// raw, what large messages reach of it; the adapter moves the bytes. The bus is 100 Mbit/s Ethernet
// on one cable, the low-cost cluster that Kohout (2004) has in mind for the bus scheme.
const std::array kNetworks = {
    NamedNetwork{"gigabit-ethernet", "1 Gbit/s, switched, TCP",
                 network_of({30e-6, 5e-6, 117.7e6, 5e9})},
    NamedNetwork{"10-gigabit-ethernet", "10 Gbit/s, switched, TCP",
                 network_of({12e-6, 3e-6, 1.177e9, 5e9})},
    NamedNetwork{"hdr-infiniband", "200 Gbit/s InfiniBand HDR, RDMA",
                 network_of({1.0e-6, 0.25e-6, 24.5e9, 0})},
    NamedNetwork{"shared-bus", "100 Mbit/s Ethernet, one cable that all listen to",
                 network_of({60e-6, 5e-6, 11.77e6, 5e9}, true)},
};

}  // namespace

std::span<const NamedNetwork> networks() { return kNetworks; }

const NamedNetwork* find_network(std::string_view name) {
  return files::find_named(networks(), name);
}

}  // namespace delray::comm
