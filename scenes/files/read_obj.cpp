// OBJ (Wavefront): vertices, texture coordinates, normals and polygons of them.
//
// The file is passed over twice: indices may point to vertices that come later. Corners of equal
// indices share a vertex; a hash table finds it.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <map>
#include <optional>
#include <set>

#include "files/read_file.h"
#include "scenes/files/growth_watch.h"
#include "scenes/files/read_mtl.h"
#include "scenes/files/readers.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/noise.h"
#include "scenes/geometry/origin.h"
#include "scenes/geometry/polygon.h"
#include "scenes/geometry/weld.h"

namespace delray::scenes::internal {
namespace {

using Counts = std::array<std::int64_t, 3>;  // of v, vt and vn
constexpr std::array<std::string_view, 3> kKeys = {"v", "vt", "vn"};
constexpr std::array kWhat = {"vertex", "texture coordinate", "normal"};

// A corner of a face: numbers of its position, texture coordinate and normal, from 0; kNone: none.
using Corner = std::array<std::uint32_t, 3>;

// The vertex of each corner met so far, in each mesh.
class CornerTable {
 public:
  // The vertex of `corner` in a mesh; `next` if it is new, which it is no longer then.
  std::uint32_t find(std::uint32_t mesh, const Corner& corner, std::uint32_t next) {
    if (2 * (count_ + 1) > slots_.size()) grow();
    Entry& entry = slots_[slot_of(mesh, corner)];
    if (entry.vertex == kNone) {
      entry = {mesh, next, corner};
      ++count_;
    }
    return entry.vertex;
  }

 private:
  struct Entry {
    std::uint32_t mesh = kNone, vertex = kNone;
    Corner corner{};
  };
  std::size_t slot_of(std::uint32_t mesh, const Corner& corner) const {
    const auto pair = [](std::uint64_t a, std::uint32_t b) { return a << 32 | b; };
    const std::uint64_t hash = scatter(scatter(pair(corner[0], corner[1])) ^ pair(corner[2], mesh));
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash & mask;
    while (slots_[slot].vertex != kNone &&
           (slots_[slot].corner != corner || slots_[slot].mesh != mesh)) {
      slot = (slot + 1) & mask;
    }
    return slot;
  }
  void grow() {
    std::vector<Entry> old(std::max<std::size_t>(1024, 2 * slots_.size()));
    std::swap(old, slots_);
    for (const Entry& entry : old) {
      if (entry.vertex != kNone) slots_[slot_of(entry.mesh, entry.corner)] = entry;
    }
  }

  std::vector<Entry> slots_;
  std::size_t count_ = 0;
};

class ObjReader {
 public:
  explicit ObjReader(const Source& source) : source_(source), textures_(source, scene_.textures) {}

  Scene run() {
    read_vertices();
    choose_origin();
    read_faces();
    if (scene_.meshes.empty()) source_.fail("", kNoTriangles);
    if (left_out_ > 0) source_.warn(std::to_string(left_out_) + " points and lines left out");
    if (free_forms_ > 0) {
      source_.warn(std::to_string(free_forms_) + " free-form curves and surfaces left out");
    }
    for (std::uint32_t m = 0; m < scene_.meshes.size(); ++m) {
      Mesh& mesh = scene_.meshes[m];
      normalize_or_clear(mesh.normals);
      weld(mesh);
      scene_.instances.push_back({m, glm::mat4x3(1.0F)});
    }
    return std::move(scene_);
  }

 private:
  static std::size_t kind_of(std::string_view key) {
    return static_cast<std::size_t>(std::find(kKeys.begin(), kKeys.end(), key) - kKeys.begin());
  }

