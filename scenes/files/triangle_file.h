// A file of one mesh, of which runs of triangles and of vertices are read.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geometry/box.h"
#include "scenes/files/source.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

class TriangleFile {
 public:
  virtual ~TriangleFile() = default;
  TriangleFile() = default;
  TriangleFile(const TriangleFile&) = delete;
  TriangleFile& operator=(const TriangleFile&) = delete;

  // What the scene is besides: materials, textures, lights, cameras, and one mesh without vertices
  // that is placed once.
  const Scene& rest() const { return rest_; }
  std::uint64_t triangles() const { return triangles_; }
  std::uint64_t vertices() const { return vertices_; }

  // Triangles [first, first + to.size()) of the file, as numbers of its vertices. False where one
  // is none, or a corner no vertex. Parallel.
  virtual bool read_triangles(std::uint64_t first, std::span<glm::uvec3> to) const = 0;
  // The attributes of vertices [first, last), as the file has them: directions of any length. From
  // any thread. Throws FileError for coordinates that no mesh may have.
  virtual Mesh read_vertices(std::uint64_t first, std::uint64_t last) const = 0;
  // The origin of the scene (scenes/geometry/origin.h), whose vertices and those that triangles
  // have lie in such boxes; nothing where meshes are not simply moved by it.
  virtual std::optional<glm::dvec3> origin(const geometry::Box3d& all,
                                           const geometry::Box3d& used) const = 0;
  // Tells what is to be said of coordinates in such a box.
  virtual void warn(const geometry::Box3d& all) const = 0;

 protected:
  Scene rest_;
  std::uint64_t triangles_ = 0, vertices_ = 0;
};

// Null for files that are not read so. Refer to the source. Throw FileError.
std::unique_ptr<TriangleFile> open_ply_triangles(const Source& source);
std::unique_ptr<TriangleFile> open_gltf_triangles(const Source& source);

}  // namespace delray::scenes::internal
