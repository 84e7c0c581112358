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

// What colours plain splats have. Of clusters that were looked at lately that is at hand: rows of
// pixels show the same few again and again, and the way from a number to a colour is long.
class PlainSplats {
 public:
  explicit PlainSplats(const FrameShading& frame) : frame_(frame) {
    for (Entry& entry : entries_) entry.cluster = kNothing;
  }

  struct Found {
    const scenes::Material* material = nullptr;
    const glm::vec4* of_vertex = nullptr;  // null: the material's alone

    image::RgbaF colour() const {
      const glm::vec4 colour =
          of_vertex != nullptr ? material->base_colour * *of_vertex : material->base_colour;
      return premultiplied(glm::vec3(colour), 1);
    }
  };
  Found of(std::uint32_t number) {
    const std::uint32_t cluster = number >> kClusterBits;
    Entry& entry = entries_[cluster % kEntries];
    if (entry.cluster != cluster) look_at(cluster, entry);
    if (entry.colours == nullptr) return {entry.material, nullptr};
    const std::uint32_t place = number & (kClusterTriangles - 1);
    return {entry.material,
            entry.colours + (entry.triangles == nullptr ? place : entry.triangles[place].x)};
  }

 private:
  static constexpr std::uint32_t kEntries = 64;
  struct Entry {
    std::uint32_t cluster;
    const scenes::Material* material;
    const glm::vec4* colours;     // null: there are none; from that of place 0 on if consecutive
    const glm::uvec3* triangles;  // from that of place 0 on; null: vertices are consecutive
  };

  void look_at(std::uint32_t number, Entry& entry) const {
    const DrawList& list = frame_.list;
    const Cluster& cluster = list.clusters[number];
    const scenes::Mesh& mesh = *list.draws[cluster.draw].mesh;
    entry = {number, &shading::material(frame_.shader, mesh.material), nullptr, nullptr};
    if (mesh.colours.empty()) return;
    entry.colours = mesh.colours.data();
    if (cluster.first_vertex != scenes::kNone) {
      entry.colours += cluster.first_vertex;
    } else {
      entry.triangles = mesh.triangles.data() + cluster.first;
    }
  }

  const FrameShading& frame_;
  Entry entries_[kEntries];
};

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
  PlainSplats splats(frame);
  std::uint64_t shown = 0;
  for (int y = rect.y0; y < rect.y1; ++y) {
    const std::int64_t* const keys = tile.key + y % kTileSize * kTileSize + rect.x0 % kTileSize;
    const std::size_t first = window.at(rect.x0, y);
    PlainSplats::Found found[kTileSize];
    for (int i = 0; i < rect.width(); ++i) {
      window.depth[first + static_cast<std::size_t>(i)] = frame.shown_depth(keys[i]);
      const std::uint32_t number = number_of(keys[i]);
      found[i] = {};
      if (number == kNothing) continue;
      found[i] = splats.of(number);
      if (found[i].of_vertex != nullptr) hwy::Prefetch(found[i].of_vertex);
    }
    for (int i = 0; i < rect.width(); ++i) {
      Colour& pixel = window.colour[first + static_cast<std::size_t>(i)];
      if (found[i].material == nullptr) {
        pixel = {};
        continue;
      }
      ++shown;
      composite::store(found[i].colour(), pixel);
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
  PlainSplats splats(frame);
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
        if (!outside) colours.colour[i] = splats.of(number).colour();
      }
    }
  }
}

template std::uint64_t shade_plain_splats(const FrameShading&, const VisibilityTile&,
                                          const geometry::Rect&, const Window<image::Rgba8>&);
template std::uint64_t shade_plain_splats(const FrameShading&, const VisibilityTile&,
                                          const geometry::Rect&, const Window<image::RgbaF>&);

}  // namespace delray::raster
