#include "raster/internal/draws.h"

#include <algorithm>
#include <stdexcept>
#include <unordered_map>

#include "parallel/parallel_for.h"

namespace delray::raster {
namespace {

struct VertexRange {
  std::uint32_t low = 0xFFFFFFFFU, high = 0;
};

VertexRange merged(const VertexRange& a, const VertexRange& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

// The lowest and highest vertex that triangles [first, first + count) use.
VertexRange used_vertices(const scenes::Mesh& mesh, std::uint32_t first, std::uint32_t count) {
  constexpr std::size_t kGrain = 1 << 14;  // triangles: some ten microseconds
  return parallel::parallel_reduce(
      first, std::size_t{first} + count, kGrain, VertexRange{},
      [&](std::size_t begin, std::size_t end) {
        VertexRange range;
        for (std::size_t t = begin; t < end; ++t) {
          const glm::uvec3& v = mesh.triangles[t];
          range.low = std::min({range.low, v.x, v.y, v.z});
          range.high = std::max({range.high, v.x, v.y, v.z});
        }
        return range;
      },
      merged);
}

}  // namespace

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

DrawList make_draw_list(std::vector<Piece> pieces) {
  std::sort(pieces.begin(), pieces.end(),
            [](const Piece& a, const Piece& b) { return a.primitive < b.primitive; });
  DrawList list;
  // An instance's pieces share a draw, in whatever order pieces of other draws lie between them.
  std::unordered_map<const glm::mat4x3*, std::uint32_t> draw_of;
  std::vector<std::uint64_t> triangles_of;
  std::vector<std::uint32_t> draw_of_piece;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto [found, is_new] =
        draw_of.emplace(pieces[i].transform, static_cast<std::uint32_t>(list.draws.size()));
    if (is_new) {
      list.draws.push_back({pieces[i].mesh, pieces[i].transform, 0, 0});
      triangles_of.push_back(0);
    }
    const std::uint32_t draw = found->second;
    draw_of_piece.push_back(draw);
    triangles_of[draw] += pieces[i].count;
    list.triangles += pieces[i].count;

    // A piece that goes on where the last one ended fills its cluster up.
    std::uint32_t done = 0;
    if (!list.clusters.empty() && list.clusters.back().draw == draw &&
        list.clusters.back().first + list.clusters.back().count == pieces[i].first) {
      done = std::min(kClusterTriangles - list.clusters.back().count, pieces[i].count);
      list.clusters.back().count += done;
    }
    for (; done < pieces[i].count; done += kClusterTriangles)
      list.clusters.push_back(
          {draw, pieces[i].first + done, std::min(kClusterTriangles, pieces[i].count - done)});
  }
  if (list.clusters.size() >= (1U << (32 - kClusterBits)))
    throw std::length_error("one rank cannot rasterize more than four million clusters at once");

  std::vector<VertexRange> used(list.draws.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::uint32_t draw = draw_of_piece[i];
    const scenes::Mesh& mesh = *pieces[i].mesh;
    const auto all = static_cast<std::uint32_t>(mesh.positions.size());
    used[draw] = triangles_of[draw] == mesh.triangles.size()
                     ? VertexRange{0, all - 1}
                     : merged(used[draw], used_vertices(mesh, pieces[i].first, pieces[i].count));
  }
  for (std::size_t i = 0; i < list.draws.size(); ++i) {
    if (used[i].low > used[i].high) continue;
    list.draws[i].first_vertex = used[i].low;
    list.draws[i].vertices = used[i].high - used[i].low + 1;
  }
  return list;
}

}  // namespace delray::raster
