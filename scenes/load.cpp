// The table of scene readers, and the steps of loading: read, identify, parse, drop what is
// degenerate, find the up axis, order for locality.
#include "scenes/load.h"

#include <algorithm>
#include <array>

#include "files/format.h"
#include "files/read_file.h"
#include "scenes/files/finish.h"
#include "scenes/files/load_content.h"
#include "scenes/files/readers.h"
#include "scenes/geometry/order.h"
#include "scenes/geometry/up_axis.h"
#include "scenes/gltf/load_gltf.h"

namespace delray::scenes {
namespace {

using files::Format;
using internal::finish;
using internal::Source;

constexpr std::size_t kStart = std::size_t{1} << 20;  // bytes; enough to know any format by
constexpr std::uint64_t kOrderingBytes = 48;          // that ordering takes for a triangle

constexpr std::array kReaders = {
    SceneReader{Format::obj, "OBJ", "Wavefront model, with its materials (MTL) and textures",
                &internal::read_obj, true},
    SceneReader{Format::ply, "PLY",
                "surface of triangles, polygons or strips, with colours and normals",
                &internal::read_ply, true},
    SceneReader{Format::stl, "STL", "surface of triangles, text or binary", &internal::read_stl,
                true},
    SceneReader{Format::gltf, "glTF", "scene with materials, lights and cameras, as JSON",
                &internal::load_gltf, true},
    SceneReader{Format::glb, "GLB", "glTF as one binary file", &internal::load_gltf, true},
    SceneReader{Format::off, "OFF", "surface of polygons", &internal::read_off},
};

std::string no_scene() {
  std::string names;
  for (const SceneReader& reader : kReaders) {
    names += (names.empty() ? "" : ", ") + std::string(reader.name);
  }
  return "this is not a scene that can be read; formats: " + names;
}

const SceneReader* reader_of(Format format) {
  const auto reader = std::ranges::find(kReaders, format, &SceneReader::format);
  return reader == kReaders.end() ? nullptr : reader;
}

// `start` is the first megabyte of the file.
Scene read(Format format, std::string_view start, const Source& source,
           const LoadOptions& options) {
  const SceneReader* const reader = reader_of(format);
  if (reader == nullptr) source.fail("", no_scene());
  Scene scene = reader->read(source);
  scene.files = internal::named_files(source);
  if (options.progress) options.progress->advance();
  finish(source, scene);
  const bool says_up = format == Format::gltf || format == Format::glb;  // y
  const char up = files::up_axis(start);
  scene.z_up =
      !says_up && (up == '\0' ? internal::guess_z_up(scene, format == Format::stl) : up == 'z');
  if (options.on_read) options.on_read(scene);
  // Exporters of glTF order triangles for renderers.
  if (!says_up) {
    for (Mesh& mesh : scene.meshes) {
      source.require_memory(mesh.triangles.size() * kOrderingBytes);
      internal::order_for_locality(mesh);
    }
  }
  if (options.progress) options.progress->advance();
  return scene;
}

}  // namespace

std::span<const SceneReader> scene_readers() { return kReaders; }

Scene internal::load_content(const std::filesystem::path& path, std::string content,
                             std::vector<std::string>& warnings, const LoadOptions& options) {
  if (content.empty()) Source{path, content, warnings}.fail("", "the file is empty");
  const std::string_view start = std::string_view(content).substr(0, kStart);
  const Format format = files::identify(start, content.size(), path).format;
  const Source source{path, content, warnings, options.memory, options.outside};
  return read(format, std::string_view(content).substr(0, kStart), source, options);
}

Scene load(const std::filesystem::path& path, std::vector<std::string>& warnings,
           const LoadOptions& options) {
  if (options.progress) options.progress->start(3);
  // A stream that is nothing that is known need not be read to its end, if it has one.
  const bool stream = files::is_stream(path);
  if (stream) {
    const bool empty = files::read_start(path, 1, options.memory).empty();
    if (!empty && files::identify_format(path, options.memory) == Format::unknown) {
      Source{path, "", warnings}.fail("", no_scene());
    }
  }
  if (!stream) {
    const std::string start = files::read_start(path, kStart, options.memory);
    const Source source{path, "", warnings, options.memory, options.outside, false};
    const std::uint64_t size = source.bytes().size();
    const Format format = files::identify(start, size, path).format;
    const SceneReader* const reader = reader_of(format);
    if (!start.empty() && reader != nullptr && reader->in_parts) {
      if (options.progress) options.progress->advance();
      return read(format, start, source, options);
    }
  }
  std::string content = files::read_file(path, options.memory);
  if (options.progress) options.progress->advance();
  return internal::load_content(path, std::move(content), warnings, options);
}

}  // namespace delray::scenes
