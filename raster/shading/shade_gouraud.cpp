// Gouraud shading of a tile (Gouraud 1971): the distinct vertices of the triangles that it shows
// are lit in blocks of sixteen, across clusters; radiances then become planes, evaluated row by
// row.
//
// A vertex whose normal points away from the side that is seen is lit once more with its normal
// turned. Textures and alpha are applied by pixel. O(triangles + vertices shown + pixels).
//
// Degenerate: triangles without normals or with planes that would lose digits are shaded pixel by
// pixel.
#include "raster/shading/shade_gouraud.h"

#include <algorithm>
#include <bit>

namespace delray::raster {
void GouraudTile::light(const FrameShading& frame, std::size_t number) {
  VertexBlock& block = *blocks_[number];
  const scenes::View& view = frame.screen.view;
  shading::Vectors16 views;
  shading::Shaded shaded;
  shading::directions_to(view.viewpoint, -view.forward, block.points.position, views);
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
                               const ClusterMembers& members, std::uint32_t first_vertex) {
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

// The number of a used vertex with its normal turned, among those of the group.
std::uint32_t GouraudTile::turned(std::uint32_t used, std::size_t used_count) {
  std::uint8_t& number = turned_number_[used];
  if (number >= turned_count_ || turned_[number] != used) {
    number = static_cast<std::uint8_t>(turned_count_);
    turned_[turned_count_++] = used;
  }
  return static_cast<std::uint32_t>(used_count) + number;
}

// The corners of a triangle of the draw's mesh whose normals are on the side that is not seen.
void GouraudTile::turn_normals(const Draw& draw, const ClusterMembers& members, std::size_t member,
                               std::uint32_t triangle, bool front, std::uint32_t first_vertex) {
  const glm::uvec3& corners = draw.mesh->triangles[triangle];
  const glm::vec3 edges = cross_of_edges(*draw.mesh, corners);
  for (int k = 0; k < 3; ++k) {
    if (normal_agrees(*draw.mesh, corners[k], edges) == front) continue;
    std::uint32_t& corner = triangles_.planes().corner[k][members.group->first + member];
    corner = first_vertex + turned(corner - first_vertex, members.vertices.size());
  }
}

void GouraudTile::set_up_group(const FrameShading& frame, const ClusterMembers& members) {
  const Cluster& cluster = frame.list.clusters[members.group->cluster];
  const Draw& draw = frame.list.draws[cluster.draw];
  const ShadedDraw& shaded = frame.draws[cluster.draw];
  const auto first_vertex = static_cast<std::uint32_t>(radiances_.size());
  ClusterFacing facing;
  triangles_.set_up_planes(frame, members, first_vertex, facing);
  set_up_textures(frame, members);
  if (draw.radiances != nullptr) {
    for (const std::uint32_t vertex : members.vertices)
      radiances_.emplace_back((*draw.radiances)[vertex], 1.0F);
    return;
  }

  const bool agree = frame.list.block_of(cluster).clusters[cluster.part].normals_agree;
  turned_count_ = 0;
  for (std::size_t i = 0; i < members.group->count; ++i) {
    const bool front = is_in(facing.counter_clockwise, i) == (shaded.handedness > 0);
    if (!(front && agree))
      turn_normals(draw, members, i, triangles_.triangle(frame, members, i), front, first_vertex);
  }
  to_world(draw, shaded, members.vertices, world_vertices_);
  radiances_.resize(first_vertex + members.vertices.size() + turned_count_);
  add_vertices(frame, *draw.mesh, members, first_vertex);
}

void GouraudTile::set_up_textures(const FrameShading& frame, const ClusterMembers& members) {
  const TileGroups::Group& group = *members.group;
  const std::uint32_t draw = frame.list.clusters[group.cluster].draw;
  const scenes::Mesh& mesh = *frame.list.draws[draw].mesh;
  const scenes::Material& material = shading::material(frame.shader, mesh.material);
  const bool blended = frame.draws[draw].blended;
  any_special_ |= blended || material.base_colour_texture != scenes::kNone;
  if (frame.texture_sets > 0 || frame.any_blended) {
    std::fill_n(surfaces_.begin() + group.first, group.count,
                Surface{static_cast<std::uint32_t>(&material - frame.shader.materials.data()),
                        material.base_colour_texture, blended});
  }
  if (blended && !mesh.colours.empty()) {  // whose alpha counts
    for (std::size_t i = 0; i < group.count; ++i) triangles_.leave_to_shade_pixel(group.first + i);
  }
  if (material.base_colour_texture == scenes::kNone) return;
  for (std::size_t i = 0; i < members.vertices.size(); ++i) {
    const glm::vec4 row = uv_row(mesh, members.vertices[i]);
    std::copy_n(&row.x, 4, uv_rows_.row[i]);
  }
  set_up_values(uv_rows_, members.corners, group.count, triangles_.planes(), group.first,
                uvs_.data());
}

// Into block_colours_ and block_alpha_.
void GouraudTile::shade_special(const FrameShading& frame, shading::LaneMask lanes) {
  set_values(colours_, {uvs_, frame.texture_sets}, block_, block_colours_, points_);
  std::fill_n(block_alpha_.lane, kBlockSize, 1.0F);
  const std::uint16_t* const triangle = block_.triangle;
  for (shading::LaneMask rest = lanes; rest != 0;) {
    const Surface surface = surfaces_[triangle[std::countr_zero(rest)]];
    shading::LaneMask same = 0;
    for (int i = 0; i < kBlockSize; ++i)
      same |= shading::LaneMask{surfaces_[triangle[i]] == surface} << i;
    same &= rest;
    rest &= ~same;
    if (surface.blended)
      shading::coverage(frame.batch, surface.material, points_, same, block_alpha_);
    if (surface.texture == scenes::kNone) continue;
    shading::sample(frame.shader.textures[surface.texture], points_, same, texels_);
    for (; same != 0; same &= same - 1) {
      const int i = std::countr_zero(same);
      block_colours_.set(i, block_colours_.get(i) * texels_.colour.get(i));
    }
  }
}

void GouraudTile::leave_triangles_without_normals() {
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (const auto& corner : triangles_.planes().corner)
      if (radiances_[corner[t]].w == 0) triangles_.leave_to_shade_pixel(t);
  }
}

// Triangles without normals are left to shade_pixel.
void GouraudTile::set_up_triangles(const FrameShading& frame) {
  const std::size_t room = triangles_.size() + kBlockSize;
  if (colours_.size() < room) colours_.resize(room);
  uvs_.resize(frame.texture_sets > 0 ? std::max(uvs_.size(), room) : 0);
  if (surfaces_.size() < room) surfaces_.resize(room);
  any_special_ = false;
  all_have_normals_ = true;
  radiances_.assign(1, glm::vec4(0, 0, 0, 1));
  triangles_.for_each_group(
      frame,
      [&](std::uint32_t number) {
        const Draw& draw = frame.list.draws[number];
        return !draw.mesh->normals.empty() || draw.radiances != nullptr;
      },
      [&](const ClusterMembers& members) { set_up_group(frame, members); });
  for (const std::size_t block : open_blocks_)
    if (blocks_[block]->count > 0) light(frame, block);
  open_blocks_.clear();
  if (!all_have_normals_) leave_triangles_without_normals();
}

GouraudTile::LitCorners GouraudTile::light_corners(const FrameShading& frame,
                                                   std::span<const std::uint32_t> numbers) {
  const std::vector<std::uint16_t> indices = triangles_.set(numbers);
  set_up_triangles(frame);
  if (triangles_.any_left()) {
    if (seen_ == nullptr) seen_ = std::make_unique<SeenTriangles>();
    seen_->clear();
  }
  lit_corners_.resize(numbers.size());
  lit_radiances_.clear();
  lit_of_vertex_.assign(radiances_.size(), kNothing);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (triangles_.is_left(indices[i])) {
      const SeenTriangle& triangle = seen_->get(frame, numbers[i]);
      for (int k = 0; k < 3; ++k) {
        lit_corners_[i][k] = static_cast<std::uint32_t>(lit_radiances_.size());
        lit_radiances_.push_back(triangle.radiance[k]);
      }
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = triangles_.planes().corner[k][indices[i]];
      std::uint32_t& lit = lit_of_vertex_[vertex];
      if (lit == kNothing) {
        lit = static_cast<std::uint32_t>(lit_radiances_.size());
        lit_radiances_.emplace_back(radiances_[vertex]);
      }
      lit_corners_[i][k] = lit;
    }
  }
  return {lit_corners_, lit_radiances_};
}

