// Which triangles go to which ranks, where transformed triangles change rank.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "loadbalance/region_index.h"
#include "raster/distribute/cluster_messages.h"
#include "raster/distribute/rank_context.h"
#include "raster/pipeline/set_up.h"

namespace delray::raster {

// A few clusters, sorted by the ranks that their triangles go to.
struct SortedClusters {
  struct Parcel {
    int to;
    PackedClusters clusters = {};
  };
  std::vector<Parcel> parcels;
  std::vector<std::uint32_t> staying;  // clusters that touch the rank's own regions
  std::uint64_t culled = 0;            // triangles of clusters that do not stay

  static constexpr std::size_t kTypicalBytes = std::size_t{1} << 14;

  PackedClusters& for_rank(int rank) {
    for (Parcel& parcel : parcels)
      if (parcel.to == rank) return parcel.clusters;
    PackedClusters& clusters = parcels.emplace_back(Parcel{rank}).clusters;
    clusters.bytes.reserve(kTypicalBytes);
    return clusters;
  }
};

// Does the geometry of one cluster after the other. For one thread, whose memory it uses.
class TriangleSorter {
 public:
  // Refers to all of them; owners of regions are ranks.
  TriangleSorter(const RankContext& rank, const RegionDrawing& drawing,
                 const loadbalance::RegionIndex& regions);

  // Culls and transforms the drawing's cluster with this number. Triangles that are seen are packed
  // for the other ranks whose regions they touch.
  void sort(std::uint32_t number, SortedClusters& sorted);

 private:
  struct Memory;
  static Memory& memory_of_thread();

  void find_owners(const geometry::Rect& samples);
  void find_owners_near(const geometry::Rect& samples);
  bool find_receivers(const PreparedDraw& draw, const ClusterBlock& block, const Cluster& cluster);
  void pack(const PreparedDraw& draw, std::uint32_t number, SortedClusters& sorted);

  const RankContext& rank_;
  const int number_;  // the rank's
  const RegionDrawing& drawing_;
  const loadbalance::RegionIndex& regions_;
  Memory& memory_;
};

}  // namespace delray::raster
