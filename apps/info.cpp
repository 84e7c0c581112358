// delray info: what is in a scene, point, mesh or picture file.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <variant>

#include "apps/commands.h"
#include "apps/input/scene_input.h"
#include "apps/options/formats.h"
#include "apps/options/help.h"
#include "apps/options/outputs.h"
#include "apps/statistics.h"
#include "delaunay/mesh_folder.h"
#include "delaunay/read_mesh.h"
#include "delaunay/summarize_points.h"
#include "files/printable.h"
#include "geometry/box.h"
#include "image/geotiff.h"
#include "image/io.h"
#include "packs/pack_reader.h"
#include "scenes/describe.h"

namespace delray::apps {
namespace {

template <class Vector>
Json numbers(const Vector& v) {
  return Json::array({v.x, v.y, v.z});
}

Json attributes_of(bool colours, bool intensity, bool classes) {
  Json attributes = Json::array();
  if (colours) attributes.push_back("rgb");
  if (intensity) attributes.push_back("intensity");
  if (classes) attributes.push_back("classification");
  return attributes;
}

Json describe_points(const std::string& path, const delaunay::PointCloud& points) {
  for (const std::string& warning : points.warnings) spdlog::warn("{}: {}", path, warning);
  geometry::Box3d box;
  for (const glm::dvec3& p : points.positions) box.include(p);
  return {{"points", points.size()},
          {"dim", points.has_z ? 3 : 2},
          {"low", numbers(box.low)},
          {"high", numbers(box.high)},
          {"geographic", points.geographic},
          {"attributes", attributes_of(!points.colours.empty(), !points.intensity.empty(),
                                       !points.classification.empty())}};
}

// What a LAS file says of its points, and the coordinate system.
void tell_facts(const delaunay::PointFileFacts& facts, Json& description) {
  description["format"] = facts.version.empty() ? facts.format : facts.format + " " + facts.version;
  if (!facts.compression.empty()) description["compression"] = facts.compression;
  if (facts.point_format) description["point_format"] = *facts.point_format;
  if (facts.scale) description["scale"] = numbers(*facts.scale);
  if (facts.offset) description["offset"] = numbers(*facts.offset);
  if (!facts.coordinate_system.empty()) {
    description["coordinate_system"] = facts.coordinate_system;
  }
  if (facts.epsg != 0) description["epsg"] = facts.epsg;
}

Json describe_summary(const std::string& path, const delaunay::PointSummary& points) {
  for (const std::string& warning : points.warnings) spdlog::warn("{}: {}", path, warning);
  Json description = {
      {"points", points.points},
      {"dim", points.has_z ? 3 : 2},
      {"low", numbers(points.box.low)},
      {"high", numbers(points.box.high)},
      {"geographic", points.geographic},
      {"attributes", attributes_of(points.colours, points.intensity, points.classes.has_value())}};
  if (points.classes) {
    Json& classes = description["classes"] = Json::object();
    for (std::size_t i = 0; i < points.classes->size(); ++i) {
      if ((*points.classes)[i] > 0) classes[std::to_string(i)] = (*points.classes)[i];
    }
  }
  if (points.returns) {
    Json& returns = description["returns"] = Json::object();
    for (std::size_t count = 0; count < 16; ++count) {
      for (std::size_t number = 0; number < 16; ++number) {
        const std::uint64_t found = (*points.returns)[number][count];
        if (found > 0) returns[fmt::format("{} of {}", number, count)] = found;
      }
    }
  }
  if (points.files.size() == 1) {
    tell_facts(points.files[0], description);
    return description;
  }
  Json& files = description["files"] = Json::array();
  for (std::size_t i = 0; i < points.files.size(); ++i) {
    Json file = {{"file", points.files[i].file}, {"points", points.file_points[i]}};
    tell_facts(points.files[i], file);
    files.push_back(std::move(file));
  }
  return description;
}

Json describe_mesh(const std::string& path, const delaunay::PointMesh& mesh) {
  Json description = describe_points(path, mesh.points);
  description["simplices"] = mesh.triangulation.size();
  description["simplex"] = mesh.triangulation.dim == 2 ? "triangle" : "tetrahedron";
  return description;
}

// From the index alone.
Json describe_folder(const std::string& path, const files::MemoryBudget& memory) {
  const delaunay::MeshFolder folder(path, memory);
  const delaunay::MeshIndex& index = folder.index();
  const geometry::Box3d box = index.box();
  Json pieces = Json::array();
  for (const delaunay::MeshPiece& piece : index.pieces) {
    pieces.push_back(
        {{"file", piece.file}, {"points", piece.points}, {"simplices", piece.simplices}});
  }
  Json description = {{"points", index.points}, {"distinct", index.distinct}, {"dim", index.dim}};
  if (!box.empty()) description.update({{"low", numbers(box.low)}, {"high", numbers(box.high)}});
  description.update({{"simplices", index.simplices},
                      {"simplex", index.dim == 2 ? "triangle" : "tetrahedron"},
                      {"hull_facets", index.hull_facets},
                      {"hash", to_string(index.hash)},
                      {"format", index.format},
                      {"pieces", pieces}});
  return description;
}

Json describe_animations(const scenes::Scene& scene) {
  Json animations = Json::array();
  for (const scenes::Animation& animation : scene.animations.animations) {
    animations.push_back({{"name", animation.name},
                          {"seconds", animation.duration()},
                          {"channels", animation.channels.size()}});
  }
  return animations;
}

Json describe_scene(const scenes::Scene& scene) {
  const scenes::Description d = scenes::describe(scene);
  Json textures = Json::array();
  for (const scenes::TextureDescription& t : d.textures) {
    textures.push_back({{"name", t.name}, {"width", t.width}, {"height", t.height}});
  }
  return {
      {"triangles", d.triangles},
      {"vertices", d.vertices},
      {"meshes", d.meshes},
      {"instances", d.instances},
      {"stored_triangles", d.stored_triangles},
      {"stored_vertices", d.stored_vertices},
      {"low", numbers(glm::dvec3(d.bounds.low) + scene.origin)},
      {"high", numbers(glm::dvec3(d.bounds.high) + scene.origin)},
      {"up", d.z_up ? "z" : "y"},
      {"normals", d.has_normals},
      {"texture_coordinates", d.has_uvs},
      {"second_texture_coordinates", d.has_second_uvs},
      {"vertex_colours", d.has_colours},
      {"animations", describe_animations(scene)},
      {"skins", scene.animations.skins.size()},
      {"lights",
       {{"point", d.point_lights}, {"directional", d.directional_lights}, {"area", d.area_lights}}},
      {"cameras", d.cameras.size()},
      {"camera_names", d.cameras},
      {"materials", d.materials},
      {"textures", textures},
      {"bytes", d.bytes}};
}

// From the table alone.
Json describe_pack(const std::string& path, const files::MemoryBudget& memory) {
  const packs::PackReader pack(path, memory);
  const scenes::Scene& scene = pack.scene();
  std::size_t levels = 0;
  packs::Attributes has;
  std::uint64_t triangles = 0;
  geometry::Box3 box;
  for (const packs::MeshRow& mesh : pack.meshes()) {
    levels = std::max(levels, mesh.levels.size());
    if (mesh.shape.kind == scenes::Shape::Kind::triangle) triangles += mesh.triangles;
    has.uvs |= mesh.attributes.uvs;
    has.colours |= mesh.attributes.colours;
  }
  for (const scenes::Instance& instance : scene.instances) {
    const geometry::Box3& mesh = pack.meshes()[instance.mesh].box;
    for (int k = 0; k < 8; ++k) {
      const glm::vec3 corner((k & 1) != 0 ? mesh.high.x : mesh.low.x,
                             (k & 2) != 0 ? mesh.high.y : mesh.low.y,
                             (k & 4) != 0 ? mesh.high.z : mesh.low.z);
      box.include(instance.transform * glm::vec4(corner, 1.0F));
    }
  }
  Json description = {{"triangles", pack.triangles()},       {"points", pack.splats()},
                      {"vertices", pack.vertices()},         {"meshes", pack.meshes().size()},
                      {"instances", scene.instances.size()}, {"stored_triangles", triangles}};
  if (!box.empty()) {
    description["low"] = numbers(glm::dvec3(box.low) + scene.origin);
    description["high"] = numbers(glm::dvec3(box.high) + scene.origin);
  }
  description.update({{"up", scene.z_up ? "z" : "y"},
                      {"texture_coordinates", has.uvs},
                      {"vertex_colours", has.colours},
                      {"lights", scene.lights.size()},
                      {"cameras", scene.cameras.size()},
                      {"materials", scene.materials.size()},
                      {"textures", scene.textures.size()},
                      {"levels", levels},
                      {"pages", pack.pages().size()},
                      {"bytes", pack.file_bytes()}});
  return description;
}

Json describe_picture(const std::string& path, const files::MemoryBudget& memory) {
  const image::GeoTiff ground = image::read_geotiff(path, memory);
  const image::PictureInfo info = image::read_info(path, memory);
  Json attributes = Json::object();
  for (const image::Attribute& attribute : info.attributes) {
    std::visit([&](const auto& value) { attributes[attribute.name] = value; }, attribute.value);
  }
  Json description = {{"width", info.width},       {"height", info.height},
                      {"format", info.format},     {"type", info.type},
                      {"channels", info.channels}, {"attributes", attributes}};
  if (ground.to_ground) {
    const glm::dmat3x2& m = *ground.to_ground;
    description["first_pixel"] = {m[2].x, m[2].y};
    description["next_column"] = {m[0].x, m[0].y};
    description["next_row"] = {m[1].x, m[1].y};
    description["geographic"] = ground.geographic;
  }
  if (ground.no_data) description["no_data"] = *ground.no_data;
  return description;
}

// `output` is not to be a file that a scene names.
Json describe(const PointInput& asked, const OutputFile& output) {
  const std::string& path = asked.path;
  const InputLimits& limits = asked.limits;
  const files::MemoryBudget memory = limits.budget();
  // Several files are points, whatever else they have, as for triangulate.
  const InputKind kind = asked.is_set() ? InputKind::points : input_kind_of(asked);
  if (kind != InputKind::scene) refuse_outside(path, limits);
  if (kind != InputKind::points && asked.choice.given()) {
    throw UsageError(fmt::format("options that choose points are not for {}", path));
  }
  switch (kind) {
    case InputKind::picture:
      return describe_picture(path, memory);
    case InputKind::pack:
      return describe_pack(path, memory);
    case InputKind::points:
      tell_left_out(asked);
      return describe_summary(path, summarize(asked));
    case InputKind::mesh:
      if (delaunay::is_mesh_folder(path)) return describe_folder(path, memory);
      return describe_mesh(path, delaunay::read_mesh(path, memory));
    case InputKind::scene:
      break;
  }
  SceneInput input;
  input.file = asked;
  const scenes::Scene scene = load_scene(input, nullptr);
  refuse_overwriting({output}, scene.files);
  return describe_scene(scene);
}

std::string shown(const Json& value) {
  constexpr bool kAscii = false;
  return files::printable(value.is_string()
                              ? value.get<std::string>()
                              : value.dump(-1, ' ', kAscii, Json::error_handler_t::replace));
}

// A line for each key; lists of objects as one line for each.
void print(const Json& description) {
  for (const auto& [key, value] : description.items()) {
    if (value.is_array() && !value.empty() && value[0].is_object()) {
      fmt::print("{}: {}\n", key, value.size());
      for (const Json& row : value) fmt::print("  {}\n", shown(row));
    } else {
      fmt::print("{}: {}\n", key, shown(value));
    }
  }
}

}  // namespace

void add_info(CLI::App& program, Session& session) {
  struct Options {
    PointInput input;
    std::string statistics;
    bool list = false;
  };
  CLI::App* command = program.add_subcommand(
      "info", "Describe what is in a file, or list the formats that are read");
  const auto options = std::make_shared<Options>();
  add_points_argument(
      *command, "FILE", options->input,
      "File to describe: " + format_names() + "; of points several files, folders or patterns");
  command
      ->add_option("--stats", options->statistics,
                   "Description as JSON to this file; - for standard output")
      ->type_name("FILE")
      ->group(group::kOutput);
  command
      ->add_flag("--list", options->list, "List the formats that are read, as happens without FILE")
      ->group(group::kOutput);
  add_choice_options(*command, options->input.choice);
  add_memory_option(*command, options->input.limits);
  add_outside_option(*command, options->input.limits);
  add_common_options(*command, session,
                     "info model.glb\ninfo tiles/*.laz --class 2 --stats -\ninfo --list");
  command->callback([&session, options] {
    session.run = [options] {
      const PointInput& input = options->input;
      if (options->list || input.path.empty()) {
        list_formats();
        return int{kDone};
      }
      const OutputFile output = {"--stats", options->statistics};
      check_outputs({output}, input.paths);
      const Json description = describe(input, output);
      if (options->statistics != "-") print(description);
      Json statistics = {{"schema", "delray.info/1"}, {"file", input.path}};
      statistics.update(description);
      write_statistics(options->statistics, statistics);
      return int{kDone};
    };
  });
}

}  // namespace delray::apps
