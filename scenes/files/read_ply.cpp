// PLY (Turk 1994): elements of any properties in any order.
//
// Runs of rows are read at the same time, from text or binary: of vertices into the slots that
// their properties' names stand for, of faces as lists that are kept until all vertices are known.
// Where all faces are triangles, as the first one is, their corners need no lists. O(bytes).
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <numeric>
#include <span>

#include "parallel/grow.h"
#include "parallel/parallel_for.h"
#include "scenes/files/for_each_block.h"
#include "scenes/files/ply_blocks.h"
#include "scenes/files/ply_header.h"
#include "scenes/files/ply_rows.h"
#include "scenes/files/readers.h"
#include "scenes/files/texture_files.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/origin.h"
#include "scenes/geometry/polygon.h"
#include "scenes/geometry/weld.h"

namespace delray::scenes::internal {
namespace {

enum Slot : std::uint8_t { kX, kY, kZ, kNx, kNy, kNz, kR, kG, kB, kA, kU, kV, kSlots };

struct SlotName {
  std::string_view name;
  Slot slot;
};
constexpr std::array kSlotNames = {
    SlotName{"x", kX},         SlotName{"y", kY},         SlotName{"z", kZ},
    SlotName{"nx", kNx},       SlotName{"ny", kNy},       SlotName{"nz", kNz},
    SlotName{"normal_x", kNx}, SlotName{"normal_y", kNy}, SlotName{"normal_z", kNz},
    SlotName{"red", kR},       SlotName{"green", kG},     SlotName{"blue", kB},
    SlotName{"r", kR},         SlotName{"g", kG},         SlotName{"b", kB},
    SlotName{"alpha", kA},     SlotName{"a", kA},         SlotName{"diffuse_red", kR},
    SlotName{"u", kU},         SlotName{"v", kV},         SlotName{"diffuse_green", kG},
    SlotName{"s", kU},         SlotName{"t", kV},         SlotName{"diffuse_blue", kB},
    SlotName{"tx", kU},        SlotName{"ty", kV},        SlotName{"diffuse_alpha", kA},
    SlotName{"texture_u", kU}, SlotName{"texture_v", kV}, SlotName{"texture_s", kU},
    SlotName{"texture_t", kV}};

// How the values of a vertex become attributes.
struct VertexLayout {
  std::vector<Slot> slots;  // of each property; kSlots: none
  std::array<bool, kSlots> has{};
  std::array<double, kSlots> scale{};
  std::array<PlyType, kSlots> type{};
  std::array<std::size_t, kSlots> offset{};  // in a binary row without lists
  std::size_t stride = 0;                    // 0 with lists

  explicit VertexLayout(const PlyElement& element) {
    bool lists = false;
    for (const PlyProperty& property : element.properties) {
      const auto* known =
          std::find_if(kSlotNames.begin(), kSlotNames.end(),
                       [&](const SlotName& s) { return s.name == property.name && !has[s.slot]; });
      const bool used = known != kSlotNames.end() && !property.is_list();
      slots.push_back(used ? known->slot : kSlots);
      if (used) {
        has[known->slot] = true;
        scale[known->slot] = 1 / full_scale(property.value);
        type[known->slot] = property.value;
        offset[known->slot] = stride;
      }
      lists |= property.is_list();
      stride += size_of(property.value);
    }
    if (lists) stride = 0;
  }

  bool normals() const { return has[kNx] && has[kNy] && has[kNz]; }
  bool uvs() const { return has[kU] && has[kV]; }
  bool colours() const { return has[kR] && has[kG] && has[kB]; }
  // Positions that single precision holds as they are.
  bool single() const {
    return type[kX] == PlyType::f32 && type[kY] == PlyType::f32 &&
           (!has[kZ] || type[kZ] == PlyType::f32);
  }
  // Three floats behind each other, and nothing else of interest.
  bool bare() const {
    return stride > 0 && has[kZ] && single() && offset[kY] == offset[kX] + sizeof(float) &&
           offset[kZ] == offset[kY] + sizeof(float) && !normals() && !uvs() && !colours();
  }
};

// v of PLY grows upwards.
glm::vec2 usable_uv(double u, double v) {
  const glm::vec2 uv(u, 1 - v);
  return std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : glm::vec2(0);
}

// The polygons of a block.
struct Polygons {
  std::vector<std::uint32_t> corners, sizes;
  std::vector<glm::vec2> uvs;  // of corners, if any face has them
  std::uint64_t left_out = 0;  // points and lines
  bool any = false;            // has polygons

