#include "raster/internal/shade_gouraud.h"

#include <algorithm>
#include <bit>

#include <hwy/cache_control.h>

namespace delray::raster {
namespace {

// Multipliers of Fibonacci hashing (Knuth 1973, 6.4).
constexpr std::uint32_t kGoldenRatio32 = 0x9E3779B9U;
constexpr std::uint64_t kGoldenRatio64 = 0x9E3779B97F4A7C15U;

}  // namespace

GouraudTile::GouraudTile() : triangle_slots_(kTriangleSlots) {}

std::uint64_t GouraudTile::find_triangles(const VisibilityTile& tile, const geometry::Rect& rect) {
  numbers_.clear();
  const auto index_of = [&](std::uint32_t number) -> std::uint32_t {
    constexpr int kShift = 32 - std::bit_width(kTriangleSlots - 1);
    std::uint32_t slot = (number * kGoldenRatio32) >> kShift;
    while (triangle_slots_[slot].number != number) {
      if (triangle_slots_[slot].number == kNothing) {
        triangle_slots_[slot] = {number, static_cast<std::uint32_t>(numbers_.size())};
        used_triangle_slots_.push_back(slot);
        numbers_.push_back(number);
        break;
      }
      slot = (slot + 1) % kTriangleSlots;
    }
    return triangle_slots_[slot].index;
  };
  std::uint64_t shown = 0;
  const int i0 = rect.x0 % kTileSize, j0 = rect.y0 % kTileSize;
  // Mostly a pixel shows what the one before it or above it shows.
  std::uint32_t last = kNothing;
  std::uint16_t index = kNoTriangle;
  for (int j = j0; j < j0 + rect.height(); ++j) {
    const std::int64_t* const keys = tile.key + j * kTileSize;
    const std::int64_t* const above = j == j0 ? keys : keys - kTileSize;
    for (int i = i0; i < i0 + rect.width(); ++i) {
      if (i % kBlockSize == 0 && i + kBlockSize <= i0 + rect.width()) {
        std::uint32_t different = 0;
        for (int k = 0; k < kBlockSize; ++k) different |= number_of(keys[i + k]) ^ last;
        if (different == 0) {
          std::fill_n(index_ + j * kTileSize + i, kBlockSize, index);
          shown += index == kNoTriangle ? 0 : kBlockSize;
          i += kBlockSize - 1;
          continue;
        }
      }
      const std::uint32_t number = number_of(keys[i]);
      if (number != last) {
        last = number;
        if (number == kNothing)
          index = kNoTriangle;
        else if (j > j0 && number == number_of(above[i]))
          index = index_[(j - 1) * kTileSize + i];
        else
          index = static_cast<std::uint16_t>(index_of(number));
      }
      index_[j * kTileSize + i] = index;
      shown += index != kNoTriangle;
    }
  }
  for (const std::uint32_t slot : used_triangle_slots_) triangle_slots_[slot].number = kNothing;
  used_triangle_slots_.clear();
  return shown;
}

// What triangles refer to is scattered in memory: it is asked for some time before it is needed.
void GouraudTile::look_up_triangles(const DrawList& list) {
  seen_in_.resize(numbers_.size());
  for (std::size_t t = 0; t < numbers_.size(); ++t) {
    seen_in_[t].draw = list.cluster_of(numbers_[t]).draw;
    seen_in_[t].triangle = list.triangle_of(numbers_[t]);
    hwy::Prefetch(&list.draws[seen_in_[t].draw].mesh->triangles[seen_in_[t].triangle]);
  }
}

void GouraudTile::look_up_corners(const DrawList& list, std::size_t first) {
  const std::size_t last = std::min(first + kBlockSize, seen_in_.size());
  for (std::size_t t = first; t < last; ++t) {
    SeenIn& seen = seen_in_[t];
    const scenes::Mesh& mesh = *list.draws[seen.draw].mesh;
    seen.corners = mesh.triangles[seen.triangle];
    for (int k = 0; k < 3; ++k) {
      hwy::Prefetch(&mesh.positions[seen.corners[k]]);
      if (!mesh.normals.empty()) hwy::Prefetch(&mesh.normals[seen.corners[k]]);
      if (!mesh.colours.empty()) hwy::Prefetch(&mesh.colours[seen.corners[k]]);
    }
  }
}

inline std::uint32_t GouraudTile::vertex_of(std::uint32_t draw, std::uint32_t vertex,
                                            std::uint32_t side, bool& is_new) {
  const std::uint64_t key = std::uint64_t{draw} << 33 | std::uint64_t{vertex} << 1 | side;
  const std::size_t last = vertex_slots_.size() - 1;
  // Neighbours often have neighbouring numbers: eight of them share cache lines.
  std::size_t slot = (((vertex >> 3) + draw) * kGoldenRatio64 >> vertex_slot_shift_) ^ (vertex & 7);
  const VertexSlot* const slots = vertex_slots_.data();
  while (slots[slot].key != key) {
    if (slots[slot].key == kNoVertex) {
      is_new = true;
      return remember_vertex(slot, key);
    }
    slot = (slot + 1) & last;
  }
  return slots[slot].vertex;
}

std::uint32_t GouraudTile::remember_vertex(std::size_t slot, std::uint64_t key) {
  const auto vertex = static_cast<std::uint32_t>(radiances_.size());
  vertex_slots_[slot] = {key, vertex};
  used_vertex_slots_.push_back(static_cast<std::uint32_t>(slot));
  radiances_.emplace_back();
  return vertex;
}

void GouraudTile::light(const FrameShading& frame, std::size_t number) {
  VertexBlock& block = *blocks_[number];
  const scenes::View& view = frame.screen.view;
  shading::Vectors16 views;
  shading::Shaded shaded;
  shading::directions_to(view.eye, -view.forward, block.points.position, views);
  shading::shade(frame.untextured_batch, static_cast<std::uint32_t>(number / 2), block.points,
                 views, shading::first_lanes(block.count), {}, shaded);
  for (int i = 0; i < block.count; ++i) radiances_[block.vertices[i]] = shaded.colour.get(i);
  block.count = 0;
}

// Corner k of triangle i of the block becomes `vertex`.
void GouraudTile::add_vertex(const FrameShading& frame, std::uint32_t material, int i, int k,
                             const scenes::Mesh& mesh, std::uint32_t mesh_vertex,
                             std::uint32_t vertex) {
  const bool coloured = !mesh.colours.empty();
  const std::size_t number = std::size_t{2} * material + static_cast<std::size_t>(coloured);
  if (blocks_.size() <= number) blocks_.resize(number + 1);
  if (blocks_[number] == nullptr) {
    blocks_[number] = std::make_unique<VertexBlock>();
    blocks_[number]->points.coloured = coloured;
  }
  VertexBlock& block = *blocks_[number];
  if (block.count == 0) open_blocks_.push_back(number);
  const int n = block.count;
  shading::Points& points = block.points;
  const auto copy = [&](const float(&from)[3][kBlockSize], shading::Vectors16& to) {
    to.x[n] = from[0][i];
    to.y[n] = from[1][i];
    to.z[n] = from[2][i];
  };
  copy(geometry_.position[k], points.position);
  copy(geometry_.geometric_normal, points.geometric_normal);
  copy(mesh.normals.empty() ? geometry_.geometric_normal : geometry_.normal[k], points.normal);
  if (coloured) {
    const glm::vec4& colour = mesh.colours[mesh_vertex];
    points.colour.set(n, glm::vec3(colour));
    points.colour_alpha[n] = colour.w;
  }
  block.vertices[n] = vertex;
  if (++block.count < kBlockSize) return;
  light(frame, number);
  open_blocks_.erase(std::find(open_blocks_.begin(), open_blocks_.end(), number));
}

void GouraudTile::add_corners(const FrameShading& frame, int i, std::size_t t) {
  const std::uint32_t draw = draw_of_lane_[i];
  const scenes::Mesh& mesh = *frame.list.draws[draw].mesh;
  const auto material = static_cast<std::uint32_t>(&shading::material(frame.shader, mesh.material) -
                                                   frame.shader.materials.data());
  if (!without_textures_ && frame.shader.materials[material].base_colour_texture != scenes::kNone) {
    textured_[t] = 1;
    any_textured_ = true;
    return;
  }
  const TransformedVertices* const transformed = frame.list.draws[draw].transformed;
  PixelTriangle& triangle = triangles_[t];
  triangle.a[3] = triangle.b[3] = triangle.c[3] = 0;
  triangle.x = static_cast<float>(geometry_.x[i]);
  triangle.y = static_cast<float>(geometry_.y[i]);
  for (int k = 0; k < 3; ++k) {
    triangle.a[k] = geometry_.a[k][i];
    triangle.b[k] = geometry_.b[k][i];
    triangle.c[k] = geometry_.c[k][i];
    // A vertex without a normal of its own is lit as its triangle is; any other is the same for all
    // triangles that have it on the same side of the viewer.
    const std::uint32_t mesh_vertex = seen_in_[t].corners[k];
    if (transformed != nullptr) {
      corners_[t][k] = static_cast<std::uint32_t>(radiances_.size());
      radiances_.push_back(transformed->radiances[mesh_vertex]);
      continue;
    }
    const bool own_normal = !mesh.normals.empty() && (geometry_.own_normal[k] >> i & 1) != 0;
    bool is_new = !own_normal;
    if (own_normal) {
      const std::uint32_t side = ~(geometry_.front[k] ^ geometry_.agree[k]) >> i & 1;
      corners_[t][k] = vertex_of(draw, mesh_vertex, side, is_new);
    } else {
      corners_[t][k] = static_cast<std::uint32_t>(radiances_.size());
      radiances_.emplace_back();
    }
    if (is_new) add_vertex(frame, material, i, k, mesh, mesh_vertex, corners_[t][k]);
  }
}

void GouraudTile::set_up_block(const FrameShading& frame, std::size_t first, int count) {
  for (int i = 0; i < count; ++i) {
    const SeenIn& seen = seen_in_[first + static_cast<std::size_t>(i)];
    const Draw& draw = frame.list.draws[seen.draw];
    if (draw_of_lane_[i] != seen.draw) block_.set_draw(i, draw, frame.draws[seen.draw]);
    draw_of_lane_[i] = seen.draw;
    block_.set_triangle(i, *draw.mesh, seen.corners);
  }
  compute_geometry(frame.screen, block_, geometry_);
  for (int i = 0; i < count; ++i) add_corners(frame, i, first + static_cast<std::size_t>(i));
}

void GouraudTile::set_up_triangles(const FrameShading& frame) {
  triangles_.resize(numbers_.size());
  corners_.resize(numbers_.size());
  textured_.assign(numbers_.size(), 0);
  any_textured_ = false;
  radiances_.clear();
  // Never full: a triangle has three corners.
  const std::size_t slots = std::bit_ceil(4 * numbers_.size() + 8);
  if (vertex_slots_.size() != slots) vertex_slots_.resize(slots);
  vertex_slot_shift_ = 64 - std::bit_width(slots - 1);
  look_up_triangles(frame.list);
  std::fill(std::begin(draw_of_lane_), std::end(draw_of_lane_), kNothing);
  constexpr std::size_t kAhead = 4 * kBlockSize;
  for (std::size_t first = 0; first < kAhead; first += kBlockSize)
    look_up_corners(frame.list, first);
  for (std::size_t first = 0; first < numbers_.size(); first += kBlockSize) {
    look_up_corners(frame.list, first + kAhead);
    set_up_block(frame, first,
                 static_cast<int>(std::min<std::size_t>(kBlockSize, numbers_.size() - first)));
  }
  for (const std::size_t block : open_blocks_) light(frame, block);
  open_blocks_.clear();
  for (const std::uint32_t slot : used_vertex_slots_) vertex_slots_[slot].key = kNoVertex;
  used_vertex_slots_.clear();

  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (textured_[t] != 0) continue;
    for (int k = 0; k < 3; ++k) {
      const glm::vec3& radiance = radiances_[corners_[t][k]];
      float(&colour)[4] = triangles_[t].colour[k];
      colour[0] = radiance.x;
      colour[1] = radiance.y;
      colour[2] = radiance.z;
    }
  }
}

GouraudTile::LitCorners GouraudTile::light_corners(const FrameShading& frame,
                                                   std::span<const std::uint32_t> numbers) {
  numbers_.assign(numbers.begin(), numbers.end());
  without_textures_ = true;
  set_up_triangles(frame);
  without_textures_ = false;
  return {corners_, radiances_};
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
    if (whole && !any_textured_) {
      shade_row(triangles_, row, rect.x0, rect.y0 + j, width, to);
    } else {
      std::copy(row, row + width, index);
      std::fill(index + width, index + width + kBlockSize, kNoTriangle);
      for (int i = 0; i < width && any_textured_; ++i)
        if (index[i] != kNoTriangle && textured_[index[i]] != 0) index[i] = kNoTriangle;
      shade_row(triangles_, index, rect.x0, rect.y0 + j, width, to);
      for (int i = 0; i < width && any_textured_; ++i)
        if (row[i] != kNoTriangle && textured_[row[i]] != 0)
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
