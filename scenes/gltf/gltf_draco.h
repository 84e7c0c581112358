// Primitives of glTF compressed with Draco (KHR_draco_mesh_compression).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "scenes/gltf/gltf_document.h"

namespace draco {
class Mesh;
}

namespace delray::scenes::internal {

// The triangles and attributes of one compressed primitive.
class DracoPrimitive {
 public:
  // Nothing if the primitive is not compressed. Fails, naming the extension's place, where its
  // bytes are not a mesh.
  static std::optional<DracoPrimitive> read(const GltfDocument& document,
                                            const JsonView& primitive);
  DracoPrimitive(DracoPrimitive&&) noexcept;
  ~DracoPrimitive();

  std::size_t vertices() const;
  std::vector<std::uint32_t> indices() const;
  bool has(const char* attribute) const;
  int components(const char* attribute) const;  // REQUIRES: has(attribute)
  // Integers as fractions if `normalized`. Fails unless there are N components and all are finite.
  // REQUIRES: has(attribute).
  template <int N>
  std::vector<glm::vec<N, float>> vectors(const char* attribute, bool normalized) const;

 private:
  DracoPrimitive(std::unique_ptr<draco::Mesh> mesh, const JsonView& extension);

  std::unique_ptr<draco::Mesh> mesh_;
  JsonView extension_;
};

}  // namespace delray::scenes::internal