  void read_vertices() {
    std::string_view line;
    for (Lines lines(source_.content); lines.next(line);) {
      watch_.step();
      Words words(line);
      const std::string_view key = words.next();
      if (key == "v") {
        places_.push_back(read_coordinates<3>(source_, lines, words));
        read_vertex_colour(words);
      } else if (key == "vt") {
        const float u = static_cast<float>(read_coordinates<1>(source_, lines, words).x);
        const bool has_v = !Words(words).next().empty();
        const double v = has_v ? read_coordinates<1>(source_, lines, words).x : 0;
        uvs_.emplace_back(u, 1 - v);  // v of OBJ grows upwards
      } else if (key == "vn") {
        normals_.emplace_back(read_coordinates<3>(source_, lines, words));
      } else if (key == "mtllib") {
        read_materials(words.rest());
      }
    }
    const auto most = std::max({places_.size(), uvs_.size(), normals_.size()});
    if (most >= kNone) source_.fail("", "a mesh is too large");
    all_ = {static_cast<std::int64_t>(places_.size()), static_cast<std::int64_t>(uvs_.size()),
            static_cast<std::int64_t>(normals_.size())};
    if (!colours_.empty()) colours_.resize(places_.size(), glm::vec4(1));
  }

  void choose_origin() {
    source_.require_memory(places_.size() * sizeof(glm::vec3));
    scene_.origin = origin_of(box_of(places_));
    positions_ = relative_to(scene_.origin, places_);
    std::vector<glm::dvec3>().swap(places_);
  }

  // Three more numbers are a colour; one is a weight, which polygons do not use.
  void read_vertex_colour(Words words) {
    glm::dvec4 colour(1);
    for (int k = 0; k < 3; ++k) {
      if (!parse(words.next(), colour[k])) return;
    }
    colours_.resize(places_.size() - 1, glm::vec4(1));
    colours_.push_back(linear_colour(colour));
  }

  // Each file once, however often it is named.
  void read_materials(std::string_view name) {
    if (name.empty() || !named_.emplace(name).second) return;
    try {
      const std::filesystem::path path = source_.resolve(std::string(name));
      if (!libraries_.insert(path).second) return;
      const std::string content = files::read_file(path, source_.memory);
      for (Material& material : read_mtl(content, textures_)) {
        const auto number = static_cast<std::uint32_t>(scene_.materials.size());
        materials_.try_emplace(material.name, number);
        scene_.materials.push_back(std::move(material));
      }
    } catch (const files::FileError& e) {
      if (e.cause() == files::Cause::memory) throw;
      source_.warn(e.what());
    }
  }

  void read_faces() {
    std::uint32_t material = kNone;
    Counts before{};
    std::string_view line;
    for (Lines lines(source_.content); lines.next(line);) {
      watch_.step();
      Words words(line);
      const std::string_view key = words.next();
      if (const std::size_t kind = kind_of(key); kind < kKeys.size()) {
        ++before[kind];
      } else if (key == "f") {
        read_face(lines, words, before);
        if (corners_.size() < 3) {
          ++left_out_;
        } else {
          if (material == kNone) material = material_named("");
          add_face(material);
        }
      } else if (key == "usemtl") {
        material = material_named(words.rest());
      } else if (key == "l" || key == "p") {
        ++left_out_;
      } else if (key == "curv" || key == "curv2" || key == "surf") {
        ++free_forms_;
      }
    }
  }

  // Unknown ones are plain.
  std::uint32_t material_named(std::string_view name) {
    const auto [entry, is_new] = materials_.try_emplace(
        std::string(name), static_cast<std::uint32_t>(scene_.materials.size()));
    if (is_new) {
      scene_.materials.push_back(plain_material(!colours_.empty()));
      scene_.materials.back().name = name;
    }
    return entry->second;
  }

  void read_face(const Lines& lines, Words& words, const Counts& before) {
    corners_.clear();
    for (std::string_view word = words.next(); !word.empty() && word.front() != '#';
         word = words.next()) {
      watch_.step();
      corners_.push_back(read_corner(lines, word, before));
    }
  }

