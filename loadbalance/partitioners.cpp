#include <algorithm>
#include <array>

#include "loadbalance/internal/partitioners.h"

namespace delray::loadbalance {
namespace {

constexpr std::array kPartitioners = {
    Partitioner{"mahd", "rectangles of equal cost from a summed-area table (Mueller)",
                &internal::mahd},
    Partitioner{"kd-split",
                "rectangles cut where the costs of both sides of a sweep line cross (Samanta)",
                &internal::kd_split},
    Partitioner{"graph", "regions of any shape that few primitives cross, grown on the grid (Kurc)",
                &internal::graph},
    Partitioner{"whitman", "ten leaves of a quadtree each, the fullest first (Whitman)",
                &internal::whitman},
    Partitioner{"whelan", "rectangles with equally many centroids, by median cut (Whelan)",
                &internal::whelan},
    Partitioner{"roble", "a grid whose full regions are halved and empty ones merged (Roble)",
                &internal::roble},
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
