// Strings the finest pages of each mesh together, a few at a time in parallel.
#include "packs/unpack.h"

#include <algorithm>
#include <vector>

#include "parallel/parallel_for.h"

namespace delray::packs {
namespace {

constexpr std::size_t kPagesAtOnce = 1024;

template <class T>
void append(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

// The arrays at once in the size that they will have.
void reserve(const PackReader& pack, const MeshRow& row, scenes::Mesh& mesh) {
  const PageRange& range = row.levels.front();
  std::size_t vertices = 0;
  for (const PageRow& page : pack.pages().subspan(range.first, range.count))
    vertices += page.vertices;
  mesh.positions.reserve(vertices);
  if (row.attributes.normals) mesh.normals.reserve(vertices);
  if (row.attributes.uvs) mesh.uvs.reserve(vertices);
  if (row.attributes.uvs2) mesh.uvs2.reserve(vertices);
  if (row.attributes.tangents) mesh.tangents.reserve(vertices);
  if (row.attributes.colours) mesh.colours.reserve(vertices);
  mesh.triangles.reserve(row.triangles);
}

}  // namespace

void append_page(const scenes::Mesh& page, scenes::Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  append(page.positions, mesh.positions);
  append(page.normals, mesh.normals);
  append(page.uvs, mesh.uvs);
  append(page.uvs2, mesh.uvs2);
  append(page.tangents, mesh.tangents);
  append(page.colours, mesh.colours);
  for (const glm::uvec3& triangle : page.triangles) mesh.triangles.push_back(triangle + first);
}

scenes::Scene unpack(PackReader& pack, const files::MemoryBudget& memory) {
  std::uint64_t bytes = 0;
  for (const MeshRow& row : pack.meshes()) {
    const PageRange& range = row.levels.front();
    bytes += row.triangles * sizeof(glm::uvec3);
    for (const PageRow& page : pack.pages().subspan(range.first, range.count))
      bytes += std::uint64_t{page.vertices} * (sizeof(glm::vec3) + row.attributes.bytes());
  }
  memory.require(bytes, pack.name(), "all of its triangles");
  scenes::Scene scene = pack.take_scene();
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    const MeshRow& row = pack.meshes()[m];
    scenes::Mesh mesh;
    mesh.name = row.name;
    mesh.shape = row.shape;
    mesh.material = row.material;
    reserve(pack, row, mesh);
    const PageRange& range = row.levels.front();
    std::vector<Page> pages(std::min<std::size_t>(kPagesAtOnce, range.count));
    for (std::uint32_t first = 0; first < range.count;) {
      const std::size_t count = std::min<std::size_t>(pages.size(), range.count - first);
      parallel::parallel_for(0, count, 1, [&](std::size_t i) {
        pages[i] = pack.read(range.first + first + static_cast<std::uint32_t>(i));
      });
      for (std::size_t i = 0; i < count; ++i) append_page(pages[i].mesh, mesh);
      first += static_cast<std::uint32_t>(count);
    }
    scene.meshes[m] = std::move(mesh);
  }
  return scene;
}

}  // namespace delray::packs
