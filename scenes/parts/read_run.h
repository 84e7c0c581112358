// A run of a file's triangles with the vertices that they have.
#pragma once

#include <cstdint>

#include "scenes/files/triangle_file.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// Gives `mesh` triangles [begin, end) of the file and their vertices, in the order of their numbers
// in the file. Reads blocks of vertices that are used. False where the file has a triangle that is
// none. Besides the mesh an eighth of a byte for each vertex of the file, at most. O(triangles +
// vertices of the file / 64), parallel. Throws FileError.
bool read_run(const Source& source, const TriangleFile& file, std::uint64_t begin,
              std::uint64_t end, Mesh& mesh);

// Calls f(values of a, values of b) for every attribute that meshes may have.
template <class MeshA, class MeshB, class F>
void for_each_attribute(MeshA& a, MeshB& b, F&& f) {
  f(a.positions, b.positions);
  f(a.normals, b.normals);
  f(a.uvs, b.uvs);
  f(a.uvs2, b.uvs2);
  f(a.tangents, b.tangents);
  f(a.colours, b.colours);
}

}  // namespace delray::scenes::internal