  // Corners without have (0, 0).
  void complete_uvs() { uvs.resize(corners.size(), glm::vec2(0)); }
};

// Reads faces, strips, and whatever else has properties.
class PolygonRows {
 public:
  PolygonRows(const PlyFile& file, const PlyElement& element, const PlyBlock& block)
      : element_(element),
        rows_(file, block),
        row_count_(block.rows),
        vertices_(file.header.vertices),
        is_face_(element.name == "face"),
        is_strip_(element.name == "tristrips") {}

  Polygons run() {
    for (std::uint64_t i = 0; i < row_count_; ++i) read_row();
    return std::move(to_);
  }

 private:
  void read_row() {
    rows_.start_row();
    const std::size_t before = to_.corners.size();
    face_uvs_.clear();
    for (const PlyProperty& property : element_.properties) {
      if (!property.is_list()) {
        rows_.next(property.value);
        continue;
      }
      const bool is_uv = is_face_ && property.name == "texcoord";
      rows_.next_list(property, is_uv ? face_uvs_ : values_);
      const bool is_index = property.name == "vertex_indices" || property.name == "vertex_index";
      if (is_index && is_face_) add_face();
      if (is_index && is_strip_) add_strips();
    }
    if (is_face_) add_corner_uvs(before);
  }

  std::uint32_t vertex(double value) const {
    if (!(value >= 0 && value < static_cast<double>(vertices_)) || value != std::floor(value)) {
      const double shown = std::isfinite(value) ? std::clamp(value, -1e18, 1e18) : -1;
      rows_.fail("there is no vertex " + std::to_string(static_cast<std::int64_t>(shown)) + " (" +
                 std::to_string(vertices_) + " vertices, from 0)");
    }
    return static_cast<std::uint32_t>(value);
  }

  void add_face() {
    for (const double value : values_) to_.corners.push_back(vertex(value));
    to_.sizes.push_back(static_cast<std::uint32_t>(values_.size()));
    if (values_.size() < 3) ++to_.left_out;
    to_.any |= values_.size() >= 3;
  }

  // Every second triangle of a strip has the other sense. -1 begins the next strip; where two
  // strips are joined by repeated vertices there is no triangle.
  void add_strips() {
    std::size_t length = 0;
    std::array<std::uint32_t, 3> last{};
    for (const double value : values_) {
      if (value == -1 || value == double{kNone}) {
        length = 0;
        continue;
      }
      last = {last[1], last[2], vertex(value)};
      if (++length < 3) continue;
      to_.any = true;
      if (last[0] == last[1] || last[1] == last[2] || last[2] == last[0]) continue;
      const std::size_t odd = (length - 3) % 2;
      to_.corners.insert(to_.corners.end(), {last[odd], last[1 - odd], last[2]});
      to_.sizes.push_back(3);
    }
  }

  // `before`: where the corners of the face begin.
  void add_corner_uvs(std::size_t before) {
    const std::size_t corners = to_.corners.size() - before;
    if (corners == 0 || (face_uvs_.empty() && to_.uvs.empty())) return;
    to_.uvs.resize(before, glm::vec2(0));
    for (std::size_t k = 0; k < corners; ++k) {
      const bool given = 2 * k + 1 < face_uvs_.size();
      to_.uvs.push_back(given ? usable_uv(face_uvs_[2 * k], face_uvs_[2 * k + 1]) : glm::vec2(0));
    }
  }

  const PlyElement& element_;
  PlyRows rows_;
  std::uint64_t row_count_, vertices_;
  bool is_face_, is_strip_;
  Polygons to_;
  std::vector<double> values_, face_uvs_;  // of a list
};

// Headers are rarely longer than the first megabyte.
PlyHeader read_header(const Source& source, const files::FileBytes& bytes, std::string& buffer) {
  for (std::uint64_t limit = std::uint64_t{1} << 20;; limit *= 8) {
    const bool all = limit >= bytes.size();
    const std::string_view start = bytes.read(0, all ? bytes.size() : limit, buffer);
    try {
      PlyHeader header = read_ply_header(source, start, bytes.size());
      if (all || header.size + 1 < start.size()) return header;
    } catch (const files::FileError&) {
      if (all) throw;
    }
  }
}

class PlyReader {
 public:
  explicit PlyReader(const Source& source)
      : source_(source),
        bytes_(source.bytes()),
        header_(read_header(source, bytes_, start_)),
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
    if (!has_polygons_) source_.fail("", kNoTriangles);
    const glm::dvec3 origin = place_vertices();
    if (left_out_ > 0) source_.warn(std::to_string(left_out_) + " points and lines left out");
    normalize_or_clear(mesh_.normals);
    if (has_corner_uvs_) give_corners_their_uvs();
    triangulate();
    Scene scene = scene_of(std::move(mesh_), origin);
    add_texture(scene);
    return scene;
  }

