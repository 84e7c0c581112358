// Finds the ranks that a cluster's triangles go to in sort-middle (Molnar et al. 1994): by the
// cluster's bounds where these touch one rank's regions only, else by the box of each triangle.
// Triangles that would not be drawn go nowhere; boxes are found by vectors.
//
// A cluster that touches this rank's regions alone is not transformed here. O(triangles x owners).
// Degenerate: clusters that are outside, or show hidden sides only, go nowhere.
#include "raster/distribute/triangle_sorter.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "raster/distribute/cluster_messages.h"
#include "raster/pipeline/cull.h"
#include "raster/pipeline/samples.h"
#include "raster/pipeline/set_up.h"
#include "raster/pipeline/triangle_boxes.h"

namespace delray::raster {

struct TriangleSorter::Memory {
  // A rank other than this, and which of `places` are for it.
  struct Receiver {
    int rank;
    std::vector<std::uint8_t> which;
  };

  ScreenVertices vertices;
  TriangleBoxes boxes;
  ClusterPacker packer;
  std::vector<loadbalance::Region> near;  // that the cluster touches, in samples, by owner
  std::vector<int> owners;                // of the cluster, or of the triangle at hand
  std::vector<std::uint8_t> places;       // of triangles that travel
  std::vector<Receiver> receivers;        // the first receivers_used; others are spare
  std::size_t receivers_used = 0;

  // `which` of the receiver with this number.
  std::vector<std::uint8_t>& places_for(int rank) {
    std::size_t i = 0;
    while (i < receivers_used && receivers[i].rank != rank) ++i;
    if (i == receivers_used) {
      if (receivers_used++ == receivers.size()) receivers.emplace_back();
      receivers[i].rank = rank;
      receivers[i].which.clear();
    }
    return receivers[i].which;
  }

  // The triangle is for `owners`. Returns whether rank `own` is one of them.
  bool add(std::uint32_t place, int own) {
    bool stays = false, travels = false;
    for (const int owner : owners) {
      if (owner == own) {
        stays = true;
      } else {
        travels = true;
        places_for(owner).push_back(static_cast<std::uint8_t>(places.size()));
      }
    }
    if (travels) places.push_back(static_cast<std::uint8_t>(place));
    return stays;
  }

