// Descriptions of networks: whatever the text, a network that can be predicted on, or FileError.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "comm/network_file.h"
#include "files/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace delray;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const comm::NamedNetwork network = comm::parse_network(text, "fuzz");
    if (!std::isfinite(network.network.latency) || network.network.latency < 0) std::abort();
  } catch (const files::FileError&) {
  }
  return 0;
}
