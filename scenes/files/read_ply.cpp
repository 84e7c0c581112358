// PLY (Turk 1994): elements of any properties in any order.
//
// Runs of rows are read at the same time, from text or binary: of vertices into the slots that
// their properties' names stand for, of faces as lists that are kept until all vertices are known.
// Where all faces are triangles, as the first one is, their corners need no lists. O(bytes).
#include <algorithm>
#include <atomic>
#include <optional>
#include <span>

#include "parallel/grow.h"
#include "parallel/parallel_for.h"
#include "scenes/files/for_each_block.h"
#include "scenes/files/ply_blocks.h"
#include "scenes/files/ply_faces.h"
#include "scenes/files/ply_header.h"
#include "scenes/files/ply_rows.h"
#include "scenes/files/ply_texture.h"
#include "scenes/files/ply_vertices.h"
#include "scenes/files/readers.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/origin.h"
#include "scenes/geometry/polygon.h"
#include "scenes/geometry/weld.h"

namespace delray::scenes::internal {
namespace {

class PlyReader {
 public:
  explicit PlyReader(const Source& source)
      : source_(source),
        bytes_(source.bytes()),
        header_(read_ply_header(source, bytes_, start_)),
        blocks_(file_) {
    if (header_.vertices >= kNone) source.fail("header", "a mesh is too large");
  }

  Scene run() {
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (!read_even_triangles(element)) {
        read_polygons(element);
      }
    }
    blocks_.require_end();
    if (!has_polygons_) source_.fail("", kNoTriangles);
    const glm::dvec3 origin = place_vertices();
    if (left_out_ > 0) source_.warn(std::to_string(left_out_) + " points and lines left out");
    normalize_or_clear(mesh_.normals);
    if (has_corner_uvs_) give_corners_their_uvs();
    triangulate();
    Scene scene = scene_of(std::move(mesh_), origin);
    if (!scene.meshes[0].uvs.empty()) add_ply_texture(source_, header_, scene);
    return scene;
  }

 private:
  void read_vertices(const PlyElement& element) {
    const PlyVertexReader reader(file_, element);
    const std::vector<PlyBlock> blocks = blocks_.next(element);
    single_precision_ = !file_.is_text() && reader.layout().type[VertexLayout::kX] == PlyType::f32;
    reader.allocate(element.count, mesh_, places_);
    boxes_.resize(blocks.size());
    for_each_block(blocks.size(), [&](std::size_t i) {
      boxes_[i] = reader.read(blocks[i], blocks[i].first, mesh_, places_);
    });
  }

  // Returns the origin.
  glm::dvec3 place_vertices() {
    geometry::Box3d box;
    for (const geometry::Box3d& part : boxes_) box.include(part);
    if (single_precision_) warn_if_coarse(source_, reach_of(box), glm::length(box.size()));
    const glm::dvec3 origin = origin_of(box);
    if (places_.empty()) {
      make_relative_to(origin, mesh_.positions);
    } else {
      mesh_.positions = relative_to(origin, places_);
      std::vector<glm::dvec3>().swap(places_);
    }
    return origin;
  }

  // Where there is nothing but faces that are triangles. False where there is, or where something
  // is wrong, of which whoever reads row by row tells what.
  bool read_even_triangles(const PlyElement& element) {
    const std::optional<EvenTriangles> faces = even_triangles(file_, element);
    if (!faces) return false;
    const std::vector<PlyBlock> blocks = blocks_.even(element);
    if (blocks.empty()) return false;
    source_.require_memory(element.count * sizeof(glm::uvec3));
    parallel::grow(mesh_.triangles, element.count);
    std::atomic<bool> good{true};
    parallel::parallel_for(0, blocks.size(), 1, [&](std::size_t i) {
      glm::uvec3* const to = mesh_.triangles.data() + blocks[i].first;
      if (good && !internal::read_even_triangles(file_, *faces, blocks[i], to)) good = false;
    });
    if (!good) {
      std::vector<glm::uvec3>().swap(mesh_.triangles);
      return false;
    }
    blocks_.move_to(blocks.back().begin + blocks.back().bytes);
    return has_polygons_ = true;
  }

