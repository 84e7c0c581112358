#include <algorithm>
#include <array>

#include "loadbalance/internal/partitioners.h"

namespace delray::loadbalance {
namespace {

constexpr std::array kPartitioners = {
    Partitioner{"mahd", "rectangles of equal cost from a summed-area table (Mueller)",
                &internal::mahd},
    Partitioner{"interlaced", "many square blocks dealt out in turn, whatever they cost",
                &internal::interlaced},
};

}  // namespace

std::span<const Partitioner> partitioners() { return kPartitioners; }

const Partitioner* find_partitioner(std::string_view name) {
  const auto at =
      std::find_if(kPartitioners.begin(), kPartitioners.end(),
                   [name](const Partitioner& partitioner) { return partitioner.name == name; });
  return at == kPartitioners.end() ? nullptr : &*at;
}

}  // namespace delray::loadbalance
