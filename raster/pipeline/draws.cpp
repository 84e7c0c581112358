// Cuts runs of primitives into draws and clusters, ascending by primitive, so that a triangle's
// number in the list orders ties of depth as its number in the scene does. Degenerate: a list of
// too many clusters for 32 bits is refused.
#include "raster/pipeline/draws.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <unordered_map>

namespace delray::raster {
namespace {

// Appends the clusters of a piece. One that goes on where the last one ended fills its cluster up.
void append_clusters(const Piece& piece, std::uint32_t draw, DrawList& list) {
  const MeshClusters& clusters = *list.draws[draw].clusters;
  const std::uint32_t end = piece.first + piece.count;
  for (std::uint32_t t = piece.first; t < end;) {
    const ClusterBlock& block = *clusters.blocks[t >> kBlockBits];
    for (std::uint32_t part = part_with(block, t); part < block.clusters.size() && t < end;
         ++part) {
      const MeshCluster& cluster = block.clusters[part];
      const auto place = static_cast<std::uint16_t>(t - cluster.first);
      const std::uint32_t last = std::min(end, cluster.first + cluster.count);
      const auto place_end = static_cast<std::uint16_t>(last - cluster.first);
      Cluster* const before = list.clusters.empty() ? nullptr : &list.clusters.back();
      if (place > 0 && before != nullptr && before->draw == draw &&
          before->first == cluster.first && before->end == place)
        before->end = place_end;
      else
        list.clusters.push_back({draw, cluster.first, part, place, place_end,
                                 piece.primitive - piece.first + cluster.first,
                                 cluster.vertex_of_place_0()});
      t = last;
    }
  }
}

}  // namespace

HeldDraws::HeldDraws(MeshHolder* holder, std::vector<std::uint32_t>& draws)
    : holder_(holder), draws_(draws) {
  if (holder == nullptr) return;
  std::sort(draws.begin(), draws.end());
  draws.erase(std::unique(draws.begin(), draws.end()), draws.end());
  holder->hold(draws);
}

HeldDraws::~HeldDraws() {
  if (holder_ != nullptr) holder_->release(draws_);
}

std::vector<Piece> pieces_of(const scenes::Scene& scene,
                             std::span<const std::uint64_t> first_primitives, std::uint64_t begin,
                             std::uint64_t end) {
  std::vector<Piece> pieces;
  auto after = std::upper_bound(first_primitives.begin(), first_primitives.end(), begin);
  for (std::size_t i = after - first_primitives.begin(); i < first_primitives.size(); ++i) {
    const std::uint64_t instance_begin = first_primitives[i - 1];
    if (instance_begin >= end) break;
    const std::uint64_t low = std::max(begin, instance_begin);
    const std::uint64_t high = std::min(end, first_primitives[i]);
    if (low >= high) continue;
    const scenes::Instance& instance = scene.instances[i - 1];
    pieces.push_back({&scene.meshes[instance.mesh], &instance.transform,
                      static_cast<std::uint32_t>(low - instance_begin),
                      static_cast<std::uint32_t>(high - low), low});
  }
  return pieces;
}

DrawList make_draw_list(std::vector<Piece> pieces, SceneClusters* known) {
  const auto comes_before = [](const Piece& a, const Piece& b) {
    return a.primitive < b.primitive;
  };
  // Those of one's own come first, in order already.
  const auto middle = std::is_sorted_until(pieces.begin(), pieces.end(), comes_before);
  std::sort(middle, pieces.end(), comes_before);
  std::inplace_merge(pieces.begin(), middle, pieces.end(), comes_before);
  DrawList list;
  // An instance's pieces share a draw, in whatever order pieces of other draws lie between them.
  std::unordered_map<const glm::mat4x3*, std::uint32_t> draw_of;
  const auto find_draw = [&](const Piece& piece) {
    const auto [found, is_new] =
        draw_of.emplace(piece.transform, static_cast<std::uint32_t>(list.draws.size()));
    if (is_new) {
      MeshClusters* clusters = piece.clusters;
      if (clusters == nullptr && known != nullptr) clusters = known->of(*piece.mesh);
      if (clusters == nullptr) clusters = &list.own.emplace_back();
      list.draws.push_back({piece.mesh, piece.transform, clusters});
    }
    return found->second;
  };
  std::uint32_t draw = 0;
  for (const Piece& piece : pieces) {
    if (list.draws.empty() || list.draws[draw].transform != piece.transform)
      draw = find_draw(piece);
    list.draws[draw].clusters->make(*piece.mesh, piece.first, piece.count);
    append_clusters(piece, draw, list);
    list.triangles += piece.count;
  }
  if (list.clusters.size() >= (1U << (32 - kClusterBits)))
    throw std::length_error("one rank cannot rasterize more than 33 million clusters at once");
  return list;
}

std::vector<std::uint64_t> primitives_of(const DrawList& list,
                                         std::span<const std::uint32_t> numbers) {
  std::vector<std::size_t> next(list.clusters.size() + 1);
  for (const std::uint32_t number : numbers) ++next[(number >> kClusterBits) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<std::uint64_t> primitives(numbers.size());
  for (const std::uint32_t number : numbers)
    primitives[next[number >> kClusterBits]++] = list.primitive_of(number);
  next.pop_back();  // the others are the ends of clusters by now
  auto begin = primitives.begin();
  for (const std::size_t cluster_end : next) {
    const auto end = primitives.begin() + static_cast<std::ptrdiff_t>(cluster_end);
    std::sort(begin, end);
    begin = end;
  }
  return primitives;
}

}  // namespace delray::raster