  void read_polygons(const PlyElement& element) {
    const std::vector<PlyBlock> blocks = blocks_.next(element);
    const std::size_t before = polygons_.size();
    polygons_.resize(before + blocks.size());
    for_each_block(blocks.size(), [&](std::size_t i) {
      polygons_[before + i] = internal::read_polygons(file_, element, blocks[i]);
    });
    for (std::size_t i = before; i < polygons_.size(); ++i) {
      left_out_ += polygons_[i].left_out;
      has_polygons_ |= polygons_[i].any;
      has_corner_uvs_ |= !polygons_[i].uvs.empty();
    }
  }

  // Each block by itself, and then all behind each other.
  void triangulate() {
    if (polygons_.empty()) return;
    std::vector<std::vector<glm::uvec3>> parts(polygons_.size());
    for_each_block(parts.size(), [&](std::size_t i) {
      std::vector<glm::uvec3>& triangles = parts[i];
      triangles.reserve(polygons_[i].corners.size() / 3);
      const std::uint32_t* corner = polygons_[i].corners.data();
      for (const std::uint32_t size : polygons_[i].sizes) {
        triangulate_polygon({corner, size}, mesh_.positions, triangles);
        corner += size;
      }
      polygons_[i] = {};
    });
    std::vector<std::size_t> begins = {0};
    for (const auto& part : parts) begins.push_back(begins.back() + part.size());
    source_.require_memory(begins.back() * sizeof(glm::uvec3));
    parallel::grow(mesh_.triangles, begins.back());
    parallel::parallel_for(0, parts.size(), 1, [&](std::size_t i) {
      std::ranges::copy(parts[i], mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(begins[i]));
      std::vector<glm::uvec3>().swap(parts[i]);
    });
  }

  // Every corner gets a vertex of its own; equal ones are joined again.
  void give_corners_their_uvs() {
    Polygons all;
    for (Polygons& part : polygons_) {
      part.complete_uvs();
      all.corners.insert(all.corners.end(), part.corners.begin(), part.corners.end());
      all.sizes.insert(all.sizes.end(), part.sizes.begin(), part.sizes.end());
      all.uvs.insert(all.uvs.end(), part.uvs.begin(), part.uvs.end());
      part = {};
    }
    if (all.corners.size() >= kNone) source_.fail("", "a mesh is too large");
    Mesh mesh;
    mesh.uvs = std::move(all.uvs);
    for (const std::uint32_t v : all.corners) {
      mesh.positions.push_back(mesh_.positions[v]);
      if (!mesh_.normals.empty()) mesh.normals.push_back(mesh_.normals[v]);
      if (!mesh_.colours.empty()) mesh.colours.push_back(mesh_.colours[v]);
    }
    all.corners = weld(mesh);
    mesh_ = std::move(mesh);
    polygons_.clear();
    polygons_.push_back(std::move(all));
  }

  const Source& source_;
  files::FileBytes bytes_;
  std::string start_;  // the header is in it
  PlyHeader header_;
  PlyFile file_{source_, bytes_, header_};
  PlyBlocks blocks_;
  std::vector<geometry::Box3d> boxes_;  // of blocks of vertices
  std::vector<glm::dvec3> places_;      // positions as the file gives them, where floats do not do
  bool single_precision_ = false;       // of these
  Mesh mesh_;
  std::vector<Polygons> polygons_;  // of blocks, in the order of the file
  std::uint64_t left_out_ = 0;
  bool has_polygons_ = false, has_corner_uvs_ = false;
};

}  // namespace

Scene read_ply(const Source& source) { return PlyReader(source).run(); }

}  // namespace delray::scenes::internal
