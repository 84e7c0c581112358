// Collects what the triangles of a tile use, cluster by cluster, and writes the tile's rows.
//
// Vertices that are scattered in memory are asked for a group ahead of their use. A group that uses
// most of its cluster's vertices takes all of them; else those in use are renumbered. Degenerate:
// triangles that are clipped are set up one by one, and what cannot be shaded by vectors is shaded
// pixel by pixel.
#include "raster/shading/tile_triangles.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include <hwy/cache_control.h>

#include "raster/shading/shade_row.h"

namespace delray::raster {
namespace {

const MeshCluster& part_of(const FrameShading& frame, std::uint32_t cluster) {
  const Cluster& found = frame.list.clusters[cluster];
  return frame.list.block_of(found).clusters[found.part];
}

}  // namespace

std::uint64_t TileTriangles::find(const VisibilityTile& tile, const geometry::Rect& rect) {
  const int i0 = rect.x0 % kTileSize, j0 = rect.y0 % kTileSize;
  const int i1 = i0 + rect.width(), j1 = j0 + rect.height();
  find_runs(tile, j0, j1, runs_);
  groups_.clear();
  const std::uint64_t shown = add_runs(runs_, i0, j0, i1, j1, groups_);
  groups_.number_triangles();
  return shown;
}

std::vector<std::uint16_t> TileTriangles::set(std::span<const std::uint32_t> numbers) {
  std::vector<std::uint16_t> result(numbers.size());
  groups_.clear();
  for (const std::uint32_t number : numbers) groups_.add(number);
  groups_.number_triangles();
  for (std::size_t i = 0; i < numbers.size(); ++i) result[i] = indices().of(numbers[i]);
  return result;
}

// Vertices of the cluster that its triangles use get numbers.
void TileTriangles::number_vertices(std::span<const std::uint32_t> vertices,
                                    ClusterMembers& members) {
  for (const auto& row : members.corners.of)
    for (std::size_t i = 0; i < members.group->count; ++i) members.used[row[i]] = 1;
  std::size_t count = 0;
  for (std::size_t first = 0; first < vertices.size(); first += 8) {
    std::uint64_t used = 0;
    std::memcpy(&used, members.used + first, sizeof used);
    std::memset(members.used + first, 0, sizeof used);
    for (; used != 0; used &= used - 1) {
      const std::size_t v = first + static_cast<std::size_t>(std::countr_zero(used)) / 8;
      members.number[v] = static_cast<std::uint8_t>(count);
      members.chosen_vertices[count++] = vertices[v];
    }
  }
  for (auto& row : members.corners.of)
    for (std::size_t i = 0; i < members.group->count; ++i) row[i] = members.number[row[i]];
  members.vertices = std::span(members.chosen_vertices, count);
}

void TileTriangles::collect(const FrameShading& frame, const Group& group,
                            ClusterMembers& members) {
  members.group = &group;
  const Cluster& cluster = frame.list.clusters[group.cluster];
  const ClusterBlock& block = frame.list.block_of(cluster);
  const MeshCluster& part = block.clusters[cluster.part];
  const std::uint8_t* corners = block.corners.data() + part.first_corner;
  const std::uint8_t* const places = groups_.places().data() + group.first;
  for (auto& row : members.corners.of) {
    for (std::size_t i = 0; i < group.count; ++i) row[i] = corners[places[i]];
    corners += part.corner_stride();
  }
  members.corners.pad(group.count);
  // Most triangles have nearly all vertices.
  members.vertices = block.vertices_of(part);
  if (group.count < part.count - part.count / 4) number_vertices(members.vertices, members);
  const scenes::Mesh& mesh = *frame.list.draws[cluster.draw].mesh;
  const bool coloured = !mesh.colours.empty(), has_normals = !mesh.normals.empty();
  for (const std::uint32_t vertex : members.vertices) {
    hwy::Prefetch(&mesh.positions[vertex]);
    if (has_normals) hwy::Prefetch(&mesh.normals[vertex]);
    if (coloured) hwy::Prefetch(&mesh.colours[vertex]);
  }
}

void TileTriangles::set_up_clipped(const FrameShading& frame, const ClusterMembers& members,
                                   std::size_t member, ClusterFacing& facing) {
  const Draw& draw = frame.list.draws[frame.list.clusters[members.group->cluster].draw];
  const ShadedDraw& shaded = frame.draws[frame.list.clusters[members.group->cluster].draw];
  const Barycentrics planes =
      make_screen_barycentrics(frame.screen, shaded.to_view, draw.mesh->positions,
                               draw.mesh->triangles[triangle(frame, members, member)]);
  planes_.set(members.group->first + member, planes);
  const auto set = [&](ClusterMask& mask, bool value) {
    const std::uint64_t bit = std::uint64_t{1} << member % 64;
    mask[member / 64] = value ? mask[member / 64] | bit : mask[member / 64] & ~bit;
  };
  set(facing.counter_clockwise, planes.counter_clockwise);
  set(facing.proper, planes.proper);
}

void TileTriangles::set_up_planes(const FrameShading& frame, const ClusterMembers& members,
                                  std::uint32_t first_vertex, ClusterFacing& facing) {
  const Group& group = *members.group;
  const std::uint32_t draw = frame.list.clusters[group.cluster].draw;
  transform(frame.draws[draw].to_view, frame.screen, frame.list.draws[draw].mesh->positions,
            members.vertices, screen_vertices_);
  raster::set_up_planes(frame.screen, screen_vertices_, members.vertices.size(), members.corners,
                        group.count, first_vertex, planes_, group.first, facing);
  if (screen_vertices_.any_outside) {
    for (std::size_t i = 0; i < group.count; ++i)
      if (is_in(facing.outside, i)) set_up_clipped(frame, members, i, facing);
  }
  for (std::size_t i = 0; i < group.count; ++i)
    if (!is_in(facing.proper, i)) leave_to_shade_pixel(group.first + i);
}

// The data that groups refer to are scattered in memory.
void TileTriangles::ask_for(const FrameShading& frame) {
  for (const Group& group : groups_.groups()) hwy::Prefetch(&part_of(frame, group.cluster));
  for (const Group& group : groups_.groups()) {
    const ClusterBlock& block = frame.list.block_of(frame.list.clusters[group.cluster]);
    const MeshCluster& part = part_of(frame, group.cluster);
    const std::size_t place = groups_.places()[group.first];
    const std::uint8_t* corners = block.corners.data() + part.first_corner + place;
    for (std::size_t k = 0; k < 3; ++k) hwy::Prefetch(corners + k * part.corner_stride());
    hwy::Prefetch(block.vertices.data() + part.first_vertex + place / 2);
  }
}

void TileTriangles::for_each_group(const FrameShading& frame, Wanted clip, SetUp set_up) {
  left_.assign(size(), 0);
  any_left_ = false;
  ask_for(frame);
  int next = 0;
  members_[0].group = members_[1].group = nullptr;
  for (const Group& group : groups_.groups()) {
    const std::uint32_t draw = frame.list.clusters[group.cluster].draw;
    if (frame.draws[draw].splats.any() || !clip(draw)) {
      for (std::size_t t = group.first; t < std::size_t{group.first} + group.count; ++t) {
        for (auto& corner : planes_.corner) corner[t] = 0;
        leave_to_shade_pixel(t);
      }
      continue;
    }
    collect(frame, group, members_[next]);
    next = 1 - next;
    if (members_[next].group != nullptr) set_up(members_[next]);
    members_[next].group = nullptr;
  }
  if (members_[1 - next].group != nullptr) set_up(members_[1 - next]);
  // Vectors of triangles are read past the last one.
  for (auto& corner : planes_.corner)
    std::fill_n(corner + size(), TrianglePlanes::kSize - kTilePixels, 0);
}

std::uint64_t TileTriangles::left_of(const RowRuns& row, int count) const {
  std::uint64_t left = 0;
  for (int i = 0; i < count; ++i) {
    if ((row.shown >> i & 1) != 0 && is_left(indices().of(row.numbers[i])))
      left |= std::uint64_t{1} << i;
  }
  return left;
}

template <class Colour>
void TileTriangles::write(const FrameShading& frame, SeenTriangles& seen,
                          const VisibilityTile& tile, const geometry::Rect& rect,
                          const Window<Colour>& window, ShadeRow<Colour> shade_row) {
  const int i0 = rect.x0 % kTileSize, j0 = rect.y0 % kTileSize;
  const int width = rect.width();
  alignas(64) Colour colours[kTileSize + kBlockSize];
  alignas(64) float depths[kTileSize + kBlockSize];
  // Rows of whole vectors go straight into the image, others might run over what is beside them.
  const bool whole = width % kBlockSize == 0;
  for (int j = j0; j < j0 + rect.height(); ++j) {
    const int y = rect.y0 + (j - j0);
    const std::size_t first = window.at(rect.x0, y);
    Colour* const to = whole ? window.colour + first : colours;
    RowRuns row = row_of(runs_, i0, j);
    std::uint64_t left = any_left_ ? left_of(row, width) : 0;
    row.shown &= ~left;
    shade_row(row, rect.x0, y, width, to);
    for (; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      shade_pixel(frame, seen, row.numbers[i], rect.x0 + i, y, to[i]);
    }
    float* const depths_to = whole ? window.depth + first : depths;
    const std::int64_t* const keys = tile.key + j * kTileSize + i0;
    store_depths(keys, width, frame.distances ? &frame.screen.view : nullptr, depths_to);
    if (whole) continue;
    std::copy(colours, colours + width, window.colour + first);
    std::copy(depths, depths + width, window.depth + first);
  }
}

template void TileTriangles::write(const FrameShading&, SeenTriangles&, const VisibilityTile&,
                                   const geometry::Rect&, const Window<image::Rgba8>&,
                                   ShadeRow<image::Rgba8>);
template void TileTriangles::write(const FrameShading&, SeenTriangles&, const VisibilityTile&,
                                   const geometry::Rect&, const Window<image::RgbaF>&,
                                   ShadeRow<image::RgbaF>);

}  // namespace delray::raster
