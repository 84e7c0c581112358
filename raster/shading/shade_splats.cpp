// Points of splats as shading wants them; and tiles of nothing but plain splats, whose colours are
// looked up: those of a row are asked for before they are used, as they are scattered in memory, or
// all of them while what they are of is at hand.
//
// Degenerate: a normal without a direction is replaced by the direction to the viewer.
#include "raster/shading/shade_splats.h"

#include <hwy/cache_control.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <utility>

#include "composite/fragment.h"
#include "raster/shading/tile_colours.h"

namespace delray::raster {
namespace {

using ShapeKind = scenes::Shape::Kind;

glm::vec3 to_world(const scenes::View& view, const glm::vec3& v) {
  return view.right * v.x + view.up * v.y + view.forward * v.z;
}

glm::vec3 unit(const glm::vec3& v, const glm::vec3& otherwise) {
  const float squared = glm::dot(v, v);
  return squared > 0 ? v * (1.0F / std::sqrt(squared)) : otherwise;
}

// The vertex of a plain splat. Of a cluster that was looked at before, that is at hand.
class VertexOfSplat {
 public:
  explicit VertexOfSplat(const DrawList& list) : list_(list) {}

  struct Found {
    const Draw* draw;
    std::uint32_t vertex;
  };
  Found of(std::uint32_t number) {
    const std::uint32_t cluster = number >> kClusterBits;
    if (cluster != cluster_) look_at(cluster);
    const std::uint32_t place = number & (kClusterTriangles - 1);
    return {draw_, consecutive_ ? first_ + place : draw_->mesh->triangles[first_ + place].x};
  }

 private:
  void look_at(std::uint32_t number) {
    cluster_ = number;
    const Cluster& cluster = list_.clusters[number];
    draw_ = &list_.draws[cluster.draw];
    const ClusterBlock& block = list_.block_of(cluster);
    const MeshCluster& part = block.clusters[cluster.part];
    consecutive_ = part.consecutive && part.vertices == part.count;
    first_ = consecutive_ ? block.vertices[part.first_vertex] : cluster.first;
  }

