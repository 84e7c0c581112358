// The index of a mesh folder: whatever the bytes, names that stay in the folder and counts that add
// up, or FileError.
#include <cstdlib>
#include <string_view>

#include "delaunay/files/input.h"
#include "delaunay/mesh_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace delray;
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  try {
    const delaunay::MeshIndex index = delaunay::parse_mesh_index({"fuzz", content});
    std::uint64_t simplices = 0;
    for (const delaunay::MeshPiece& piece : index.pieces) {
      if (piece.file.find('/') != std::string::npos || piece.file.starts_with('.')) std::abort();
      simplices += piece.simplices;
    }
    if (simplices != index.simplices) std::abort();
  } catch (const files::FileError&) {
  }
  return 0;
}
