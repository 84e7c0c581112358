// The table of mesh readers. files::identify_format() chooses among them, but for .node and .ele,
// two files known by their suffixes.
#include "delaunay/read_mesh.h"

#include <algorithm>
#include <array>
#include <string>

#include "delaunay/files/line_ends.h"
#include "delaunay/files/point_readers.h"
#include "delaunay/mesh_folder.h"
#include "files/read_file.h"

namespace delray::delaunay {
namespace {

using files::Format;

// A file in memory that an Input refers to.
struct Content {
  Content(const std::filesystem::path& path, Format format, const files::MemoryBudget& memory)
      : bytes(with_line_feeds(format, files::read_file(path, memory))),
        input{path == "-" ? "standard input" : path.string(), bytes, memory} {
    if (bytes.empty()) fail(input, "", "the file is empty");
  }
  Content(const Content&) = delete;
  Content& operator=(const Content&) = delete;

  std::string bytes;
  Input input;
};

PointMesh read_node_and_ele(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  const Content nodes(std::filesystem::path(path).replace_extension(".node"), Format::node, memory);
  const Content elements(std::filesystem::path(path).replace_extension(".ele"), Format::node,
                         memory);
  return read_node_mesh(nodes.input, elements.input);
}

template <PointMesh (*read)(const Input&), Format format>
PointMesh read_file(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  const Content file(path, format, memory);
  return read(file.input);
}

constexpr std::array kReaders = {
    MeshReader{Format::ply, "PLY", "mesh of triangles", &read_file<read_ply_mesh, Format::ply>},
    MeshReader{Format::obj, "OBJ", "mesh of triangles", &read_file<read_obj_mesh, Format::obj>},
    MeshReader{Format::off, "OFF", "mesh of triangles", &read_file<read_off_mesh, Format::off>},
    MeshReader{Format::stl, "STL", "mesh of triangles", &read_file<read_stl_mesh, Format::stl>},
    MeshReader{Format::vtu, "VTU", "mesh of triangles or tetrahedra, as delray writes them",
               &read_file<read_vtu_mesh, Format::vtu>},
    MeshReader{Format::node, "NODE+ELE",
               "mesh of triangles or tetrahedra of Triangle and TetGen, two files",
               &read_node_and_ele},
};

std::string no_mesh() {
  std::string names;
  for (const MeshReader& reader : kReaders) {
    names += (names.empty() ? "" : ", ") + std::string(reader.name);
  }
  return "not a mesh; known formats: " + names;
}

PointMesh read_any(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  if (is_mesh_folder(path)) return read_mesh_folder(path, memory);
  const bool is_node = files::format_of_suffix(path) == Format::node;
  const Format format = is_node ? Format::node : files::identify_format(path, memory);
  const auto reader = std::ranges::find(kReaders, format, &MeshReader::format);
  if (reader != kReaders.end()) return reader->read(path, memory);
  // A stream of something else need not be read to its end, if it has one.
  if (files::is_stream(path)) fail({path.string(), ""}, "", no_mesh());
  const Content file(path, Format::unknown, memory);
  fail(file.input, "", no_mesh());
}

}  // namespace

std::span<const MeshReader> mesh_readers() { return kReaders; }

PointMesh read_mesh(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  PointMesh mesh = read_any(path, memory);
  if (mesh.points.size() == 0) {
    throw files::FileError(files::Cause::input, path.string(), "", "no points");
  }
  return mesh;
}

PointTable read_point_table(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  return read_point_table(Content(path, Format::node, memory).input);
}

TableMesh read_table_mesh(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  const Content nodes(std::filesystem::path(path).replace_extension(".node"), Format::node, memory);
  const Content elements(std::filesystem::path(path).replace_extension(".ele"), Format::node,
                         memory);
  return read_table_mesh(nodes.input, elements.input);
}

}  // namespace delray::delaunay
