#include "raster/internal/shade_gouraud.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include <hwy/cache_control.h>

namespace delray::raster {
namespace {

const MeshCluster& part_of(const FrameShading& frame, std::uint32_t cluster) {
  const Cluster& found = frame.list.clusters[cluster];
  return frame.list.block_of(found).clusters[found.part];
}

}  // namespace

void GouraudTile::light(const FrameShading& frame, std::size_t number) {
  VertexBlock& block = *blocks_[number];
  const scenes::View& view = frame.screen.view;
  shading::Vectors16 views;
  shading::Shaded shaded;
  shading::directions_to(view.eye, -view.forward, block.points.position, views);
  shading::shade(frame.untextured_batch, static_cast<std::uint32_t>(number / 2), block.points,
                 views, shading::first_lanes(block.count), {}, shaded);
  for (int i = 0; i < block.count; ++i) {
    glm::vec4& radiance = radiances_[block.vertices[i]];
    radiance = glm::vec4(shaded.colour.get(i), radiance.w);
  }
  block.count = 0;
}

GouraudTile::VertexBlock& GouraudTile::block_of(std::size_t number, bool coloured) {
  if (blocks_.size() <= number) blocks_.resize(number + 1);
  if (blocks_[number] == nullptr) {
    // Geometric normals stay zero: the others say by themselves which side is lit.
    blocks_[number] = std::make_unique<VertexBlock>();
    blocks_[number]->points.coloured = coloured;
  }
  if (blocks_[number]->count == 0) open_blocks_.push_back(number);
  return *blocks_[number];
}

// The vertices that the group uses, and those of them whose normal is to be turned, get the numbers
// from first_vertex on.
void GouraudTile::add_vertices(const FrameShading& frame, const scenes::Mesh& mesh,
                               const Members& members, std::uint32_t first_vertex) {
  const bool coloured = !mesh.colours.empty();
  const auto material = static_cast<std::size_t>(&shading::material(frame.shader, mesh.material) -
                                                 frame.shader.materials.data());
  const std::size_t number = 2 * material + static_cast<std::size_t>(coloured);
  VertexBlock& block = block_of(number, coloured);
  shading::Points& points = block.points;
  const WorldVertices& world = world_vertices_;
  const std::size_t all = members.vertices.size() + turned_count_;
  for (std::size_t i = 0; i < all;) {
    const int n = block.count;
    // As many at a time as there is room for; turned ones one by one.
    const bool turned = i >= members.vertices.size();
    const std::size_t v = turned ? turned_[i - members.vertices.size()] : i;
    const auto room = static_cast<std::size_t>(kBlockSize - n);
    const std::size_t some = turned ? 1 : std::min(room, members.vertices.size() - i);
    const auto copy = [&](const float* from, shading::Floats16& to) {
      std::copy_n(from + v, some, to.lane + n);
    };
    copy(world.position[0], points.position.x);
    copy(world.position[1], points.position.y);
    copy(world.position[2], points.position.z);
    copy(world.normal[0], points.normal.x);
    copy(world.normal[1], points.normal.y);
    copy(world.normal[2], points.normal.z);
    if (turned) points.normal.set(n, -points.normal.get(n));
    for (std::size_t k = 0; k < some; ++k) {
      if (coloured) {
        const glm::vec4& colour = mesh.colours[members.vertices[v + k]];
        points.colour.set(n + static_cast<int>(k), glm::vec3(colour));
        points.colour_alpha[n + static_cast<int>(k)] = colour.w;
      }
      const std::size_t vertex = first_vertex + i + k;
      block.vertices[n + static_cast<int>(k)] = static_cast<std::uint32_t>(vertex);
      radiances_[vertex].w = world.has_normal[v + k];
      all_have_normals_ &= world.has_normal[v + k] != 0;
    }
    i += some;
    block.count += static_cast<int>(some);
    if (block.count == kBlockSize) light(frame, number);
  }
}

// Vertices of the cluster that its triangles use get numbers.
void GouraudTile::number_vertices(std::span<const std::uint32_t> vertices, Members& members) {
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

void GouraudTile::collect(const FrameShading& frame, const Group& group, Members& members) {
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

// The number of a used vertex with its normal turned, among those of the group.
std::uint32_t GouraudTile::turned(std::uint32_t used, std::size_t used_count) {
  std::uint8_t& number = turned_number_[used];
  if (number >= turned_count_ || turned_[number] != used) {
    number = static_cast<std::uint8_t>(turned_count_);
    turned_[turned_count_++] = used;
  }
  return static_cast<std::uint32_t>(used_count) + number;
}

// Of a triangle of the draw's mesh: its corners whose normals are on the side that is not seen.
void GouraudTile::turn_normals(const Draw& draw, const Members& members, std::size_t member,
                               std::uint32_t triangle, bool front, std::uint32_t first_vertex) {
  const glm::uvec3& corners = draw.mesh->triangles[triangle];
  const glm::vec3 edges = cross_of_edges(*draw.mesh, corners);
  for (int k = 0; k < 3; ++k) {
    if (normal_agrees(*draw.mesh, corners[k], edges) == front) continue;
    std::uint32_t& corner = planes_.corner[k][members.group->first + member];
    corner = first_vertex + turned(corner - first_vertex, members.vertices.size());
  }
}

void GouraudTile::set_up_clipped(const FrameShading& frame, const Group& group, std::size_t member,
                                 ClusterFacing& facing) {
  const Cluster& cluster = frame.list.clusters[group.cluster];
  const std::uint32_t t = cluster.first + groups_.places()[group.first + member];
  const scenes::Mesh& mesh = *frame.list.draws[cluster.draw].mesh;
  const Barycentrics planes = make_screen_barycentrics(
      frame.screen, frame.draws[cluster.draw].to_view, mesh.positions, mesh.triangles[t]);
  planes_.set(group.first + member, planes);
  const auto set = [&](ClusterMask& mask, bool value) {
    const std::uint64_t bit = std::uint64_t{1} << member % 64;
    mask[member / 64] = value ? mask[member / 64] | bit : mask[member / 64] & ~bit;
  };
  set(facing.counter_clockwise, planes.counter_clockwise);
  set(facing.proper, planes.proper);
}

void GouraudTile::set_up_group(const FrameShading& frame, Members& members) {
  const Group& group = *members.group;
  const Cluster& cluster = frame.list.clusters[group.cluster];
  const Draw& draw = frame.list.draws[cluster.draw];
  const ShadedDraw& shaded = frame.draws[cluster.draw];
  const std::span which = members.vertices;
  transform(shaded.to_view, frame.screen, draw.mesh->positions, which, screen_vertices_);
  const auto first_vertex = static_cast<std::uint32_t>(radiances_.size());
  ClusterFacing facing;
  set_up_planes(frame.screen, screen_vertices_, which.size(), members.corners, group.count,
                first_vertex, planes_, group.first, facing);
  if (screen_vertices_.any_outside)
    for (std::size_t i = 0; i < group.count; ++i)
      if (is_in(facing.outside, i)) set_up_clipped(frame, group, i, facing);
  for (std::size_t i = 0; i < group.count; ++i)
    if (!is_in(facing.proper, i)) shade_one_by_one(group.first + i);
  if (draw.transformed != nullptr) {
    for (const std::uint32_t vertex : which)
      radiances_.emplace_back(draw.transformed->radiances[vertex], 1.0F);
    return;
  }

  const bool agree = part_of(frame, group.cluster).normals_agree;
  turned_count_ = 0;
  for (std::size_t i = 0; i < group.count; ++i) {
    const bool front = is_in(facing.counter_clockwise, i) == (shaded.handedness > 0);
    if (!(front && agree))
      turn_normals(draw, members, i, cluster.first + groups_.places()[group.first + i], front,
                   first_vertex);
  }
  to_world(draw, shaded, which, world_vertices_);
  radiances_.resize(first_vertex + which.size() + turned_count_);
  add_vertices(frame, *draw.mesh, members, first_vertex);
}

// Those with a texture, or without normals, are left to shade_pixel.
bool GouraudTile::shaded_here(const FrameShading& frame, const Group& group) const {
  const Draw& draw = frame.list.draws[frame.list.clusters[group.cluster].draw];
  return (!draw.mesh->normals.empty() || draw.transformed != nullptr) &&
         (without_textures_ ||
          shading::material(frame.shader, draw.mesh->material).base_colour_texture ==
              scenes::kNone);
}

// What the groups refer to is scattered in memory.
void GouraudTile::ask_for(const FrameShading& frame) {
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

void GouraudTile::leave_triangles_without_normals() {
  for (std::size_t t = 0; t < groups_.places().size(); ++t)
    for (const auto& corner : planes_.corner)
      if (radiances_[corner[t]].w == 0) shade_one_by_one(t);
}

void GouraudTile::set_up_triangles(const FrameShading& frame) {
  const std::size_t count = groups_.places().size();
  one_by_one_.assign(count, 0);
  any_one_by_one_ = false;
  all_have_normals_ = true;
  radiances_.assign(1, glm::vec4(0, 0, 0, 1));
  ask_for(frame);
  int next = 0;
  members_[1].group = nullptr;
  for (const Group& group : groups_.groups()) {
    if (!shaded_here(frame, group)) {
      for (std::size_t t = group.first; t < std::size_t{group.first} + group.count; ++t) {
        for (auto& corner : planes_.corner) corner[t] = 0;
        shade_one_by_one(t);
      }
      continue;
    }
    collect(frame, group, members_[next]);
    next = 1 - next;
    if (members_[next].group != nullptr) set_up_group(frame, members_[next]);
    members_[next].group = nullptr;
  }
  if (members_[1 - next].group != nullptr) set_up_group(frame, members_[1 - next]);
  members_[1 - next].group = nullptr;
  for (const std::size_t block : open_blocks_)
    if (blocks_[block]->count > 0) light(frame, block);
  open_blocks_.clear();
  if (!all_have_normals_) leave_triangles_without_normals();
}

GouraudTile::LitCorners GouraudTile::light_corners(const FrameShading& frame,
                                                   std::span<const std::uint32_t> numbers) {
  groups_.clear();
  groups_of_lit_.resize(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) groups_of_lit_[i] = groups_.add(numbers[i]);
  groups_.number_triangles();
  without_textures_ = true;
  set_up_triangles(frame);
  without_textures_ = false;

  if (any_one_by_one_) {
    if (seen_ == nullptr) seen_ = std::make_unique<SeenTriangles>();
    seen_->clear();
  }
  lit_corners_.resize(numbers.size());
  lit_radiances_.clear();
  lit_of_vertex_.assign(radiances_.size(), kNothing);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::uint16_t t = groups_.index(groups_of_lit_[i], numbers[i]);
    if (one_by_one_[t] != 0) {
      const SeenTriangle& triangle = seen_->get(frame, numbers[i]);
      for (int k = 0; k < 3; ++k) {
        lit_corners_[i][k] = static_cast<std::uint32_t>(lit_radiances_.size());
        lit_radiances_.push_back(triangle.radiance[k]);
      }
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& lit = lit_of_vertex_[planes_.corner[k][t]];
      if (lit == kNothing) {
        lit = static_cast<std::uint32_t>(lit_radiances_.size());
        lit_radiances_.emplace_back(radiances_[planes_.corner[k][t]]);
      }
      lit_corners_[i][k] = lit;
    }
  }
  return {lit_corners_, lit_radiances_};
}

void GouraudTile::set_colours() {
  const std::size_t count = groups_.places().size();
  const std::size_t end = (count + kBlockSize - 1) / kBlockSize * kBlockSize;
  for (auto& corner : planes_.corner) std::fill(corner + count, corner + end, 0);
  if (triangles_.size() < end) triangles_.resize(end);
  set_up_colours(planes_, radiances_, count, triangles_.data());
}

template <class Colour>
std::uint64_t GouraudTile::shade(const FrameShading& frame, SeenTriangles& seen,
                                 const VisibilityTile& tile, const geometry::Rect& rect,
                                 const Window<Colour>& window) {
  const int i0 = rect.x0 % kTileSize, j0 = rect.y0 % kTileSize;
  const int width = rect.width();
  find_runs(tile, j0, j0 + rect.height(), runs_);
  const std::uint64_t shown =
      number_runs(runs_, i0, j0, i0 + width, j0 + rect.height(), groups_, run_triangles_);
  set_up_triangles(frame);
  set_colours();
  alignas(64) Colour colours[kTileSize + kBlockSize];
  alignas(64) float depths[kTileSize + kBlockSize];
  std::uint16_t others[kTileSize];
  // Rows of whole vectors go straight into the image, others might run over what is beside them.
  const bool whole = width % kBlockSize == 0;
  for (int j = j0; j < j0 + rect.height(); ++j) {
    const int y = rect.y0 + (j - j0);
    const std::size_t first = window.at(rect.x0, y);
    Colour* const to = whole ? window.colour + first : colours;
    const std::uint16_t* run = run_triangles_.of_row(j).data();
    const std::uint64_t starts = run_triangles_.starts[j];
    if (any_one_by_one_) {
      const int runs = std::popcount(starts);
      for (int i = 0; i < runs; ++i)
        others[i] = run[i] != kNoTriangle && one_by_one_[run[i]] != 0 ? kNoTriangle : run[i];
    }
    shade_row(triangles_, starts >> i0, any_one_by_one_ ? others : run, rect.x0, y, width, to);
    if (any_one_by_one_) {
      const std::uint32_t* const numbers = runs_.numbers() + j * kTileSize + i0;
      for (int i = 0; i < width; ++i) {
        if (i > 0) run += starts >> (i0 + i) & 1;
        if (*run != kNoTriangle && one_by_one_[*run] != 0)
          shade_pixel(frame, seen, numbers[i], rect.x0 + i, y, to[i]);
      }
    }
    float* const depths_to = whole ? window.depth + first : depths;
    const std::int64_t* const keys = tile.key + j * kTileSize + i0;
    store_depths(keys, width, frame.distances ? frame.screen.view.near : 0.0F, depths_to);
    if (whole) continue;
    std::copy(colours, colours + width, window.colour + first);
    std::copy(depths, depths + width, window.depth + first);
  }
  return shown;
}

template std::uint64_t GouraudTile::shade(const FrameShading&, SeenTriangles&,
                                          const VisibilityTile&, const geometry::Rect&,
                                          const Window<image::Rgba8>&);
template std::uint64_t GouraudTile::shade(const FrameShading&, SeenTriangles&,
                                          const VisibilityTile&, const geometry::Rect&,
                                          const Window<image::RgbaF>&);

}  // namespace delray::raster
