#include "delaunay/read_mesh.h"

#include <string>

#include "delaunay/internal/point_readers.h"
#include "files/format.h"
#include "files/read_file.h"

namespace delray::delaunay {
namespace {

using files::Format;

constexpr const char* kNoMesh = "not a mesh; known formats: PLY, OBJ, OFF, STL, VTU, NODE+ELE";

// A file in memory that an Input refers to.
struct Content {
  Content(const std::filesystem::path& path, const files::MemoryBudget& memory)
      : bytes(files::read_file(path, memory)),
        input{path == "-" ? "standard input" : path.string(), bytes, memory} {
    if (bytes.empty()) fail(input, "", "the file is empty");
  }
  Content(const Content&) = delete;
  Content& operator=(const Content&) = delete;

  std::string bytes;
  Input input;
};

PointMesh read_node_and_ele(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  const Content nodes(std::filesystem::path(path).replace_extension(".node"), memory);
  const Content elements(std::filesystem::path(path).replace_extension(".ele"), memory);
  return read_node_mesh(nodes.input, elements.input);
}

PointMesh read_any(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  if (files::format_of_suffix(path) == Format::node) return read_node_and_ele(path, memory);
  const Format format = files::identify_format(path, memory);
  // A stream of something else need not be read to its end, if it has one.
  if (format == Format::unknown && files::is_stream(path)) fail({path.string(), ""}, "", kNoMesh);
  const Content file(path, memory);
  switch (format) {
    case Format::ply:
      return read_ply_mesh(file.input);
    case Format::obj:
      return read_obj_mesh(file.input);
    case Format::off:
      return read_off_mesh(file.input);
    case Format::vtu:
      return read_vtu_mesh(file.input);
    case Format::stl:
      return read_stl_mesh(file.input);
    default:
      fail(file.input, "", kNoMesh);
  }
}

}  // namespace

PointMesh read_mesh(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  PointMesh mesh = read_any(path, memory);
  if (mesh.points.size() == 0) {
    throw files::FileError(files::Cause::input, path.string(), "", "no points");
  }
  return mesh;
}

}  // namespace delray::delaunay