 private:
  void read_vertices(const PlyElement& element) {
    const VertexLayout layout(element);
    if (!layout.has[kX] || !layout.has[kY]) {
      source_.fail("header", "the vertices have no x or no y");
    }
    const std::vector<PlyBlock> blocks = blocks_.next(element);
    const bool binary = !file_.is_text();
    single_precision_ = binary && layout.type[kX] == PlyType::f32;
    const bool direct = binary && layout.single();
    allocate_vertices(layout, element.count, direct);
    boxes_.resize(blocks.size());
    for_each_block(blocks.size(), [&](std::size_t i) {
      if (!direct || !layout.bare() || !read_bare(layout, blocks[i], boxes_[i])) {
        read_vertices(element, layout, blocks[i], boxes_[i]);
      }
    });
  }

  void allocate_vertices(const VertexLayout& layout, std::uint64_t count, bool direct) {
    const bool normals = layout.normals(), uvs = layout.uvs(), colours = layout.colours();
    source_.require_memory(count *
                           (sizeof(glm::vec3) + (direct ? 0 : sizeof(glm::dvec3)) +
                            (normals ? sizeof(glm::vec3) : 0) + (uvs ? sizeof(glm::vec2) : 0) +
                            (colours ? sizeof(glm::vec4) : 0)));
    if (direct) {
      parallel::grow(mesh_.positions, count);
    } else {
      parallel::grow(places_, count);
    }
    if (normals) parallel::grow(mesh_.normals, count);
    if (uvs) parallel::grow(mesh_.uvs, count);
    if (colours) parallel::grow(mesh_.colours, count);
  }

  // False where a coordinate is wrong; whoever reads the block row by row says which.
  bool read_bare(const VertexLayout& layout, const PlyBlock& block, geometry::Box3d& all) {
    thread_local std::string buffer;
    const std::string_view bytes = bytes_.read(block.begin, block.bytes, buffer);
    if (bytes.size() != block.rows * layout.stride) return false;
    const bool swap = file_.swap();
    glm::vec3* const to = mesh_.positions.data() + block.first;
    const char* from = bytes.data() + layout.offset[kX];
    geometry::Box3 box;
    bool good = true;
    for (std::uint64_t i = 0; i < block.rows; ++i, from += layout.stride) {
      glm::vec3 p;
      if (swap) {
        for (int k = 0; k < 3; ++k) {
          p[k] = static_cast<float>(ply_value(from + k * sizeof(float), PlyType::f32, true));
        }
      } else {
        std::memcpy(&p, from, sizeof p);
      }
      constexpr auto kLargest = static_cast<float>(kLargestCoordinate);
      good &= std::abs(p.x) <= kLargest && std::abs(p.y) <= kLargest && std::abs(p.z) <= kLargest;
      box.include(p);
      to[i] = p;
    }
    if (good) all = {box.low, box.high};
    return good;
  }

