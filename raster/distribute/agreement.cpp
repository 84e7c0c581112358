// One reduction tells whether all ranks hold the same random name and say that nothing has changed:
// the maximum of the names equals the complement of the maximum of their complements. A third
// maximum is the new name. Degenerate: a name of 0 is that of a rank that remembers nothing, and
// never holds.
#include "raster/distribute/agreement.h"

#include <algorithm>
#include <random>
#include <span>

#include "comm/collectives.h"

namespace delray::raster {

bool Agreement::holds(comm::Communicator& communicator, bool is_unchanged) {
  std::random_device random;
  const std::uint64_t name = std::uint64_t{random()} << 32 | random() | 1;
  const std::uint64_t mine = is_unchanged ? name_ : 0;
  // The highest name of all, how far the lowest is below the highest there may be, and a new one.
  std::uint64_t highest[] = {mine, ~mine, name};
  comm::all_reduce(communicator, std::span<std::uint64_t>(highest),
                   [](std::uint64_t a, std::uint64_t b) { return std::max(a, b); });
  if (highest[0] == ~highest[1] && highest[0] != 0) return true;
  name_ = highest[2];
  return false;
}

}  // namespace delray::raster
