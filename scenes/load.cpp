#include "scenes/load.h"

#include <algorithm>

#include "files/format.h"
#include "files/read_file.h"
#include "scenes/internal/finish.h"
#include "scenes/internal/load_content.h"
#include "scenes/internal/load_gltf.h"
#include "scenes/internal/order.h"
#include "scenes/internal/readers.h"
#include "scenes/internal/up_axis.h"

namespace delray::scenes {
namespace {

using files::Format;
using internal::Source;

constexpr std::size_t kStart = std::size_t{1} << 20;  // bytes; enough to know any format by
constexpr std::uint64_t kOrderingBytes = 48;          // that ordering takes for a triangle
constexpr const char* kNoScene =
    "this is not a scene that can be read; formats: OBJ, PLY, STL, glTF, GLB, OFF";

// A backslash at the end of a line continues it; blanks instead leave one long line.
std::string join_continued_lines(std::string text) {
  for (std::size_t i = text.find('\\'); i != std::string::npos; i = text.find('\\', i + 1)) {
    std::size_t end = i + 1;
    while (end < text.size() && text[end] == '\r') ++end;
    if (end < text.size() && text[end] == '\n') std::fill(&text[i], &text[end] + 1, ' ');
  }
  return text;
}

Scene read(Format format, const Source& source) {
  switch (format) {
    case Format::obj:
      return internal::read_obj(source);
    case Format::ply:
      return internal::read_ply(source);
    case Format::off:
      return internal::read_off(source);
    case Format::stl:
      return internal::read_stl(source);
    case Format::gltf:
    case Format::glb:
      return internal::load_gltf(source);
    default:
      source.fail("", kNoScene);
  }
}

}  // namespace

Scene internal::load_content(const std::filesystem::path& path, std::string content,
                             std::vector<std::string>& warnings, const LoadOptions& options) {
  if (content.empty()) Source{path, content, warnings}.fail("", "the file is empty");
  const std::string_view start = std::string_view(content).substr(0, kStart);
  const Format format = files::identify(start, content.size(), path).format;
  if (format == Format::obj) content = join_continued_lines(std::move(content));
  const Source source{path, content, warnings, options.memory, options.outside};
  Scene scene = read(format, source);
  if (options.progress) options.progress->advance();
  finish(source, scene);
  const bool says_up = format == Format::gltf || format == Format::glb;  // y
  // Exporters of glTF order triangles for renderers.
  if (!says_up) {
    for (Mesh& mesh : scene.meshes) {
      source.require_memory(mesh.triangles.size() * kOrderingBytes);
      order_for_locality(mesh);
    }
  }
  scene.z_up = !says_up && guess_z_up(scene, format == Format::stl);
  if (options.progress) options.progress->advance();
  return scene;
}

Scene load(const std::filesystem::path& path, std::vector<std::string>& warnings,
           const LoadOptions& options) {
  if (options.progress) options.progress->start(3);
  // A stream that is nothing that is known need not be read to its end, if it has one.
  if (files::is_stream(path)) {
    const bool empty = files::read_start(path, 1, options.memory).empty();
    if (!empty && files::identify_format(path, options.memory) == Format::unknown) {
      Source{path, "", warnings}.fail("", kNoScene);
    }
  }
  std::string content = files::read_file(path, options.memory);
  if (options.progress) options.progress->advance();
  return internal::load_content(path, std::move(content), warnings, options);
}

}  // namespace delray::scenes
