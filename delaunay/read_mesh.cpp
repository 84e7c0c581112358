#include "delaunay/read_mesh.h"

#include <string>

#include "delaunay/internal/point_readers.h"
#include "files/format.h"
#include "files/read_file.h"

namespace delray::delaunay {
namespace {

using files::Format;

// A file in memory that an Input refers to.
struct Content {
  explicit Content(const std::filesystem::path& path)
      : bytes(files::read_file(path)),
        input{path == "-" ? "standard input" : path.string(), bytes} {
    if (bytes.empty()) fail(input, "", "the file is empty");
  }
  Content(const Content&) = delete;
  Content& operator=(const Content&) = delete;

  std::string bytes;
  Input input;
};

PointMesh read_node_and_ele(const std::filesystem::path& path) {
  const Content nodes(std::filesystem::path(path).replace_extension(".node"));
  const Content elements(std::filesystem::path(path).replace_extension(".ele"));
  return read_node_mesh(nodes.input, elements.input);
}

PointMesh read_any(const std::filesystem::path& path) {
  if (files::format_of_suffix(path) == Format::node) return read_node_and_ele(path);
  const Content file(path);
  constexpr std::size_t kStart = std::size_t{1} << 16;
  const std::string_view start = std::string_view(file.bytes).substr(0, kStart);
  switch (files::identify(start, file.bytes.size(), path).format) {
    case Format::ply:
      return read_ply_mesh(file.input);
    case Format::obj:
      return read_obj_mesh(file.input);
    case Format::off:
      return read_off_mesh(file.input);
    case Format::vtu:
      return read_vtu_mesh(file.input);
    case Format::stl:
      fail(file.input, "", "STL has no vertex numbers, so it does not say which point is which");
    default:
      fail(file.input, "", "not a mesh; known formats: PLY, OBJ, OFF, VTU, NODE+ELE");
  }
}

}  // namespace

PointMesh read_mesh(const std::filesystem::path& path) {
  PointMesh mesh = read_any(path);
  if (mesh.points.size() == 0) {
    throw files::FileError(files::Cause::input, path.string(), "", "no points");
  }
  return mesh;
}

}  // namespace delray::delaunay
