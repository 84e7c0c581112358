#include "delaunay/dimensions.h"
#include "delaunay/files/point_readers.h"
#include "tests/fuzz/fuzz_points.h"

// The bytes are a .node file and, behind a zero byte, its .ele; what is read is verified.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(bytes.find('\0'), size);
  const delray::delaunay::Input nodes{"points", bytes.substr(0, end)},
      elements{"elements", bytes.substr(std::min(end + 1, size))};
  try {
    const delray::delaunay::TableMesh mesh = read_table_mesh(nodes, elements);
    if (mesh.points.size() > 40) return 0;
    verify_dimensions(mesh.points.view(), mesh.points.dim, mesh.triangulation.vertices);
  } catch (const delray::files::FileError&) {
  }
  return 0;
}
