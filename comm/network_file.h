// Networks described in files (docs/networks.md).
#pragma once

#include <string>
#include <string_view>

#include "comm/network.h"

namespace delray::comm {

// The network that a text, JSON of schema delray.network/1, describes:
//
//   {"schema": "delray.network/1", "name": "paragon", "description": "...",
//    "topology": "grid", "sides": [16, 64], "latency": 30e-6, "hop_latency": 40e-9,
//    "overhead": 5e-6, "bytes_per_second": 175e6, "copy_bytes_per_second": 90e6}
//
// Schema, topology, latency, overhead and bytes_per_second must be there. `file` is what errors
// call it; without a name it is called as that, less folders and suffix. Throws files::FileError
// (input) that names the line of text that is no JSON, or the key: what is missing, unknown, out of
// range, or no option of this topology.
NamedNetwork parse_network(std::string_view text, const std::string& file);

// Of a file. Throws the same, and where it cannot be read.
NamedNetwork read_network(const std::string& file);

// What parse_network reads back as the same network, to the last bit of each figure but those given
// as bytes per second, which agree to one part in 10^15. Jitter and prices of work are left out.
std::string network_text(const NamedNetwork& named);

// A row of the table by name, else the file of that name, which has a suffix or a folder. Throws as
// read_network, FileError (input) where it is neither.
NamedNetwork network_of(const std::string& name_or_file);

}  // namespace delray::comm