  const DrawList& list_;
  std::uint32_t cluster_ = kNothing;
  const Draw* draw_ = nullptr;
  std::uint32_t first_ = 0;
  bool consecutive_ = false;
};

image::RgbaF colour_of(const FrameShading& frame, const VertexOfSplat::Found& found) {
  const scenes::Mesh& mesh = *found.draw->mesh;
  glm::vec4 colour = shading::material(frame.shader, mesh.material).base_colour;
  if (!mesh.colours.empty()) colour *= mesh.colours[found.vertex];
  return premultiplied(glm::vec3(colour), 1);
}

}  // namespace

SeenPoint splat_point(const FrameShading& frame, std::uint32_t number, int x, int y) {
  const DrawList& list = frame.list;
  const Draw& draw = list.draws[list.cluster_of(number).draw];
  const SplatDraw& splats = frame.draws[list.cluster_of(number).draw].splats;
  const scenes::Mesh& mesh = *draw.mesh;
  const scenes::View& view = frame.screen.view;
  const std::uint32_t t = list.triangle_of(number);
  const glm::uvec3& corners = mesh.triangles[t];

  SplatHit hit;
  if (splats.is_spot()) {
    hit.position = splats.to_view(mesh.positions[corners.x]);
    if (!mesh.normals.empty()) hit.normal = splats.normal_to_view * mesh.normals[corners.x];
  } else {
    meets(frame.screen, make_splat(frame.screen, splats, mesh, t, number), x, y, hit);
  }
  SeenPoint seen;
  seen.material = static_cast<std::uint32_t>(&shading::material(frame.shader, mesh.material) -
                                             frame.shader.materials.data());
  shading::Point& point = seen.point;
  point.position = view.eye + to_world(view, hit.position);
  const glm::vec3 viewer = unit(view.viewpoint - point.position, -view.forward);
  point.normal = point.geometric_normal = unit(to_world(view, hit.normal), viewer);
  if (!mesh.colours.empty()) {
    point.colour = mesh.colours[corners.x];
    if (splats.kind == ShapeKind::line)
      point.colour += (mesh.colours[corners.y] - mesh.colours[corners.x]) * hit.along;
  }
  return seen;
}

bool is_plain(const shading::Shader& shader, const Draw& draw) {
  const scenes::Material& material = shading::material(shader, draw.mesh->material);
  return !draw.mesh->has_triangles() && draw.mesh->shape.kind != ShapeKind::line &&
         material.unlit && material.base_colour_texture == scenes::kNone;
}

template <class Colour>
std::uint64_t shade_plain_splats(const FrameShading& frame, const VisibilityTile& tile,
                                 const geometry::Rect& rect, const Window<Colour>& window) {
  VertexOfSplat vertex_of(frame.list);
  std::uint64_t shown = 0;
  for (int y = rect.y0; y < rect.y1; ++y) {
    const std::int64_t* const keys = tile.key + y % kTileSize * kTileSize + rect.x0 % kTileSize;
    const std::size_t first = window.at(rect.x0, y);
    VertexOfSplat::Found found[kTileSize];
    for (int i = 0; i < rect.width(); ++i) {
      window.depth[first + static_cast<std::size_t>(i)] = frame.shown_depth(keys[i]);
      const std::uint32_t number = number_of(keys[i]);
      found[i].draw = nullptr;
      if (number == kNothing) continue;
      found[i] = vertex_of.of(number);
      if (!found[i].draw->mesh->colours.empty())
        hwy::Prefetch(&found[i].draw->mesh->colours[found[i].vertex]);
    }
    for (int i = 0; i < rect.width(); ++i) {
      Colour& pixel = window.colour[first + static_cast<std::size_t>(i)];
      if (found[i].draw == nullptr) {
        pixel = {};
        continue;
      }
      ++shown;
      composite::store(colour_of(frame, found[i]), pixel);
    }
  }
  return shown;
}

void look_up_colours(const FrameShading& frame, VisibilityTile& tile, std::uint64_t drawing,
                     TileColours& colours) {
  if (colours.drawing != drawing) {
    std::fill(std::begin(colours.number), std::end(colours.number), kNothing);
    colours.drawing = drawing;
  }
  VertexOfSplat vertex_of(frame.list);
  for (std::uint32_t rest = std::exchange(tile.changed, 0); rest != 0; rest &= rest - 1) {
    const int block = std::countr_zero(rest);
    const int corner = block / VisibilityTile::kBlocksX * VisibilityTile::kBlockHeight * kTileSize +
                       block % VisibilityTile::kBlocksX * VisibilityTile::kBlockWidth;
    for (int j = 0; j < VisibilityTile::kBlockHeight; ++j) {
      const int first = corner + j * kTileSize;
      std::uint32_t others = 0;
      for (int i = first; i < first + VisibilityTile::kBlockWidth; ++i)
        others |= number_of(tile.key[i]) ^ colours.number[i];
      if (others == 0) continue;
      for (int i = first; i < first + VisibilityTile::kBlockWidth; ++i) {
        const std::uint32_t number = number_of(tile.key[i]);
        if (number == colours.number[i]) continue;
        colours.number[i] = number;
        const bool outside = tile.key[i] == 0;  // VisibilityTile::clear
        if (!outside) colours.colour[i] = colour_of(frame, vertex_of.of(number));
      }
    }
  }
}

template std::uint64_t shade_plain_splats(const FrameShading&, const VisibilityTile&,
                                          const geometry::Rect&, const Window<image::Rgba8>&);
template std::uint64_t shade_plain_splats(const FrameShading&, const VisibilityTile&,
                                          const geometry::Rect&, const Window<image::RgbaF>&);

}  // namespace delray::raster
