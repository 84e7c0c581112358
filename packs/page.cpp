// Sizes and attributes of pages.
#include "packs/page.h"

namespace delray::packs {

std::uint64_t Page::bytes() const {
  const auto of = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
  return sizeof(Page) + of(mesh.positions) + of(mesh.normals) + of(mesh.uvs) + of(mesh.uvs2) +
         of(mesh.tangents) + of(mesh.colours) + of(mesh.triangles) + of(clusters) + of(vertices) +
         of(corners);
}

Attributes attributes_of(const scenes::Mesh& mesh) {
  return {!mesh.normals.empty(), !mesh.uvs.empty(), !mesh.uvs2.empty(), !mesh.tangents.empty(),
          !mesh.colours.empty()};
}

}  // namespace delray::packs
