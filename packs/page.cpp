// Sizes and attributes of pages.
#include "packs/page.h"

namespace delray::packs {

std::uint64_t Page::bytes() const {
  const auto of = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
  return sizeof(Page) + of(mesh.positions) + of(mesh.normals) + of(mesh.uvs) + of(mesh.uvs2) +
         of(mesh.tangents) + of(mesh.colours) + of(mesh.triangles) + of(clusters) + of(vertices) +
         of(corners);
}

std::uint64_t PageRow::bytes_in_memory(const Attributes& attributes) const {
  constexpr std::uint64_t kCorners = 3;
  return sizeof(Page) + clusters * sizeof(PageCluster) + references * sizeof(std::uint32_t) +
         triangles * (sizeof(glm::uvec3) + kCorners) +
         vertices * (sizeof(glm::vec3) + attributes.bytes());
}

Attributes attributes_of(const scenes::Mesh& mesh) {
  return {!mesh.normals.empty(), !mesh.uvs.empty(), !mesh.uvs2.empty(), !mesh.tangents.empty(),
          !mesh.colours.empty()};
}

}  // namespace delray::packs
