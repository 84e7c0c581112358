// Which triangles go to which ranks, where transformed triangles change rank.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "loadbalance/region_index.h"
#include "raster/distribute/rank_context.h"
#include "raster/pipeline/set_up.h"

namespace delray::raster {

// A few clusters, sorted by the ranks that their triangles go to.
struct SortedClusters {
  struct Parcel {
    int to;
    std::uint64_t triangles = 0;
    std::vector<std::byte> bytes = {};
  };
  std::vector<Parcel> parcels;
  std::vector<std::uint32_t> staying;  // clusters that touch the rank's own regions
  std::uint64_t culled = 0;            // triangles of clusters that do not stay

  Parcel& parcel_to(int rank) {
    for (Parcel& parcel : parcels)
      if (parcel.to == rank) return parcel;
    return parcels.emplace_back(Parcel{rank});
  }
};

// Does the geometry of one cluster after the other. For one thread.
class TriangleSorter {
 public:
  // Refers to all of them; owners of regions are ranks.
  TriangleSorter(const RankContext& rank, const RegionDrawing& drawing,
                 const loadbalance::RegionIndex& regions)
      : rank_(rank), drawing_(drawing), regions_(regions) {}

  // Culls and transforms the drawing's cluster with this number. Triangles that are seen are packed
  // for the other ranks whose regions they touch.
  void sort(std::uint32_t number, SortedClusters& sorted);

 private:
  void find_owners(const geometry::Rect& samples);
  bool find_receivers(const PreparedDraw& draw, const ClusterBlock& block, const Cluster& cluster);
  void pack(const PreparedDraw& draw, std::uint32_t number, SortedClusters& sorted);

  const RankContext& rank_;
  const RegionDrawing& drawing_;
  const loadbalance::RegionIndex& regions_;
  std::vector<int> owners_;
  std::vector<std::uint8_t> places_, which_;
  std::vector<std::pair<int, std::uint8_t>> receivers_;  // and index into places_
};

}  // namespace delray::raster
