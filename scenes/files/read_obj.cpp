// OBJ (Wavefront): vertices, texture coordinates, normals, and polygons, lines and points of them.
//
// Ranges of lines are read at the same time, twice: indices may point to vertices that come later.
// Corners of equal indices share a vertex, numbered by its first corner; where elements are
// triangles of one material with positions alone, corners are read into the scene's triangles.
// O(bytes).
#include <map>
#include <set>

#include "files/read_file.h"
#include "scenes/files/for_each_block.h"
#include "scenes/files/obj_meshes.h"
#include "scenes/files/obj_triangles.h"
#include "scenes/files/read_mtl.h"
#include "scenes/files/readers.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/weld.h"

namespace delray::scenes::internal {
namespace {

class ObjReader {
 public:
  explicit ObjReader(const Source& source)
      : source_(source), text_(source), textures_(source, scene_.textures) {}

  Scene run() {
    scene_.origin = text_.vertices().origin;
    for (const ObjRange& range : text_.ranges()) {
      for (const ObjCommand& command : range.commands) {
        if (command.kind == ObjCommand::library) read_materials(command.name);
      }
      free_forms_ += range.free_forms;
    }
    if (!read_triangles()) read_elements();
    if (scene_.meshes.empty()) source_.fail("", kNoTriangles);
    if (left_out_ > 0) {
      source_.warn(std::to_string(left_out_) +
                   " faces of fewer than 3 corners and lines of 1 left out");
    }
    if (free_forms_ > 0) {
      source_.warn(std::to_string(free_forms_) + " free-form curves and surfaces left out");
    }
    for (std::uint32_t m = 0; m < scene_.meshes.size(); ++m) {
      Mesh& mesh = scene_.meshes[m];
      mesh.name = scene_.materials[mesh.material].name;
      normalize_or_clear(mesh.normals);
      weld(mesh);
      // Light means nothing to points and lines.
      if (!mesh.has_triangles()) mesh.material = unlit(mesh.material);
      scene_.instances.push_back({m, glm::mat4x3(1.0F)});
    }
    return std::move(scene_);
  }

 private:
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

  // Unknown ones are plain.
  std::uint32_t material_named(std::string_view name, bool has_colours) {
    const auto [entry, is_new] = materials_.try_emplace(
        std::string(name), static_cast<std::uint32_t>(scene_.materials.size()));
    if (is_new) {
      scene_.materials.push_back(plain_material(has_colours));
      scene_.materials.back().name = name;
    }
    return entry->second;
  }

  // The same material without light.
  std::uint32_t unlit(std::uint32_t material) {
    const auto [found, is_new] =
        unlit_.try_emplace(material, static_cast<std::uint32_t>(scene_.materials.size()));
    if (is_new) {
      scene_.materials.push_back(Material(scene_.materials[material]));
      scene_.materials.back().unlit = true;
    }
    return found->second;
  }

  // Elements that are all triangles of one material, with positions alone.
  bool read_triangles() {
    std::string name;
    bool named = false;
    std::uint64_t before = 0;
    for (const ObjRange& range : text_.ranges()) {
      for (const ObjCommand& command : range.commands) {
        if (command.kind == ObjCommand::library) continue;
        if (named || before + command.elements_before > 0) return false;
        name = command.name;
        named = true;
      }
      before += range.elements;
    }
    const bool has_colours = !text_.vertices().colours.empty();
    Mesh mesh;
    if (!read_obj_triangles(text_, mesh)) return false;
    mesh.material = material_named(name, has_colours);
    scene_.meshes.push_back(std::move(mesh));
    return true;
  }

  void read_elements() {
    std::vector<ObjElements> elements(text_.ranges().size());
    for_each_block(elements.size(),
                   [&](std::size_t i) { elements[i] = read_obj_elements(text_, i); });
    scene_.meshes = make_obj_meshes(text_, std::move(elements), material_runs(), left_out_);
  }

  // By range. Materials are numbered in the order in which they are asked for.
  std::vector<std::vector<ObjMaterialRun>> material_runs() {
    const bool has_colours = !text_.vertices().colours.empty();
    std::vector<std::vector<ObjMaterialRun>> runs(text_.ranges().size());
    std::uint32_t material = kNone;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const ObjRange& range = text_.ranges()[i];
      const auto begin_run = [&](std::uint64_t begin, std::uint64_t end) {
        if (begin == end) return;
        if (material == kNone) material = material_named("", has_colours);
        runs[i].push_back({begin, material});
      };
      std::uint64_t begin = 0;
      for (const ObjCommand& command : range.commands) {
        if (command.kind != ObjCommand::material) continue;
        begin_run(begin, command.elements_before);
        begin = command.elements_before;
        material = material_named(command.name, has_colours);
      }
      begin_run(begin, range.elements);
    }
    return runs;
  }

  const Source& source_;
  ObjText text_;
  Scene scene_;
  TextureFiles textures_;
  std::map<std::string, std::uint32_t, std::less<>> materials_;  // numbers by name
  std::map<std::uint32_t, std::uint32_t> unlit_;                 // by the material with light
  std::set<std::string, std::less<>> named_;                     // by mtllib
  std::set<std::filesystem::path> libraries_;                    // that were
  std::uint64_t left_out_ = 0, free_forms_ = 0;
};

}  // namespace

Scene read_obj(const Source& source) { return ObjReader(source).run(); }

}  // namespace delray::scenes::internal
