// The table of networks: latency, processor overhead and bandwidth of common links, derived beside
// the figures, and the topologies that the same links can have.
#include "comm/network.h"

#include <algorithm>

#include "files/find_named.h"

namespace delray::comm {
namespace {

struct Link {
  double latency, overhead, bytes_per_second, copy_bytes_per_second;
};

NamedNetwork row(const char* name, const char* description, const Link& link,
                 Shape shape = Shape::crossbar, bool by_default = false) {
  NamedNetwork named{name, description, {}, by_default};
  Network& network = named.network;
  network.latency = link.latency;
  network.overhead = link.overhead;
  network.seconds_per_byte = 1 / link.bytes_per_second;
  network.copy_seconds_per_byte =
      link.copy_bytes_per_second > 0 ? 1 / link.copy_bytes_per_second : 0;
  network.topology.shape = shape;
  // A switch or router begins to pass a message on before all of it has come, after some 0.1 us.
  if (kind_of(shape).has_routes) network.hop_seconds = 0.1e-6;
  return named;
}

// Ethernet: a frame of 1538 bytes on the wire carries 1448 of TCP's payload, 0.9415 of the raw
// speed; kernel and processor move each byte once more on either side. InfiniBand HDR: 200 Gbit/s
// raw, what large messages reach of it; the adapter moves the bytes.
constexpr Link kGigabit = {30e-6, 5e-6, 117.7e6, 5e9};
constexpr Link k10Gigabit = {12e-6, 3e-6, 1.177e9, 5e9};
constexpr Link kHdr = {1.0e-6, 0.25e-6, 24.5e9, 0};
constexpr Link kFastEthernet = {60e-6, 5e-6, 11.77e6, 5e9};

// The bus by default is 100 Mbit/s Ethernet on one cable, the low-cost cluster that Kohout (2004)
// has in mind for the bus scheme. The topologies all have links of 10 Gbit/s, so that nothing but
// the topology differs between them and 10-gigabit-ethernet, the crossbar of these links.
const std::vector<NamedNetwork>& table() {
  static const std::vector<NamedNetwork> rows = {
      row("gigabit-ethernet", "1 Gbit/s, switched, TCP", kGigabit, Shape::crossbar, true),
      row("10-gigabit-ethernet", "10 Gbit/s, switched, TCP", k10Gigabit, Shape::crossbar, true),
      row("hdr-infiniband", "200 Gbit/s InfiniBand HDR, RDMA", kHdr, Shape::crossbar, true),
      row("shared-bus", "100 Mbit/s Ethernet, one cable that all listen to", kFastEthernet,
          Shape::bus, true),
      row("bus", "One cable of 10 Gbit/s that all listen to", k10Gigabit, Shape::bus),
      row("ring", "A ring of 10 Gbit/s links", k10Gigabit, Shape::ring),
      row("grid", "A square of 10 Gbit/s links", k10Gigabit, Shape::grid),
      row("torus", "A square of 10 Gbit/s links, closed to rings", k10Gigabit, Shape::torus),
      row("hypercube", "A hypercube of 10 Gbit/s links", k10Gigabit, Shape::hypercube),
      row("tree", "A binary tree of 10 Gbit/s links, ranks at its leaves", k10Gigabit, Shape::tree),
      row("fat-tree", "A binary tree with as many 10 Gbit/s links at each level as ranks",
          k10Gigabit, Shape::fat_tree),
  };
  return rows;
}

}  // namespace

std::span<const NamedNetwork> networks() { return table(); }

std::span<const NamedNetwork> default_networks() {
  const auto end = std::ranges::find_if(table(), [](const auto& row) { return !row.by_default; });
  return {table().begin(), end};
}

const NamedNetwork* find_network(std::string_view name) {
  return files::find_named(networks(), name);
}

}  // namespace delray::comm
