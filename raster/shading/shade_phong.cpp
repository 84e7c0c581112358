// Phong shading of a tile (Phong 1975): attributes of the triangles that it shows become planes,
// which are evaluated and shaded at sixteen pixels at a time.
//
// Pixels of a block are shaded kind by kind: one material, with or without colours of vertices.
// Attributes that no draw has take no time. Degenerate: triangles with planes that would lose
// digits are shaded pixel by pixel.
#include "raster/shading/shade_phong.h"

#include <algorithm>
#include <bit>

#include "raster/shading/shade_row.h"

namespace delray::raster {

// Attributes that no draw has take no memory, and no time.
void PhongTile::make_room(const FrameShading& frame) {
  const std::size_t room = triangles_.size() + kBlockSize;
  const auto make = [&](auto& planes, bool clip) {
    if (!clip)
      planes.clear();
    else if (planes.size() < room)
      planes.resize(room);
  };
  make(planes_.position, true);
  make(planes_.normal, true);
  make(planes_.geometric, true);
  make(kinds_, true);
  make(planes_.colour, frame.any_colours);
  make(planes_.uv, frame.texture_sets > 0);
  planes_.texture_sets = frame.texture_sets;
  make(planes_.tangent, frame.any_normal_maps);
}

template <class Row>
void PhongTile::set_up_values(const ClusterMembers& members, std::vector<ValuePlanes>& planes,
                              const Row& row) {
  for (std::size_t i = 0; i < members.vertices.size(); ++i) {
    const glm::vec4 values = row(members.vertices[i]);
    for (int k = 0; k < 4; ++k) rows_.row[i][k] = values[k];
  }
  raster::set_up_values(rows_, members.corners, members.group->count, triangles_.planes(),
                        members.group->first, planes.data());
}

void PhongTile::set_up_group(const FrameShading& frame, const ClusterMembers& members) {
  const TileGroups::Group& group = *members.group;
  const std::uint32_t number = frame.list.clusters[group.cluster].draw;
  const Draw& draw = frame.list.draws[number];
  const ShadedDraw& shaded = frame.draws[number];
  const scenes::Mesh& mesh = *draw.mesh;
  ClusterFacing facing;
  triangles_.set_up_planes(frame, members, 0, facing);
  to_world(draw, shaded, members.vertices, world_vertices_);
  set_up_points(world_vertices_, members.vertices.size(), members.corners, group.count,
                shaded.handedness, triangles_.planes(), group.first, planes_);

  if (!planes_.colour.empty() && !mesh.colours.empty())
    set_up_values(members, planes_.colour, [&](std::uint32_t v) { return mesh.colours[v]; });
  if (!planes_.uv.empty())
    set_up_values(members, planes_.uv, [&](std::uint32_t v) { return uv_row(mesh, v); });
  if (!planes_.tangent.empty()) {
    const auto tangent_of = [&](std::uint32_t v) {
      return mesh.tangents.empty() ? glm::vec4(0.0F) : tangent_in_world(draw, shaded, v);
    };
    set_up_values(members, planes_.tangent,
                  [&](std::uint32_t v) { return glm::vec4(glm::vec3(tangent_of(v)), 0); });
    for (std::size_t i = 0; i < group.count; ++i) {
      planes_.geometric[group.first + i].w =
          tangent_of(members.vertices[members.corners.of[0][i]]).w;
    }
  }

  const auto material = static_cast<std::uint32_t>(&shading::material(frame.shader, mesh.material) -
                                                   frame.shader.materials.data());
  std::fill_n(kinds_.begin() + group.first, group.count,
              4 * material + (shaded.blended ? 2U : 0U) + (mesh.colours.empty() ? 0U : 1U));
}

void PhongTile::shade_block(const FrameShading& frame, shading::LaneMask shown) {
  set_points(planes_, block_, points_);
  const scenes::View& view = frame.screen.view;
  shading::Vectors16 views;
  shading::directions_to(view.viewpoint, -view.forward, points_.position, views);
  const std::uint16_t* const triangle = block_.triangle;
  for (shading::LaneMask rest = shown; rest != 0;) {
    const std::uint32_t kind = kinds_[triangle[std::countr_zero(rest)]];
    shading::LaneMask lanes = 0;
    for (int i = 0; i < kBlockSize; ++i)
      lanes |= shading::LaneMask{kinds_[triangle[i]] == kind} << i;
    points_.coloured = kind % 2 != 0;
    shading::shade(frame.batch, kind / 4, points_, views, lanes & rest, {}, shaded_);
    rest &= ~lanes;
  }
}

template <class Colour>
std::uint64_t PhongTile::shade(const FrameShading& frame, SeenTriangles& seen,
                               const VisibilityTile& tile, const geometry::Rect& rect,
                               const Window<Colour>& window) {
  const std::uint64_t shown = triangles_.find(tile, rect);
  make_room(frame);
  triangles_.for_each_group(
      frame, [&](std::uint32_t draw) { return !frame.draws[draw].blended; },
      [&](const ClusterMembers& members) { set_up_group(frame, members); });
  triangles_.write<Colour>(frame, seen, tile, rect, window,
                           [&](const RowRuns& row, int x, int y, int count, Colour* pixels) {
                             const TriangleIndices indices = triangles_.indices();
                             for_each_block(row, indices, x, y, count, block_,
                                            [&](int i, shading::LaneMask lanes) {
                                              if (lanes != 0) shade_block(frame, lanes);
                                              store_colours(shaded_.colour, lanes, pixels + i);
                                            });
                           });
  return shown;
}

void PhongTile::colours(const FrameShading& frame, SeenTriangles& seen,
                        std::span<const SurfaceAt> surfaces, image::RgbaF* colours) {
  triangles_.colours(
      frame, seen, surfaces, block_,
      [&] {
        make_room(frame);
        triangles_.for_each_group(
            frame, [](std::uint32_t) { return true; },
            [&](const ClusterMembers& members) { set_up_group(frame, members); });
      },
      [&](shading::LaneMask lanes) { shade_block(frame, lanes); },
      [&](int i) {
        const bool blended = (kinds_[block_.triangle[i]] & 2) != 0;
        return premultiplied(shaded_.colour.get(i), blended ? shaded_.alpha[i] : 1.0F);
      },
      colours);
}

template std::uint64_t PhongTile::shade(const FrameShading&, SeenTriangles&, const VisibilityTile&,
                                        const geometry::Rect&, const Window<image::Rgba8>&);
template std::uint64_t PhongTile::shade(const FrameShading&, SeenTriangles&, const VisibilityTile&,
                                        const geometry::Rect&, const Window<image::RgbaF>&);

}  // namespace delray::raster
