#include "raster/internal/shade_gouraud.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include <hwy/cache_control.h>

namespace delray::raster {
namespace {

// Neighbours often have neighbouring numbers: sixteen of them share a cache line. The others are
// scattered by Fibonacci hashing (Knuth 1973, 6.4).
template <std::uint32_t kSlots>
std::uint32_t first_slot(std::uint32_t number) {
  constexpr std::uint32_t kGoldenRatio = 0x9E3779B9U;
  constexpr std::uint32_t kNear = 16;
  return ((number / kNear * kGoldenRatio) >> (32 - std::bit_width(kSlots / kNear - 1))) * kNear +
         number % kNear;
}

// Elements [begin, end), and some more.
void fill(std::uint16_t* begin, int count, std::uint16_t value) {
  const std::uint64_t four = value * std::uint64_t{0x0001000100010001};
  for (int i = 0; i < count; i += 16)
    for (int k = 0; k < 16; k += 4) std::memcpy(begin + i + k, &four, sizeof four);
}

}  // namespace

GouraudTile::GouraudTile() : index_(), turned_number_(), turned_() {
  std::fill_n(triangle_slots_, kSlots, kNone);
  std::fill_n(group_slots_, kSlots, kNone);
  numbers_.reserve(kTilePixels);
  next_.reserve(kTilePixels);
}

void GouraudTile::begin() {
  numbers_.clear();
  next_.clear();
  groups_.clear();
  last_cluster_ = kNothing;
}

std::size_t GouraudTile::group_of(std::uint32_t cluster) {
  std::uint32_t slot = first_slot<kSlots>(cluster);
  while (group_slots_[slot] != kNone && groups_[group_slots_[slot]].cluster != cluster)
    slot = (slot + 1) % kSlots;
  if (group_slots_[slot] == kNone) {
    group_slots_[slot] = static_cast<std::uint16_t>(groups_.size());
    groups_.push_back({cluster, kNone});
  }
  return group_slots_[slot];
}

// To numbers_ and to its cluster's group.
std::uint16_t GouraudTile::add_triangle(std::uint32_t number) {
  const auto index = static_cast<std::uint16_t>(numbers_.size());
  numbers_.push_back(number);
  if (const std::uint32_t cluster = number >> kClusterBits; cluster != last_cluster_) {
    last_cluster_ = cluster;
    last_group_ = group_of(cluster);
  }
  next_.push_back(groups_[last_group_].head);
  groups_[last_group_].head = index;
  return index;
}

std::uint16_t GouraudTile::index_of(std::uint32_t number) {
  std::uint32_t slot = first_slot<kSlots>(number);
  while (triangle_slots_[slot] != kNone && numbers_[triangle_slots_[slot]] != number)
    slot = (slot + 1) % kSlots;
  if (triangle_slots_[slot] == kNone) triangle_slots_[slot] = add_triangle(number);
  return triangle_slots_[slot];
}

std::uint64_t GouraudTile::find_triangles(const VisibilityTile& tile, const geometry::Rect& rect) {
  begin();
  const int i0 = rect.x0 % kTileSize, j0 = rect.y0 % kTileSize;
  const int i1 = i0 + rect.width(), j1 = j0 + rect.height();
  find_runs(tile, j0, j1, runs_);
  const std::uint64_t wanted = (~std::uint64_t{0} >> (kTileSize - rect.width())) << i0;
  std::uint64_t shown = 0;
  for (int j = j0; j < j1; ++j) {
    const std::uint32_t* const numbers = runs_.numbers() + j * kTileSize;
    std::uint16_t* const row = index_ + j * kTileSize;
    std::uint64_t starts = (runs_.changes_along[j] & wanted) | std::uint64_t{1} << i0;
    while (starts != 0) {
      const int i = std::countr_zero(starts);
      starts &= starts - 1;
      const int end = starts == 0 ? i1 : std::countr_zero(starts);
      std::uint16_t index = kNoTriangle;
      if (numbers[i] != kNothing) {
        index = runs_.changes_down[j] >> i & 1 ? index_of(numbers[i]) : row[i - kTileSize];
        shown += static_cast<std::uint64_t>(end - i);
      }
      fill(row + i, end - i, index);
    }
  }
  std::fill_n(triangle_slots_, kSlots, kNone);
  std::fill_n(group_slots_, kSlots, kNone);
  return shown;
}

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

// The vertices that the group uses, and those of them whose normal is to be turned, get the numbers
// from first_vertex on.
void GouraudTile::add_vertices(const FrameShading& frame, const scenes::Mesh& mesh,
                               const Members& members, std::uint32_t first_vertex) {
  const bool coloured = !mesh.colours.empty();
  const auto material = static_cast<std::size_t>(&shading::material(frame.shader, mesh.material) -
                                                 frame.shader.materials.data());
  const std::size_t number = 2 * material + static_cast<std::size_t>(coloured);
  if (blocks_.size() <= number) blocks_.resize(number + 1);
  if (blocks_[number] == nullptr) {
    // Geometric normals stay zero: the others say by themselves which side is lit.
    blocks_[number] = std::make_unique<VertexBlock>();
    blocks_[number]->points.coloured = coloured;
  }
  VertexBlock& block = *blocks_[number];
  if (block.count == 0) open_blocks_.push_back(number);
  shading::Points& points = block.points;
  const WorldVertices& world = world_vertices_;
  const std::size_t all = members.used_count + turned_count_;
  for (std::size_t i = 0; i < all; ++i) {
    const std::size_t v = i < members.used_count ? i : turned_[i - members.used_count];
    const float side = i < members.used_count ? 1.0F : -1.0F;
    const int n = block.count;
    points.position.set(n, {world.position[0][v], world.position[1][v], world.position[2][v]});
    points.normal.set(
        n, {side * world.normal[0][v], side * world.normal[1][v], side * world.normal[2][v]});
    if (coloured) {
      const glm::vec4& colour = mesh.colours[members.mesh_vertices[v]];
      points.colour.set(n, glm::vec3(colour));
      points.colour_alpha[n] = colour.w;
    }
    const auto vertex = first_vertex + static_cast<std::uint32_t>(i);
    block.vertices[n] = vertex;
    radiances_[vertex].w = world.has_normal[v];
    if (++block.count == kBlockSize) light(frame, number);
  }
}

void GouraudTile::look_up(const FrameShading& frame, Group& group) {
  const Cluster& cluster = frame.list.clusters[group.cluster];
  group.block = &frame.list.block_of(cluster);
  group.part = &group.block->clusters[cluster.part];
  hwy::Prefetch(group.part);
}

void GouraudTile::collect(const FrameShading& frame, const Group& group, Members& members) {
  const std::uint8_t* const corners = group.block->corners.data() + group.part->first_corner;
  const std::size_t stride = group.part->corner_stride();
  members.triangle_count = 0;
  for (std::uint16_t t = group.head; t != kNone; t = next_[t]) {
    Member& member = members.triangles[members.triangle_count++];
    member.triangle = t;
    member.place = static_cast<std::uint8_t>(numbers_[t] & (kClusterTriangles - 1));
    for (std::size_t k = 0; k < 3; ++k) {
      member.corner[k] = corners[k * stride + member.place];
      members.used[member.corner[k]] = 1;
    }
  }
  const scenes::Mesh& mesh = *frame.list.draws[frame.list.clusters[group.cluster].draw].mesh;
  const bool coloured = !mesh.colours.empty(), has_normals = !mesh.normals.empty();
  const std::uint32_t* const vertices = group.block->vertices.data() + group.part->first_vertex;
  std::size_t count = 0;
  for (std::size_t first = 0; first < group.part->vertices; first += 8) {
    std::uint64_t used = 0;
    std::memcpy(&used, members.used + first, sizeof used);
    std::memset(members.used + first, 0, sizeof used);
    for (; used != 0; used &= used - 1) {
      const std::size_t v = first + static_cast<std::size_t>(std::countr_zero(used)) / 8;
      const std::uint32_t vertex = vertices[v];
      members.number[v] = static_cast<std::uint8_t>(count);
      members.mesh_vertices[count++] = vertex;
      hwy::Prefetch(&mesh.positions[vertex]);
      if (has_normals) hwy::Prefetch(&mesh.normals[vertex]);
      if (coloured) hwy::Prefetch(&mesh.colours[vertex]);
    }
  }
  members.used_count = count;
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

void GouraudTile::set_up_member(const FrameShading& frame, const Cluster& cluster,
                                const MeshCluster& part, const Members& members,
                                const Member& member, std::uint32_t first_vertex) {
  const glm::uvec3 number(members.number[member.corner[0]], members.number[member.corner[1]],
                          members.number[member.corner[2]]);
  const Draw& draw = frame.list.draws[cluster.draw];
  const ShadedDraw& shaded = frame.draws[cluster.draw];
  const std::array<ScreenVertex, 3> v = {screen_vertices_[number.x], screen_vertices_[number.y],
                                         screen_vertices_[number.z]};
  const bool inside = !screen_vertices_.any_outside ||
                      (v[0].x != kOutside && v[1].x != kOutside && v[2].x != kOutside);
  PixelTriangle& triangle = triangles_[member.triangle];
  int x = 0, y = 0;
  bool counter_clockwise = false;
  if (inside) {
    counter_clockwise = screen_planes(frame.screen, v, triangle.a, triangle.b, triangle.c, x, y);
  } else {
    const Barycentrics planes =
        make_screen_barycentrics(frame.screen, shaded.to_view, draw.mesh->positions,
                                 draw.mesh->triangles[part.first + member.place]);
    std::copy_n(planes.a, 3, triangle.a);
    std::copy_n(planes.b, 3, triangle.b);
    std::copy_n(planes.c, 3, triangle.c);
    x = planes.x;
    y = planes.y;
    counter_clockwise = planes.counter_clockwise;
  }
  triangle.a[3] = triangle.b[3] = triangle.c[3] = 0;
  triangle.x = static_cast<float>(x);
  triangle.y = static_cast<float>(y);

  const bool front = counter_clockwise == (shaded.handedness > 0);
  glm::uvec3& corners = corners_[member.triangle];
  corners = first_vertex + number;
  if ((front && part.normals_agree) || draw.transformed != nullptr) return;
  const glm::uvec3& mesh_corners = draw.mesh->triangles[part.first + member.place];
  const glm::vec3 edges = cross_of_edges(*draw.mesh, mesh_corners);
  for (int k = 0; k < 3; ++k)
    if (normal_agrees(*draw.mesh, mesh_corners[k], edges) != front)
      corners[k] = first_vertex + turned(number[k], members.used_count);
}

void GouraudTile::set_up_group(const FrameShading& frame, const Group& group,
                               const Members& members) {
  const Cluster& cluster = frame.list.clusters[group.cluster];
  const Draw& draw = frame.list.draws[cluster.draw];
  const ShadedDraw& shaded = frame.draws[cluster.draw];
  const std::span which(members.mesh_vertices, members.used_count);
  transform(shaded.to_view, frame.screen, draw.mesh->positions, which, screen_vertices_);
  const auto first_vertex = static_cast<std::uint32_t>(radiances_.size());
  turned_count_ = 0;
  for (const Member& member : std::span(members.triangles, members.triangle_count))
    set_up_member(frame, cluster, *group.part, members, member, first_vertex);
  if (draw.transformed != nullptr) {
    for (const std::uint32_t vertex : which)
      radiances_.emplace_back(draw.transformed->radiances[vertex], 1.0F);
    return;
  }
  to_world(draw, shaded, which, world_vertices_);
  radiances_.resize(first_vertex + members.used_count + turned_count_);
  add_vertices(frame, *draw.mesh, members, first_vertex);
}

void GouraudTile::set_up_groups(const FrameShading& frame) {
  // Those with a texture, or without normals, are left to shade_pixel.
  std::erase_if(groups_, [&](const Group& group) {
    const Cluster& cluster = frame.list.clusters[group.cluster];
    const scenes::Mesh& mesh = *frame.list.draws[cluster.draw].mesh;
    if ((!mesh.normals.empty() || frame.list.draws[cluster.draw].transformed != nullptr) &&
        (without_textures_ ||
         shading::material(frame.shader, mesh.material).base_colour_texture == scenes::kNone))
      return false;
    for (std::uint16_t t = group.head; t != kNone; t = next_[t]) shade_one_by_one(t);
    return true;
  });
  for (Group& group : groups_) look_up(frame, group);
  for (const Group& group : groups_) {
    const std::size_t place = numbers_[group.head] & (kClusterTriangles - 1);
    const std::uint8_t* corners = group.block->corners.data() + group.part->first_corner + place;
    const std::size_t stride = group.part->corner_stride();
    for (std::size_t k = 0; k < 3; ++k) hwy::Prefetch(corners + k * stride);
    hwy::Prefetch(group.block->vertices.data() + group.part->first_vertex + place / 2);
  }
  for (std::size_t i = 0; i <= groups_.size(); ++i) {
    if (i < groups_.size()) collect(frame, groups_[i], members_[i % 2]);
    if (i > 0) set_up_group(frame, groups_[i - 1], members_[(i - 1) % 2]);
  }
}

void GouraudTile::set_colours() {
  for (std::size_t t = 0; t < numbers_.size(); ++t) {
    if (one_by_one_[t] != 0) continue;
    float normals = 1;
    for (int k = 0; k < 3; ++k) {
      const glm::vec4& radiance = radiances_[corners_[t][k]];
      std::memcpy(triangles_[t].colour[k], &radiance, sizeof triangles_[t].colour[k]);
      normals *= radiance.w;
    }
    if (normals == 0) shade_one_by_one(static_cast<std::uint16_t>(t));
  }
}

void GouraudTile::set_up_triangles(const FrameShading& frame) {
  if (triangles_.size() < numbers_.size()) {
    triangles_.resize(numbers_.size());
    corners_.resize(numbers_.size());
  }
  one_by_one_.assign(numbers_.size(), 0);
  any_one_by_one_ = false;
  radiances_.clear();
  set_up_groups(frame);
  for (const std::size_t block : open_blocks_)
    if (blocks_[block]->count > 0) light(frame, block);
  open_blocks_.clear();
  set_colours();
}

GouraudTile::LitCorners GouraudTile::light_corners(const FrameShading& frame,
                                                   std::span<const std::uint32_t> numbers) {
  begin();
  for (const std::uint32_t number : numbers) add_triangle(number);
  std::fill_n(group_slots_, kSlots, kNone);
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
  for (std::size_t t = 0; t < numbers.size(); ++t) {
    if (one_by_one_[t] != 0) {
      const SeenTriangle& triangle = seen_->get(frame, numbers[t]);
      for (int k = 0; k < 3; ++k) {
        lit_corners_[t][k] = static_cast<std::uint32_t>(lit_radiances_.size());
        lit_radiances_.push_back(triangle.radiance[k]);
      }
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& lit = lit_of_vertex_[corners_[t][k]];
      if (lit == kNothing) {
        lit = static_cast<std::uint32_t>(lit_radiances_.size());
        lit_radiances_.emplace_back(radiances_[corners_[t][k]]);
      }
      lit_corners_[t][k] = lit;
    }
  }
  return {lit_corners_, lit_radiances_};
}

template <class Colour>
std::uint64_t GouraudTile::shade(const FrameShading& frame, SeenTriangles& seen,
                                 const VisibilityTile& tile, const geometry::Rect& rect,
                                 const Window<Colour>& window) {
  const std::uint64_t shown = find_triangles(tile, rect);
  set_up_triangles(frame);
  const int i0 = rect.x0 % kTileSize, j0 = rect.y0 % kTileSize;
  const int width = rect.width();
  alignas(64) std::uint16_t index[kTileSize + kBlockSize + 1];
  alignas(64) Colour colours[kTileSize + kBlockSize];
  alignas(64) float depths[kTileSize + kBlockSize];
  // Rows of whole vectors go straight into the image, others might run over what is beside them.
  const bool whole = width % kBlockSize == 0;
  for (int j = 0; j < rect.height(); ++j) {
    const std::uint16_t* const row = index_ + (j0 + j) * kTileSize + i0;
    const std::size_t first = window.at(rect.x0, rect.y0 + j);
    Colour* const to = whole ? window.colour + first : colours;
    if (whole && !any_one_by_one_) {
      shade_row(triangles_, row, rect.x0, rect.y0 + j, width, to);
    } else {
      std::copy(row, row + width, index);
      std::fill(index + width, index + width + kBlockSize, kNoTriangle);
      for (int i = 0; i < width && any_one_by_one_; ++i)
        if (index[i] != kNoTriangle && one_by_one_[index[i]] != 0) index[i] = kNoTriangle;
      shade_row(triangles_, index, rect.x0, rect.y0 + j, width, to);
      for (int i = 0; i < width && any_one_by_one_; ++i)
        if (row[i] != kNoTriangle && one_by_one_[row[i]] != 0)
          shade_pixel(frame, seen, numbers_[row[i]], rect.x0 + i, rect.y0 + j, to[i]);
    }
    float* const depths_to = whole ? window.depth + first : depths;
    const std::int64_t* const keys = tile.key + (j0 + j) * kTileSize + i0;
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