  // position/texture/normal, each counted from 1 or, if negative, back from the line.
  Corner read_corner(const Lines& lines, std::string_view corner, const Counts& before) const {
    Corner result = {kNone, kNone, kNone};
    for (std::size_t part = 0; part < 3 && !corner.empty(); ++part) {
      const std::string_view word = corner.substr(0, corner.find('/'));
      corner.remove_prefix(std::min(corner.size(), word.size() + 1));
      if (word.empty() && part > 0) continue;
      std::int64_t index = 0;
      if (!parse(word, index)) {
        source_.fail(lines.place(), "'" + std::string(word.substr(0, 40)) + "' is not an index");
      }
      if (index == 0 || index > all_[part] || index < -before[part]) {
        source_.fail(lines.place(), "there is no " + std::string(kWhat[part]) + " " +
                                        std::to_string(index) + " (" +
                                        std::to_string(index < 0 ? before[part] : all_[part]) +
                                        (index < 0 ? " so far)" : " in all)"));
      }
      result[part] = static_cast<std::uint32_t>(index < 0 ? before[part] + index : index - 1);
    }
    if (!corner.empty()) source_.fail(lines.place(), "a corner has too many parts");
    return result;
  }

  std::uint32_t mesh_of(std::uint32_t material, bool has_normals) {
    const std::size_t key = std::size_t{material} * 2 + (has_normals ? 1 : 0);
    if (key >= meshes_.size()) meshes_.resize(2 * scene_.materials.size(), kNone);
    if (meshes_[key] == kNone) {
      meshes_[key] = static_cast<std::uint32_t>(scene_.meshes.size());
      Mesh& mesh = scene_.meshes.emplace_back();
      mesh.name = scene_.materials[material].name;
      mesh.material = material;
    }
    return meshes_[key];
  }

  void add_face(std::uint32_t material) {
    const bool has_normals = std::all_of(corners_.begin(), corners_.end(),
                                         [](const Corner& c) { return c[2] != kNone; });
    const std::uint32_t number = mesh_of(material, has_normals);
    Mesh& mesh = scene_.meshes[number];
    polygon_.clear();
    for (Corner& corner : corners_) {
      if (!has_normals) corner[2] = kNone;
      if (mesh.positions.size() >= kNone) source_.fail("", "a mesh is too large");
      const auto next = static_cast<std::uint32_t>(mesh.positions.size());
      polygon_.push_back(table_.find(number, corner, next));
      if (polygon_.back() == next) add_vertex(corner, mesh);
    }
    triangulate_polygon(polygon_, mesh.positions, mesh.triangles);
  }

  void add_vertex(const Corner& corner, Mesh& mesh) const {
    mesh.positions.push_back(positions_[corner[0]]);
    if (!colours_.empty()) mesh.colours.push_back(colours_[corner[0]]);
    if (corner[2] != kNone) mesh.normals.push_back(normals_[corner[2]]);
    // Vertices before the first with texture coordinates, and those without, have 0.
    if (corner[1] == kNone && mesh.uvs.empty()) return;
    mesh.uvs.resize(mesh.positions.size() - 1, glm::vec2(0));
    mesh.uvs.push_back(corner[1] == kNone ? glm::vec2(0) : uvs_[corner[1]]);
  }

  const Source& source_;
  GrowthWatch watch_{source_};
  Scene scene_;
  TextureFiles textures_;
  std::map<std::string, std::uint32_t, std::less<>> materials_;  // numbers by name
  std::set<std::string, std::less<>> named_;                     // by mtllib
  std::set<std::filesystem::path> libraries_;                    // that were
  std::vector<glm::dvec3> places_;                               // positions as the file gives them
  std::vector<glm::vec3> positions_, normals_;
  std::vector<glm::vec4> colours_;  // of positions, if any has one
  std::vector<glm::vec2> uvs_;
  Counts all_{};
  std::vector<std::uint32_t> meshes_;  // numbers by material and normals
  CornerTable table_;
  std::vector<Corner> corners_;         // of a face
  std::vector<std::uint32_t> polygon_;  // its vertices
  std::uint64_t left_out_ = 0, free_forms_ = 0;
};

}  // namespace

Scene read_obj(const Source& source) { return ObjReader(source).run(); }

}  // namespace delray::scenes::internal