template <class Colour>
std::uint64_t GouraudTile::shade(const FrameShading& frame, SeenTriangles& seen,
                                 const VisibilityTile& tile, const geometry::Rect& rect,
                                 const Window<Colour>& window) {
  const std::uint64_t shown = triangles_.find(tile, rect);
  set_up_triangles(frame);
  set_up_colours(triangles_.planes(), radiances_, triangles_.size(), colours_.data());
  triangles_.write<Colour>(frame, seen, tile, rect, window,
                           [&](const RowRuns& row, int x, int y, int count, Colour* pixels) {
                             const TriangleIndices indices = triangles_.indices();
                             if (!any_special_) {
                               shade_row(colours_, indices, row, x, y, count, pixels);
                               return;
                             }
                             for_each_block(row, indices, x, y, count, block_,
                                            [&](int i, shading::LaneMask lanes) {
                                              if (lanes != 0) shade_special(frame, lanes);
                                              store_colours(block_colours_, lanes, pixels + i);
                                            });
                           });
  return shown;
}

void GouraudTile::colours(const FrameShading& frame, SeenTriangles& seen,
                          std::span<const SurfaceAt> surfaces, image::RgbaF* colours) {
  triangles_.colours(
      frame, seen, surfaces, block_,
      [&] {
        set_up_triangles(frame);
        set_up_colours(triangles_.planes(), radiances_, triangles_.size(), colours_.data());
      },
      [&](shading::LaneMask lanes) { shade_special(frame, lanes); },
      [&](int i) { return premultiplied(block_colours_.get(i), block_alpha_[i]); }, colours);
}

template std::uint64_t GouraudTile::shade(const FrameShading&, SeenTriangles&,
                                          const VisibilityTile&, const geometry::Rect&,
                                          const Window<image::Rgba8>&);
template std::uint64_t GouraudTile::shade(const FrameShading&, SeenTriangles&,
                                          const VisibilityTile&, const geometry::Rect&,
                                          const Window<image::RgbaF>&);

}  // namespace delray::raster
