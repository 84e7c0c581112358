// Finds the ranks that a cluster's triangles go to in sort-middle (Molnar et al. 1994): by the
// cluster's bounds where these touch one rank's regions only, else by the box of each triangle.
// Triangles that would not be drawn go nowhere; boxes are found by vectors.
//
// A cluster that touches this rank's regions alone is not transformed here. O(triangles x owners).
// Degenerate: clusters that are outside, or show hidden sides only, go nowhere.
#include "raster/distribute/triangle_sorter.h"

#include <algorithm>
#include <limits>

#include "raster/distribute/cluster_messages.h"
#include "raster/pipeline/cull.h"
#include "raster/pipeline/samples.h"
#include "raster/pipeline/set_up.h"
#include "raster/pipeline/triangle_boxes.h"

namespace delray::raster {
namespace {

struct Memory {
  ScreenVertices vertices;
  TriangleBoxes boxes;
  ClusterPacker packer;
};
Memory& memory() {
  static thread_local Memory of_thread;
  return of_thread;
}

}  // namespace

// Of a cluster, and what is to be known for its triangles.
void TriangleSorter::find_owners(const geometry::Rect& samples) {
  const int n = rank_.options.supersampling;
  near_.clear();
  regions_.for_each_region(pixels_of(samples, n),
                           [&](const loadbalance::Region& region, const geometry::Rect&) {
                             near_.push_back({samples_of(region.rect, n), region.owner});
                           });
  std::ranges::sort(near_, {}, &loadbalance::Region::owner);
  find_owners_near(samples);
}

// Of a part of the cluster.
void TriangleSorter::find_owners_near(const geometry::Rect& samples) {
  constexpr std::size_t kFew = 16;
  if (near_.size() > kFew) {
    regions_.owners_of(pixels_of(samples, rank_.options.supersampling), owners_);
    return;
  }
  owners_.clear();
  for (const loadbalance::Region& region : near_) {
    if (!geometry::intersection(region.rect, samples).empty() &&
        (owners_.empty() || owners_.back() != region.owner))
      owners_.push_back(region.owner);
  }
}

// The triangle is for owners_. Returns whether this rank is one of them.
bool TriangleSorter::add_receivers(std::uint32_t place) {
  bool stays = false, travels = false;
  for (const int owner : owners_) {
    if (owner == rank_.number()) {
      stays = true;
      continue;
    }
    travels = true;
    std::size_t i = 0;
    while (i < receivers_used_ && receivers_[i].rank != owner) ++i;
    if (i == receivers_used_) {
      if (receivers_used_++ == receivers_.size()) receivers_.emplace_back();
      receivers_[i].rank = owner;
      receivers_[i].which.clear();
    }
    receivers_[i].which.push_back(static_cast<std::uint8_t>(places_.size()));
  }
  if (travels) places_.push_back(static_cast<std::uint8_t>(place));
  return stays;
}

// Whether anything is for this rank itself. What others get is in places_ and receivers_.
bool TriangleSorter::find_receivers(const PreparedDraw& draw, const ClusterBlock& block,
                                    const Cluster& cluster) {
  bool stays = false;
  places_.clear();
  receivers_used_ = 0;
  const bool one_owner = owners_.size() == 1;
  const MeshCluster& mesh_cluster = block.clusters[cluster.part];
  const ScreenVertices& vertices = memory().vertices;
  TriangleBoxes& boxes = memory().boxes;
  const ClusterOnScreen on_screen{rank_.screen, draw, block, mesh_cluster, vertices};
  if (!vertices.any_outside) find_boxes(on_screen, boxes);
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
    stays |= add_receivers(place);
  }
  return stays;
}

void TriangleSorter::pack(const PreparedDraw& draw, std::uint32_t number, SortedClusters& sorted) {
  if (places_.empty()) return;
  memory().packer.set(drawing_.frame(), draw, number, places_);
  for (const Receiver& receiver : std::span(receivers_).first(receivers_used_))
    memory().packer.pack(receiver.which, sorted.for_rank(receiver.rank));
}

void TriangleSorter::sort(std::uint32_t number, SortedClusters& sorted) {
  const Cluster& cluster = drawing_.frame().list.clusters[number];
  const PreparedDraw& draw = drawing_.draws()[cluster.draw];
  const ClusterBlock& block = drawing_.frame().list.block_of(cluster);
  const MeshCluster& mesh_cluster = block.clusters[cluster.part];
  const ClusterBounds bounds = bound(rank_.screen, draw, mesh_cluster.box);
  find_owners(bounds.pixels);
  if (bounds.outside || owners_.empty() ||
      shows_hidden_side_only(rank_.screen, draw, mesh_cluster, bounds)) {
    sorted.culled += cluster.end - cluster.begin;
    return;
  }
  if (owners_.size() == 1 && owners_[0] == rank_.number()) {
    sorted.staying.push_back(number);
    return;
  }
  transform(draw.to_view, rank_.screen, draw.draw->mesh->positions, block.vertices_of(mesh_cluster),
            memory().vertices);
  const bool stays = find_receivers(draw, block, cluster);
  if (stays)
    sorted.staying.push_back(number);
  else
    sorted.culled += cluster.end - cluster.begin - places_.size();
  pack(draw, number, sorted);
}

}  // namespace delray::raster