  // All triangles that have pixels in `boxes` are for another rank.
  void add_shown(std::uint32_t begin, std::uint32_t end, int rank) {
    places.resize(end - begin);
    std::size_t count = 0;
    for (std::uint32_t place = begin; place < end; ++place) {
      places[count] = static_cast<std::uint8_t>(place);
      count += boxes.pixels[place] != TriangleBoxes::kCulled;
    }
    places.resize(count);
    if (count == 0) return;
    std::vector<std::uint8_t>& which = places_for(rank);
    which.resize(count);
    std::iota(which.begin(), which.end(), std::uint8_t{0});
  }
};

TriangleSorter::Memory& TriangleSorter::memory_of_thread() {
  static thread_local Memory memory;
  return memory;
}

TriangleSorter::TriangleSorter(const RankContext& rank, const RegionDrawing& drawing,
                               const loadbalance::RegionIndex& regions)
    : rank_(rank),
      number_(rank.number()),
      drawing_(drawing),
      regions_(regions),
      memory_(memory_of_thread()) {}

// Of a cluster, and what is to be known for its triangles.
void TriangleSorter::find_owners(const geometry::Rect& samples) {
  const int n = rank_.options.supersampling;
  memory_.near.clear();
  regions_.for_each_region(pixels_of(samples, n),
                           [&](const loadbalance::Region& region, const geometry::Rect&) {
                             memory_.near.push_back({samples_of(region.rect, n), region.owner});
                           });
  std::ranges::sort(memory_.near, {}, &loadbalance::Region::owner);
  find_owners_near(samples);
}

// Of a part of the cluster.
void TriangleSorter::find_owners_near(const geometry::Rect& samples) {
  constexpr std::size_t kFew = 16;
  if (memory_.near.size() > kFew) {
    regions_.owners_of(pixels_of(samples, rank_.options.supersampling), memory_.owners);
    return;
  }
  memory_.owners.clear();
  for (const loadbalance::Region& region : memory_.near) {
    if (!geometry::intersection(region.rect, samples).empty() &&
        (memory_.owners.empty() || memory_.owners.back() != region.owner))
      memory_.owners.push_back(region.owner);
  }
}

// Whether anything is for this rank itself. What others get is in the places and receivers
// of the memory.
bool TriangleSorter::find_receivers(const PreparedDraw& draw, const ClusterBlock& block,
                                    const Cluster& cluster) {
  bool stays = false;
  memory_.places.clear();
  memory_.receivers_used = 0;
  const bool one_owner = memory_.owners.size() == 1;
  const MeshCluster& mesh_cluster = block.clusters[cluster.part];
  const ScreenVertices& vertices = memory_.vertices;
  TriangleBoxes& boxes = memory_.boxes;
  const ClusterOnScreen on_screen{rank_.screen, draw, block, mesh_cluster, vertices};
  if (!vertices.any_outside) {
    find_boxes(on_screen, boxes);
    // Another rank, as clusters for this one alone stay.
    if (one_owner && !boxes.any_alone) {
      memory_.add_shown(cluster.begin, cluster.end, memory_.owners[0]);
      return false;
    }
  }
  for (std::uint32_t place = cluster.begin; place < cluster.end; ++place) {
    const bool alone = vertices.any_outside || boxes.pixels[place] == TriangleBoxes::kAlone;
    if (!alone && boxes.pixels[place] == TriangleBoxes::kCulled) continue;
    geometry::Rect box;
    if (alone) {
      box = {std::numeric_limits<int>::max(), std::numeric_limits<int>::max(), 0, 0};
      const SetUpOutcome outcome =
          set_up(on_screen, place, 0, [&](const ScreenTriangle&, const geometry::Rect& pixels) {
            box = {std::min(box.x0, pixels.x0), std::min(box.y0, pixels.y0),
                   std::max(box.x1, pixels.x1), std::max(box.y1, pixels.y1)};
          });
      if (outcome == SetUpOutcome::culled) continue;
    }
    if (!one_owner) find_owners_near(alone ? box : boxes.box(place));
    stays |= memory_.add(place, number_);
  }
  return stays;
}

void TriangleSorter::pack(const PreparedDraw& draw, std::uint32_t number, SortedClusters& sorted) {
  if (memory_.places.empty()) return;
  memory_.packer.set(drawing_.frame(), draw, number, memory_.places);
  for (const Memory::Receiver& receiver :
       std::span(memory_.receivers).first(memory_.receivers_used))
    memory_.packer.pack(receiver.which, sorted.for_rank(receiver.rank));
}

void TriangleSorter::sort(std::uint32_t number, SortedClusters& sorted) {
  const Cluster& cluster = drawing_.frame().list.clusters[number];
  const PreparedDraw& draw = drawing_.draws()[cluster.draw];
  const ClusterBlock& block = drawing_.frame().list.block_of(cluster);
  const MeshCluster& mesh_cluster = block.clusters[cluster.part];
  const ClusterBounds bounds = bound(rank_.screen, draw, mesh_cluster.box);
  find_owners(bounds.pixels);
  if (bounds.outside || memory_.owners.empty() ||
      shows_hidden_side_only(rank_.screen, draw, mesh_cluster, bounds)) {
    sorted.culled += cluster.end - cluster.begin;
    return;
  }
  if (memory_.owners.size() == 1 && memory_.owners[0] == number_) {
    sorted.staying.push_back(number);
    return;
  }
  transform(draw.to_view, rank_.screen, draw.draw->mesh->positions, block.vertices_of(mesh_cluster),
            memory_.vertices);
  const bool stays = find_receivers(draw, block, cluster);
  if (stays)
    sorted.staying.push_back(number);
  else
    sorted.culled += cluster.end - cluster.begin - memory_.places.size();
  pack(draw, number, sorted);
}

}  // namespace delray::raster