  void read_vertices(const PlyElement& element, const VertexLayout& layout, const PlyBlock& block,
                     geometry::Box3d& box) {
    PlyRows rows(file_, block);
    const bool direct = places_.empty();
    const auto& has = layout.has;
    const auto& scale = layout.scale;
    std::array<double, kSlots + 1> v{};
    std::vector<double> values;
    for (std::uint64_t i = block.first; i < block.first + block.rows; ++i) {
      rows.start_row();
      for (std::size_t k = 0; k < layout.slots.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        if (property.is_list()) {
          rows.next_list(property, values);
        } else {
          v[layout.slots[k]] = rows.next(property.value);
        }
      }
      const glm::dvec3 p(v[kX], v[kY], v[kZ]);
      if (const char* wrong = wrong_with(p)) rows.fail(wrong);
      box.include(p);
      if (direct) {
        mesh_.positions[i] = p;
      } else {
        places_[i] = p;
      }
      if (!mesh_.normals.empty()) mesh_.normals[i] = glm::vec3(v[kNx], v[kNy], v[kNz]);
      if (!mesh_.uvs.empty()) mesh_.uvs[i] = usable_uv(v[kU], v[kV]);
      if (!mesh_.colours.empty()) {
        mesh_.colours[i] = linear_colour({v[kR] * scale[kR], v[kG] * scale[kG], v[kB] * scale[kB],
                                          has[kA] ? v[kA] * scale[kA] : 1.0});
      }
    }
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
    const auto is_polygons = [](const PlyElement& e) {
      return (e.name == "face" || e.name == "tristrips") && !e.properties.empty();
    };
    if (element.name != "face" || element.count == 0 || file_.is_text() ||
        std::ranges::count_if(header_.elements, is_polygons) != 1 ||
        std::ranges::count_if(element.properties, &PlyProperty::is_list) != 1) {
      return false;
    }
    std::size_t offset = 0;
    const auto list = std::ranges::find_if(element.properties, &PlyProperty::is_list);
    for (auto p = element.properties.begin(); p != list; ++p) offset += size_of(p->value);
    if (list->name != "vertex_indices" && list->name != "vertex_index") return false;
    const std::vector<PlyBlock> blocks = blocks_.even(element);
    if (blocks.empty()) return false;
    source_.require_memory(element.count * sizeof(glm::uvec3));
    parallel::grow(mesh_.triangles, element.count);
    std::atomic<bool> good{true};
    parallel::parallel_for(0, blocks.size(), 1, [&](std::size_t i) {
      if (good && !read_even_triangles(*list, offset, blocks[i])) good = false;
    });
    if (!good) {
      std::vector<glm::uvec3>().swap(mesh_.triangles);
      return false;
    }
    blocks_.move_to(blocks.back().begin + blocks.back().bytes);
    return has_polygons_ = true;
  }

  bool read_even_triangles(const PlyProperty& list, std::size_t offset, const PlyBlock& block) {
    thread_local std::string buffer;
    const std::string_view bytes = bytes_.read(block.begin, block.bytes, buffer);
    const std::size_t stride = bytes.size() / block.rows;
    const std::size_t each = size_of(list.value), length = size_of(list.length);
    const bool swap = file_.swap();
    const bool plain = !swap && (list.value == PlyType::i32 || list.value == PlyType::u32);
    const auto count = static_cast<std::uint32_t>(header_.vertices);
    glm::uvec3* const to = mesh_.triangles.data() + block.first;
    bool good = true;
    const char* row = bytes.data() + offset;
    for (std::uint64_t i = 0; i < block.rows; ++i, row += stride) {
      good &= length == 1 ? *row == 3 : ply_value(row, list.length, swap) == 3;
      glm::uvec3 t;
      if (plain) {
        std::memcpy(&t, row + length, sizeof t);  // negative ones become large
      } else {
        for (int k = 0; k < 3; ++k) {
          const double v = ply_value(row + length + k * each, list.value, swap);
          good &= v >= 0 && v < count && v == std::floor(v);
          t[k] = v >= 0 && v < count ? static_cast<std::uint32_t>(v) : 0;
        }
      }
      good &= t.x < count && t.y < count && t.z < count;
      to[i] = t;
    }
    return good;
  }

  void read_polygons(const PlyElement& element) {
    const std::vector<PlyBlock> blocks = blocks_.next(element);
    const std::size_t before = polygons_.size();
    polygons_.resize(before + blocks.size());
    for_each_block(blocks.size(), [&](std::size_t i) {
      polygons_[before + i] = PolygonRows(file_, element, blocks[i]).run();
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

  void add_texture(Scene& scene) const {
    if (header_.textures.empty() || scene.meshes[0].uvs.empty()) return;
    if (header_.textures.size() > 1) source_.warn("of its textures only the first is read");
    TextureFiles textures(source_, scene.textures);
    const std::uint32_t texture =
        textures.from_file(std::string(header_.textures[0]), TextureUse{true});
    scene.materials[0].base_colour_texture = texture;
    if (texture != kNone) scene.materials[0].base_colour = glm::vec4(1);
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
